// SPDX-License-Identifier: Apache-2.0
#include "daemon/conformance/sample_walk.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/chain.h"
#include "gaitd/sdk/views.h"

namespace gaitd::daemon {
namespace {

using sdk::view;

constexpr double kStandFirst = 0.3;  // s
constexpr double kStandLast = 0.2;   // s
constexpr double kLongest = 20.0;    // s, of everything
constexpr double kSinkTime = 1.0;    // s, from the beginning, in which the knees bend for the walk
constexpr double kMotion = 1.0;      // s, of the motions of the body
constexpr double kSink = 0.06;       // of the pelvis height: no leg is ever stretched

}  // namespace

SampleWalk::SampleWalk(const GaitdModel& model)
    : model_(model),
      gait_(model),
      planner_(model),
      objectives_(model),
      legs_(model),
      kinematics_(model),
      q_(sdk::head(model.nominal_position, model.joint_count)),
      qd_(Eigen::VectorXd::Zero(model.joint_count)),
      pelvis_(0.0, 0.0, model.nominal_pelvis_height) {
  set_.time.period = kPeriod;
  set_.time.tick = -1;
  set_.toe_off.size = sizeof(set_.toe_off);
  set_.toe_off.side = GAITD_BOTH;
  set_.adjustment.size = sizeof(set_.adjustment);
  set_.commands.size = sizeof(set_.commands);
  set_.commands.joint_count = model.joint_count;
  // The nominal posture, with the middle of the soles at the origin.
  kinematics_.update(pelvis_, Eigen::Quaterniond::Identity(), sdk::Vector6d::Zero(), q_, qd_);
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const GaitdFoot& foot : model.feet) {
    middle += 0.5 * kinematics_.frame_position(foot.body, view(foot.sole.origin));
  }
  pelvis_ -= middle;
  standing_height_ = pelvis_.z();
  com_ = kinematics_.com().head<2>() - middle.head<2>();
  offset_ = pelvis_.head<2>() - com_;
  feel(qd_, pelvis_velocity_);
  ask_for_motions();
  gait_.reset(set_.robot);
  set_.gait = gait_.state();
  objectives_.reset(set_.robot, set_.gait);
  planner_.update(kPeriod, set_.robot, set_.gait, walking::CmpOffsets(model_.nominal_com_height),
                  set_.plan);
}

// Every kind of motion that the robot is able to.
void SampleWalk::ask_for_motions() {
  set_.motions.size = sizeof(set_.motions);
  const auto ask = [this](int part, int kind, std::uint32_t mask) -> GaitdMotionPoint& {
    GaitdMotion& motion = set_.motions.parts[part];
    motion.id = static_cast<std::uint32_t>(part + 1);
    motion.kind = kind;
    motion.axis_mask = mask;
    motion.point_count = 1;
    motion.points[0].time = kMotion;
    return motion.points[0];
  };
  ask(GAITD_PART_PELVIS, GAITD_MOTION_PELVIS, 0b111111).value[1] = 0.02;
  ask(GAITD_PART_CHEST, GAITD_MOTION_CHEST, 0b111000).value[5] = 0.1;
  if (sdk::arm_of(model_, GAITD_LEFT).count == 0 || sdk::arm_of(model_, GAITD_RIGHT).count == 0) {
    return;
  }
  ask(GAITD_PART_LEFT_ARM, GAITD_MOTION_ARM, 0b1).value[0] =
      model_.nominal_position[sdk::arm_of(model_, GAITD_LEFT).joints[0]];
  // Perhaps out of reach.
  ask(GAITD_PART_RIGHT_ARM, GAITD_MOTION_HAND, 0b000111).value[0] = 0.3 * model_.nominal_com_height;
  set_.motions.parts[GAITD_PART_RIGHT_ARM].frame = GAITD_RELATIVE_TO_PELVIS;
}

