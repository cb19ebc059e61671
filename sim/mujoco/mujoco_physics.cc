// SPDX-License-Identifier: Apache-2.0
#include "mujoco_physics.h"

#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

#include "mujoco_model.h"

namespace gaitd::sim {
namespace {

constexpr double kRestingDepth = 1e-5;  // m

// MuJoCo ends the process at an error and writes a file at a warning, unless told otherwise.
// Warnings are counted in mjData, where step() looks.
[[noreturn]] void on_error(const char* text) {
  throw std::runtime_error(std::string("MuJoCo: ") + text);
}
void on_warning(const char*) {}

mjModel* load(const std::string& document) {
  mju_user_error = on_error;
  mju_user_warning = on_warning;
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  constexpr const char* kName = "robot.xml";
  const int size = static_cast<int>(document.size());
  if (mj_makeEmptyFileVFS(files.get(), kName, size) != 0) {
    throw std::invalid_argument("MuJoCo: the model is too large");
  }
  std::memcpy(files->filedata[0], document.data(), document.size());
  char error[1000] = "";
  mjModel* model = mj_loadXML(kName, files.get(), error, sizeof(error));
  mj_deleteVFS(files.get());
  if (model == nullptr)
    throw std::invalid_argument("MuJoCo refuses the model: " + std::string(error));
  return model;
}

Eigen::Map<const Eigen::Vector3d> vector(const mjtNum* v) {
  return Eigen::Map<const Eigen::Vector3d>(v);
}

Eigen::Matrix3d matrix(const mjtNum* row_major) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(row_major);
}

}  // namespace

MujocoPhysics::MujocoPhysics(const GaitdModel& model, const Terrain& terrain, double time_step)
    : model_(model),
      spheres_(make_body_spheres(model)),
      terrain_(terrain),
      h_(time_step),
      joints_(model),
      joint_rate_(model.joint_count),
      motions_(static_cast<size_t>(model.body_count)) {
  load_model();
  d_.reset(mj_makeData(m_.get()));
  owner_.assign(static_cast<size_t>(m_->nbody), -1);
  foot_.assign(static_cast<size_t>(m_->ngeom), -1);
  for (int i = 0; i < model.body_count; ++i) {
    body_.push_back(mj_name2id(m_.get(), mjOBJ_BODY, std::to_string(i).c_str()));
    owner_[static_cast<size_t>(body_.back())] = i;
  }
  for (int j = 0; j < model.joint_count; ++j) {
    const int joint = mj_name2id(m_.get(), mjOBJ_JOINT, std::to_string(j).c_str());
    place_.push_back(m_->jnt_qposadr[joint]);
    rate_.push_back(m_->jnt_dofadr[joint]);
  }
  for (const int side : {GAITD_LEFT, GAITD_RIGHT}) {
    const char* name = side == GAITD_LEFT ? "sole.left" : "sole.right";
    foot_[static_cast<size_t>(mj_name2id(m_.get(), mjOBJ_GEOM, name))] = side;
  }
}

void MujocoPhysics::load_model() {
  m_.reset(load(mujoco_document(model_, spheres_, terrain_, h_)));
  if (terrain_.stiffness()) soften_ground(*terrain_.stiffness());
}

// A flat sole touches in four points. MuJoCo's contact is f = (s r + b dr/dt) / ((1 - d) A) - a / R
// with impedance d, sink r, its acceleration a and A the inverse of the mass that a point of the
// foot meets in the reference posture ("Computation", of its documentation). Half of the sole's
// critical damping: of the whole robot on one foot that is a tenth.
void MujocoPhysics::soften_ground(double stiffness) {
  constexpr double kImpedance = 0.5;
  constexpr double kPoints = 4;
  constexpr double kDamping = 0.5;
  const int foot = m_->geom_bodyid[mj_name2id(m_.get(), mjOBJ_GEOM, "sole.left")];
  const double inverse_mass = m_->body_invweight0[2 * foot];
  const double s = stiffness / kPoints * (1 - kImpedance) * inverse_mass;
  for (int i = 0; i < m_->ngeom; ++i) {
    if (m_->geom_priority[i] == 0) continue;  // the robot's
    mjtNum* const solref = m_->geom_solref + mjNREF * i;
    solref[0] = -s;
    solref[1] = -2 * kDamping * std::sqrt(s);
    mjtNum* const solimp = m_->geom_solimp + mjNIMP * i;
    solimp[0] = solimp[1] = kImpedance;
  }
}

