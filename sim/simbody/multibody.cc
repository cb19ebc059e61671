// SPDX-License-Identifier: Apache-2.0
#include "multibody.h"

#ifdef NDEBUG
#error "Debian's Simbody changes its data layout under NDEBUG: build without it"
#endif

#include <Simbody.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace gaitd::sim {
namespace {

SimTK::Vec3 vec(const double* v) { return SimTK::Vec3(v[0], v[1], v[2]); }

Eigen::Vector3d eigen(const SimTK::Vec3& v) { return Eigen::Vector3d(v[0], v[1], v[2]); }

// Both store their columns one after the other.
Eigen::Matrix3d eigen(const SimTK::Rotation& r) {
  return Eigen::Map<const Eigen::Matrix3d>(&r.asMat33()(0, 0));
}

SimTK::Body::Rigid make_body(const GaitdBody& body) {
  const double* i = body.inertia;
  const SimTK::Inertia central(i[0], i[3], i[5], i[1], i[2], i[4]);
  const SimTK::Vec3 com = vec(body.com);
  return SimTK::Body::Rigid(
      SimTK::MassProperties(body.mass, com, central.shiftFromMassCenter(com, body.mass)));
}

SimTK::Rotation rotation_of(const double* xyzw) {
  return SimTK::Rotation(SimTK::Quaternion(SimTK::Vec4(xyzw[3], xyzw[0], xyzw[1], xyzw[2])));
}

}  // namespace

struct Multibody::Impl {
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter{system};
  std::vector<SimTK::MobilizedBody> bodies;
  // Of each body, in the cache of `state`, and its entry of body_forces. They stay where they are;
  // to ask Simbody for them ninety times in a step takes as long as half of its kinematics.
  std::vector<const SimTK::Transform*> pose;
  std::vector<const SimTK::SpatialVec*> velocity;
  std::vector<SimTK::SpatialVec*> body_force;
  std::vector<SimTK::Vec3> weight;  // N, W
  std::vector<SimTK::Vec3> com;     // m, body frame
  std::vector<int> q_index;         // first coordinate of each body
  std::vector<int> u_index;
  SimTK::State state;
  std::vector<BodyMotion> motion;
  mutable SimTK::Vector mobility_forces;
  mutable SimTK::Vector_<SimTK::SpatialVec> body_forces;
  mutable SimTK::Vector zero_udot;
  mutable SimTK::Vector residual;

  void add_body(const GaitdModel& model, int index) {
    const GaitdBody& body = model.bodies[index];
    const SimTK::Body::Rigid rigid = make_body(body);
    if (body.parent < 0) {
      bodies.push_back(SimTK::MobilizedBody::Free(matter.Ground(), rigid));
    } else {
      const GaitdJoint& joint = model.joints[body.joint];
      const bool slides = joint.type == GAITD_JOINT_PRISMATIC;
      const SimTK::Rotation along(
          SimTK::UnitVec3(vec(joint.axis)),
          slides ? SimTK::CoordinateAxis(SimTK::XAxis) : SimTK::CoordinateAxis(SimTK::ZAxis));
      const SimTK::Transform parent(rotation_of(joint.orientation) * along, vec(joint.origin));
      const SimTK::Transform child(along, SimTK::Vec3(0));
      SimTK::MobilizedBody& base = bodies.at(static_cast<size_t>(body.parent));
      if (slides) {
        bodies.push_back(SimTK::MobilizedBody::Slider(base, parent, rigid, child));
      } else {
        bodies.push_back(SimTK::MobilizedBody::Pin(base, parent, rigid, child));
      }
    }
    weight.push_back(SimTK::Vec3(0, 0, -body.mass * model.gravity));
    com.push_back(vec(body.com));
  }
};