Eigen::Vector3d SampleWalk::sole(int side) {
  const GaitdGaitState& g = set_.gait;
  if (g.footholds[side].contact != GAITD_CONTACT_NONE) return view(g.footholds[side].pose.position);
  if (swing_step_ != g.step_index) {
    swing_step_ = g.step_index;
    swing_.begin(gait_.lift_off(), sdk::Vector6d::Zero(), g.footholds[side].pose.position[2],
                 g.adjusted[0], g.phase_duration, {});
  }
  return swing_.evaluate(std::min(g.time_in_phase, g.phase_duration)).position;
}

// Share of the weight that a foot carries: none in the air, else by where the plan has the eCMP.
double SampleWalk::load(int side) const {
  const GaitdGaitState& g = set_.gait;
  const int other = 1 - side;
  const bool landed = g.time_in_phase + 0.5 * kPeriod >= g.phase_duration;
  if (g.footholds[side].contact == GAITD_CONTACT_NONE) return landed ? 0.2 : 0.0;
  if (g.footholds[other].contact == GAITD_CONTACT_NONE) return landed ? 0.8 : 1.0;
  const Eigen::Vector2d here = view(g.footholds[side].pose.position).head<2>();
  const Eigen::Vector2d there = view(g.footholds[other].pose.position).head<2>();
  const Eigen::Vector2d line = here - there;
  const double along = (view(set_.plan.ecmp) - there).dot(line) / line.squaredNorm();
  return std::clamp(along, 0.05, 0.95);
}

void SampleWalk::move() {
  const Eigen::VectorXd last = q_;
  const Eigen::VectorXd last_velocity = qd_;
  const Eigen::Vector3d last_pelvis = pelvis_;
  const Eigen::Vector3d last_pelvis_velocity = pelvis_velocity_;
  com_ += kPeriod * set_.gait.omega * (view(set_.plan.icp) - com_);
  pelvis_.head<2>() = com_ + offset_;
  const double share = std::min(1.0, set_.time.time / kSinkTime);
  const double smooth = share * share * share * (10.0 - 15.0 * share + 6.0 * share * share);
  pelvis_.z() = standing_height_ - kSink * model_.nominal_pelvis_height * smooth;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) legs_.solve(side, pelvis_, sole(side), q_);
  qd_ = (q_ - last) / kPeriod;
  pelvis_velocity_ = (pelvis_ - last_pelvis) / kPeriod;
  feel(last_velocity, last_pelvis_velocity);
  offset_ = pelvis_.head<2>() - view(set_.robot.com).head<2>();
}