std::unique_ptr<Physics> MujocoPhysics::make(const GaitdModel& model, const Terrain& terrain,
                                             double time_step) {
  return std::make_unique<MujocoPhysics>(model, terrain, time_step);
}

void MujocoPhysics::place(const State& state) {
  mj_resetData(m_.get(), d_.get());
  Eigen::Map<Eigen::Vector3d>(d_->qpos) = state.p_WB;
  const Eigen::Quaterniond& q = state.R_WB;
  Eigen::Map<Eigen::Vector4d>(d_->qpos + 3) << q.w(), q.x(), q.y(), q.z();
  Eigen::Map<Eigen::Vector3d>(d_->qvel) = state.u.segment<3>(3);
  Eigen::Map<Eigen::Vector3d>(d_->qvel + 3) = q.inverse() * state.u.head<3>();
  for (size_t j = 0; j < place_.size(); ++j) {
    d_->qpos[place_[j]] = state.q[static_cast<Eigen::Index>(j)];
    d_->qvel[rate_[j]] = state.u[6 + static_cast<Eigen::Index>(j)];
  }
  update_positions();
  state_ = state;
  touches_.clear();
  keep_touches();
  rest_on_touches();
}

// Of the same structure: the data of the simulation stay as they are.
void MujocoPhysics::change_masses(const GaitdModel& model) {
  model_ = model;
  load_model();
  update_positions();
}

// Where everything is and what touches, for the positions and rates in mjData.
void MujocoPhysics::update_positions() {
  mj_kinematics(m_.get(), d_.get());
  mj_comPos(m_.get(), d_.get());
  mj_collision(m_.get(), d_.get());
  mj_comVel(m_.get(), d_.get());
  for (size_t i = 0; i < motions_.size(); ++i) {
    BodyMotion& motion = motions_[i];
    mjtNum velocity[6];
    mj_objectVelocity(m_.get(), d_.get(), mjOBJ_XBODY, body_[i], velocity, 0);
    motion.R_WB = matrix(d_->xmat + 9 * body_[i]);
    motion.p_WB = vector(d_->xpos + 3 * body_[i]);
    motion.w_W = vector(velocity);
    motion.v_W = vector(velocity + 3);
  }
}

void MujocoPhysics::apply(std::span<const BodyForce> forces) {
  mju_zero(d_->xfrc_applied, 6 * m_->nbody);
  for (const BodyForce& force : forces) {
    const int body = body_[static_cast<size_t>(force.body)];
    const Eigen::Vector3d arm =
        Bodies(motions_)[force.body].point(force.point) - vector(d_->xipos + 3 * body);
    Eigen::Map<Eigen::Vector3d>(d_->xfrc_applied + 6 * body) += force.share * force.force;
    Eigen::Map<Eigen::Vector3d>(d_->xfrc_applied + 6 * body + 3) +=
        force.share * arm.cross(force.force);
  }
}

// One solution for the present laws of the joints. With tau = a - b (u + h du/dt) the part b h
// belongs to the inertia; armature is what MuJoCo adds to its diagonal.
bool MujocoPhysics::solve() {
  for (size_t i = 0; i < rate_.size(); ++i) {
    const int j = static_cast<int>(i);
    const double slope = joints_.slope(j);
    m_->dof_armature[rate_[i]] = model_.joints[j].rotor_inertia + h_ * slope;
    d_->qfrc_applied[rate_[i]] = joints_.constant(j) - slope * d_->qvel[rate_[i]];
  }
  mj_crb(m_.get(), d_.get());
  mj_factorM(m_.get(), d_.get());
  mj_projectConstraint(m_.get(), d_.get());
  mj_fwdAcceleration(m_.get(), d_.get());
  mj_fwdConstraint(m_.get(), d_.get());
  for (size_t i = 0; i < rate_.size(); ++i) {
    joint_rate_[static_cast<Eigen::Index>(i)] = d_->qvel[rate_[i]] + h_ * d_->qacc[rate_[i]];
  }
  return Eigen::Map<const Eigen::VectorXd>(d_->qacc, m_->nv).allFinite();
}