Multibody::Multibody(const GaitdModel& model) : impl_(std::make_unique<Impl>()) {
  Impl& s = *impl_;
  for (int i = 0; i < model.body_count; ++i) {
    try {
      s.add_body(model, i);
    } catch (const std::exception& error) {
      throw std::invalid_argument(std::string("body ") + model.bodies[i].name +
                                  ": expected a physical rigid body, got: " + error.what());
    }
  }
  s.system.realizeTopology();
  s.state = s.system.getDefaultState();
  s.system.realizeModel(s.state);
  for (const SimTK::MobilizedBody& body : s.bodies) {
    s.q_index.push_back(body.getFirstQIndex(s.state));
    s.u_index.push_back(body.getFirstUIndex(s.state));
  }
  s.motion.resize(s.bodies.size());
  const int nu = s.state.getNU();
  s.mobility_forces.resize(nu);
  s.mobility_forces = 0.0;
  s.zero_udot.resize(nu);
  s.zero_udot = 0.0;
  s.residual.resize(nu);
  s.body_forces.resize(s.matter.getNumBodies());
  s.body_forces = SimTK::SpatialVec(SimTK::Vec3(0), SimTK::Vec3(0));
  s.system.realize(s.state, SimTK::Stage::Velocity);
  for (const SimTK::MobilizedBody& body : s.bodies) {
    s.pose.push_back(&body.getBodyTransform(s.state));
    s.velocity.push_back(&body.getBodyVelocity(s.state));
    s.body_force.push_back(&s.body_forces[body.getMobilizedBodyIndex()]);
  }
}

Multibody::~Multibody() = default;
Multibody::Multibody(Multibody&&) noexcept = default;
Multibody& Multibody::operator=(Multibody&&) noexcept = default;

int Multibody::body_count() const { return static_cast<int>(impl_->bodies.size()); }

int Multibody::joint_count() const { return body_count() - 1; }

void Multibody::set_state(const State& state) {
  Impl& s = *impl_;
  double* q = s.state.updQ().updContiguousScalarData();
  double* u = s.state.updU().updContiguousScalarData();
  const int q0 = s.q_index[0];
  q[q0] = state.R_WB.w();
  q[q0 + 1] = state.R_WB.x();
  q[q0 + 2] = state.R_WB.y();
  q[q0 + 3] = state.R_WB.z();
  for (int k = 0; k < 3; ++k) q[q0 + 4 + k] = state.p_WB[k];
  for (int k = 0; k < 6; ++k) u[s.u_index[0] + k] = state.u[k];
  for (int j = 0; j < joint_count(); ++j) {
    q[s.q_index[static_cast<size_t>(j) + 1]] = state.q[j];
    u[s.u_index[static_cast<size_t>(j) + 1]] = state.u[6 + j];
  }
  s.system.realize(s.state, SimTK::Stage::Velocity);
  for (size_t i = 0; i < s.bodies.size(); ++i) {
    BodyMotion& motion = s.motion[i];
    motion.R_WB = eigen(s.pose[i]->R());
    motion.p_WB = eigen(s.pose[i]->p());
    motion.w_W = eigen((*s.velocity[i])[0]);
    motion.v_W = eigen((*s.velocity[i])[1]);
  }
}

const BodyMotion& Multibody::body(int index) const {
  return impl_->motion[static_cast<size_t>(index)];
}

const std::vector<BodyMotion>& Multibody::bodies() const { return impl_->motion; }

void Multibody::compute_bias(Eigen::VectorXd* c) const {
  const Impl& s = *impl_;
  for (size_t i = 0; i < s.bodies.size(); ++i) {
    const SimTK::Vec3 arm = s.pose[i]->R() * s.com[i];
    *s.body_force[i] = SimTK::SpatialVec(SimTK::cross(arm, s.weight[i]), s.weight[i]);
  }
  s.matter.calcResidualForceIgnoringConstraints(s.state, s.mobility_forces, s.body_forces,
                                                s.zero_udot, s.residual);
  const double* residual = s.residual.getContiguousScalarData();
  for (int k = 0; k < 6; ++k) (*c)[k] = residual[s.u_index[0] + k];
  for (int j = 0; j < joint_count(); ++j) {
    (*c)[6 + j] = residual[s.u_index[static_cast<size_t>(j) + 1]];
  }
}

Eigen::MatrixXd Multibody::mass_matrix() const {
  const Impl& s = *impl_;
  SimTK::Matrix m;
  s.matter.calcM(s.state, m);
  std::vector<int> order;
  for (int k = 0; k < 6; ++k) order.push_back(s.u_index[0] + k);
  for (size_t i = 1; i < s.u_index.size(); ++i) order.push_back(s.u_index[i]);
  const auto n = static_cast<Eigen::Index>(order.size());
  Eigen::MatrixXd result(n, n);
  for (Eigen::Index r = 0; r < n; ++r) {
    for (Eigen::Index c = 0; c < n; ++c) {
      result(r, c) = m(order[static_cast<size_t>(r)], order[static_cast<size_t>(c)]);
    }
  }
  return result;
}

}  // namespace gaitd::sim