// Sensors and state that belong to the motion.
void SampleWalk::feel(const Eigen::VectorXd& last_velocity,
                      const Eigen::Vector3d& last_pelvis_velocity) {
  GaitdSensors& s = set_.sensors;
  GaitdRobotState& r = set_.robot;
  const int joints = model_.joint_count;
  const double weight = model_.total_mass * model_.gravity;
  const GaitdSignalInfo info{static_cast<int64_t>(1e6) * set_.time.tick, 0.0,
                             static_cast<uint32_t>(set_.time.tick + 1), 1};
  s.size = sizeof(s);
  s.joint_count = joints;
  s.imu_count = model_.imu_count;
  s.foot_count = GAITD_MAX_FEET;
  s.tick = set_.time.tick;
  s.time = set_.time.time;
  r.size = sizeof(r);
  r.joint_count = joints;
  r.valid = 1;
  for (int i = 0; i < joints; ++i) {
    s.joints[i].info = info;
    s.joints[i].position = r.joint_position[i] = q_[i];
    s.joints[i].velocity = r.joint_velocity[i] = qd_[i];
    set_.commands.joints[i].mode = GAITD_JOINT_MODE_TORQUE;
    set_.commands.joints[i].acceleration = (qd_[i] - last_velocity[i]) / kPeriod;
  }
  view(r.pelvis_position) = pelvis_;
  r.pelvis_orientation[3] = 1.0;
  view(r.pelvis_twist).tail<3>() = pelvis_velocity_;
  const Eigen::Vector3d specific_force = (pelvis_velocity_ - last_pelvis_velocity) / kPeriod +
                                         model_.gravity * Eigen::Vector3d::UnitZ();
  for (int i = 0; i < model_.imu_count; ++i) {
    s.imus[i].info = info;
    view(s.imus[i].specific_force) =
        sdk::quaternion(model_.imus[i].orientation).conjugate() * specific_force;
  }
  kinematics_.update(pelvis_, Eigen::Quaterniond::Identity(), view(r.pelvis_twist), q_, qd_);
  view(r.com) = kinematics_.com();
  view(r.com_velocity) = kinematics_.com_velocity();
  view(r.icp) = view(r.com).head<2>();
  if (set_.gait.omega > 0.0) view(r.icp) += view(r.com_velocity).head<2>() / set_.gait.omega;
  r.cop[0] = r.cop[1] = 0.0;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdFoot& foot = model_.feet[side];
    const Eigen::Vector3d origin = view(foot.sole.origin);
    GaitdFootState& f = r.feet[side];
    view(f.position) = kinematics_.frame_position(foot.body, origin);
    const Eigen::Quaterniond sole_in_body = sdk::quaternion(foot.sole.orientation);
    sdk::store((Eigen::Quaterniond(kinematics_.R_WB(foot.body)) * sole_in_body).normalized(),
               f.orientation);
    view(f.twist) = kinematics_.frame_velocity(foot.body, origin);
    // Along the normal of the sole, through its origin.
    f.normal_force = (set_.time.tick < 0 ? 0.5 : load(side)) * weight;
    f.contact = f.normal_force > 0.0 ? GAITD_CONTACT_FULL : GAITD_CONTACT_NONE;
    f.cop_valid = f.contact != GAITD_CONTACT_NONE ? 1 : 0;
    f.wrench[5] = f.normal_force;
    view(f.cop_world) = view(f.position);
    view(r.cop) += f.normal_force / weight * view(f.position).head<2>();
    const Eigen::Vector3d force = sole_in_body * Eigen::Vector3d(0.0, 0.0, f.normal_force);
    const Eigen::Vector3d moment = (origin - view(foot.force_sensor.origin)).cross(force);
    const Eigen::Quaterniond to_sensor = sdk::quaternion(foot.force_sensor.orientation).conjugate();
    s.feet[side].info = info;
    view(s.feet[side].force) = to_sensor * force;
    view(s.feet[side].moment) = to_sensor * moment;
  }
}

// Gait, plan and objectives of this tick.
void SampleWalk::decide() {
  if (!walked_ && set_.time.time >= kStandFirst) {
    walking::WalkCommand walk;
    walk.steps = 2;
    walk.length = 0.15 * model_.nominal_com_height;
    walk.swing_duration = 0.5;
    walk.transfer_duration = 0.2;
    gait_.walk(walk);
    walked_ = true;
  }
  gait_.update(kPeriod, set_.robot, set_.plan, set_.toe_off, set_.adjustment);
  set_.gait = gait_.state();
  planner_.update(kPeriod, set_.robot, set_.gait, walking::CmpOffsets(model_.nominal_com_height),
                  set_.plan);
  GaitdStepAdjustment& a = set_.adjustment;
  const double omega = set_.gait.omega;
  a.kappa = 1.0;
  view(a.cmp) = view(set_.plan.ecmp);
  view(a.ecmp) = view(set_.plan.ecmp);
  view(a.linear_momentum_rate) =
      model_.total_mass * omega * omega * (view(set_.robot.com).head<2>() - view(a.ecmp));
  objectives_.update(kPeriod, set_.robot, set_.gait, gait_.lift_off(), a, set_.toe_off,
                     set_.objectives);
  const bool standing = set_.gait.phase == GAITD_PHASE_STAND;
  time_standing_ = walked_ && standing ? time_standing_ + kPeriod : 0.0;
}

bool SampleWalk::tick() {
  if (time_standing_ > kStandLast || set_.time.time > kLongest) return false;
  ++set_.time.tick;
  set_.time.time = kPeriod * static_cast<double>(set_.time.tick);
  set_.gait_before = set_.gait;
  move();
  decide();
  return true;
}

}  // namespace gaitd::daemon