bool MujocoPhysics::step(std::span<const BodyForce> forces, Drives* drives) {
  apply(forces);
  joints_.begin_step(h_, state_.q, drives);
  mj_makeConstraint(m_.get(), d_.get());
  mj_fwdVelocity(m_.get(), d_.get());
  int solves = 0;
  do {
    if (!solve()) return false;
  } while (joints_.revise(joint_rate_) && ++solves < kMaxSolves);
  joints_.end_step(joint_rate_);
  for (const mjWarningStat& warning : d_->warning) {
    if (warning.number > 0) return false;  // contacts left out, a singular inertia
  }
  keep_touches();
  mj_Euler(m_.get(), d_.get());
  update_positions();
  find_slips();
  update_state();
  return true;
}

void MujocoPhysics::keep_touches() {
  touches_.clear();
  slides_.clear();
  for (int i = 0; i < d_->ncon; ++i) {
    const mjContact& contact = d_->contact[i];
    const int owner[2] = {owner_[static_cast<size_t>(m_->geom_bodyid[contact.geom1])],
                          owner_[static_cast<size_t>(m_->geom_bodyid[contact.geom2])]};
    // The normal points from the first to the second.
    const bool first = owner[0] >= 0;
    Touch touch;
    touch.body = first ? owner[0] : owner[1];
    touch.foot = foot_[static_cast<size_t>(first ? contact.geom1 : contact.geom2)];
    touch.depth = -contact.dist;
    touch.p_W = vector(contact.pos);
    const double sign = first ? -1 : 1;
    touch.normal = sign * vector(contact.frame);
    const bool acts = contact.efc_address >= 0;
    slides_.push_back(acts && d_->efc_state[contact.efc_address] == mjCNSTRSTATE_CONE ? 1 : 0);
    if (acts) {
      mjtNum force[6];
      mj_contactForce(m_.get(), d_.get(), i, force);
      touch.force = sign * matrix(contact.frame).transpose() * vector(force);
    }
    touches_.push_back(touch);
  }
}

// As if the points of the soles carried the robot in equal parts.
void MujocoPhysics::rest_on_touches() {
  double points = 0;
  for (const Touch& touch : touches_) points += touch.foot >= 0 ? 1 : 0;
  for (Touch& touch : touches_) {
    touch.force.setZero();
    if (touch.foot >= 0) touch.force = model_.total_mass * model_.gravity / points * touch.normal;
  }
}

// Within the cone the soft friction of MuJoCo gives way and comes back: that is no slip.
void MujocoPhysics::find_slips() {
  for (size_t i = 0; i < touches_.size(); ++i) {
    if (slides_[i] == 0) continue;
    Touch& touch = touches_[i];
    const Eigen::Vector3d velocity = Bodies(motions_)[touch.body].velocity(touch.p_W);
    touch.slip = h_ * (velocity - velocity.dot(touch.normal) * touch.normal);
  }
}

void MujocoPhysics::update_state() {
  state_.p_WB = vector(d_->qpos);
  state_.R_WB = Eigen::Quaterniond(d_->qpos[3], d_->qpos[4], d_->qpos[5], d_->qpos[6]);
  state_.u.segment<3>(3) = vector(d_->qvel);
  state_.u.head<3>() = state_.R_WB * vector(d_->qvel + 3);
  for (size_t j = 0; j < place_.size(); ++j) {
    state_.q[static_cast<Eigen::Index>(j)] = d_->qpos[place_[j]];
    state_.u[6 + static_cast<Eigen::Index>(j)] = d_->qvel[rate_[j]];
  }
}

Eigen::VectorXd MujocoPhysics::joint_inertia() const {
  for (size_t j = 0; j < rate_.size(); ++j) {
    m_->dof_armature[rate_[j]] = model_.joints[static_cast<int>(j)].rotor_inertia;
  }
  mj_crb(m_.get(), d_.get());
  Eigen::MatrixXd inertia(m_->nv, m_->nv);
  mj_fullM(m_.get(), inertia.data(), d_->qM);
  Eigen::VectorXd result(model_.joint_count);
  for (size_t j = 0; j < rate_.size(); ++j) {
    result[static_cast<Eigen::Index>(j)] = inertia(rate_[j], rate_[j]);
  }
  return result;
}

double MujocoPhysics::resting_depth() const { return kRestingDepth; }

}  // namespace gaitd::sim
