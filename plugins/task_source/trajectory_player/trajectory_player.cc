// SPDX-License-Identifier: Apache-2.0
#include "trajectory_player.h"

#include <algorithm>

#include "gaitd/sdk/views.h"

namespace gaitd::plugins {

using sdk::view;
using walking::JointChain;
using walking::MinimumJerkPath;
using walking::PosePath;

namespace {

constexpr double kLeaving = 0.8;    // s, in which a walk takes the shift of the CoM back
constexpr double kSettle = 0.3;     // s after a motion, in which its hand comes to rest
constexpr double kOver = 1e6;       // s of a motion, of which nothing is left
constexpr double kRateShare = 0.5;  // of the velocity limits, for an arm that follows its hand
constexpr double kPull = 1.0;       // 1/s, of such an arm to its nominal posture

int part_of(int hand) { return hand == GAITD_LEFT ? GAITD_PART_LEFT_ARM : GAITD_PART_RIGHT_ARM; }

}  // namespace

TrajectoryPlayer::TrajectoryPlayer(const GaitdModel& model)
    : model_(model),
      kinematics_(model),
      arms_{JointChain::arm(model, GAITD_LEFT), JointChain::arm(model, GAITD_RIGHT)} {
  reset();
}

void TrajectoryPlayer::reset() {
  parts_ = {};
  leaving_ = false;
  for (int hand = 0; hand < GAITD_MAX_HANDS; ++hand) {
    position_[hand] = arms_[hand].nominal();
    velocity_[hand] = acceleration_[hand] = Joints::Zero(arms_[hand].size());
  }
}

GaitdStatus TrajectoryPlayer::process(const GaitdTaskSourceInput& in, GaitdTaskReferences& out) {
  out = {};
  out.size = sizeof(out);
  const bool hands =
      std::any_of(std::begin(in.motions->parts), std::end(in.motions->parts),
                  [](const GaitdMotion& motion) { return motion.kind == GAITD_MOTION_HAND; });
  if (hands) {
    const GaitdRobotState& robot = *in.robot;
    kinematics_.update(robot);
  }
  for (int part = 0; part < GAITD_PART_COUNT; ++part) {
    advance(part, in.motions->parts[part], in.time.period);
  }
  leave(*in.gait, in.time.period);
  play_body(out);
  std::copy_n(model_.nominal_position, GAITD_MAX_JOINTS, out.joint_position);
  for (int hand = 0; hand < GAITD_MAX_HANDS; ++hand) play_arm(hand, in, out);
  return GAITD_OK;
}

void TrajectoryPlayer::advance(int part, const GaitdMotion& motion, double dt) {
  Part& p = parts_[part];
  if (motion.id != p.id) {
    p.id = motion.id;
    p.resumed = false;  // another motion than the one that was handed over
    if (part == GAITD_PART_PELVIS) leaving_ = false;
    begin(part, motion, 0.0);
  } else if (p.resumed) {
    begin(part, motion, p.begun + p.elapsed);
  }
  p.resumed = false;
  p.elapsed += dt;
  if (p.kind == GAITD_MOTION_ARM) {
    p.joints_now = p.joints.at(p.elapsed);
  } else if (p.kind != GAITD_MOTION_NONE) {
    p.pose_now = p.pose.at(p.elapsed);
  }
}

// From where the part is now, through the points of the motion that come after `elapsed`.
void TrajectoryPlayer::begin(int part, const GaitdMotion& motion, double elapsed) {
  Part& p = parts_[part];
  const int hand = part == GAITD_PART_LEFT_ARM ? GAITD_LEFT : GAITD_RIGHT;
  const bool arm = part == GAITD_PART_LEFT_ARM || part == GAITD_PART_RIGHT_ARM;
  if (arm && arms_[hand].size() == 0) return;
  p.begun = elapsed;
  p.elapsed = 0.0;
  p.kind = motion.kind;
  if (motion.kind == GAITD_MOTION_HAND) {
    p.pose.begin(p.resumed ? p.pose_now : hand_in(hand, motion.frame), motion, elapsed);
    return;
  }
  if (motion.kind != GAITD_MOTION_ARM) {
    p.pose.begin(p.pose_now, motion, elapsed);
    return;
  }
  MinimumJerkPath::Sample from;
  from.value.head(arms_[hand].size()) = position_[hand];
  from.velocity.head(arms_[hand].size()) = velocity_[hand];
  from.acceleration.head(arms_[hand].size()) = acceleration_[hand];
  if (p.resumed) from = p.joints_now;
  std::array<double, MinimumJerkPath::kMaxPoints> times;
  std::array<MinimumJerkPath::Axes, MinimumJerkPath::kMaxPoints> values;
  int count = 0;
  for (int i = 0; i < std::min<int>(motion.point_count, MinimumJerkPath::kMaxPoints); ++i) {
    if (motion.points[i].time <= elapsed) continue;
    values[count] = from.value;
    for (int axis = 0; axis < arms_[hand].size(); ++axis) {
      if ((motion.axis_mask >> axis & 1u) != 0) {
        values[count][axis] = motion.points[i].value[axis];
      }
    }
    times[count++] = motion.points[i].time - elapsed;
  }
  p.joints.begin(from, times.data(), values.data(), count);
}

// The rest of the motion goes on.
void TrajectoryPlayer::leave(const GaitdGaitState& gait, double dt) {
  Part& p = parts_[GAITD_PART_PELVIS];
  if (p.kind == GAITD_MOTION_NONE) return;
  PosePath::Sample& now = p.pose_now;
  if (leaving_) {
    left_for_ += dt;
    const MinimumJerkPath::Sample back = way_back_.at(left_for_);
    now.position.head<2>() = back.value.head<2>();
    now.velocity.head<2>() = back.velocity.head<2>();
    now.acceleration.head<2>() = back.acceleration.head<2>();
    return;
  }
  if (gait.phase == GAITD_PHASE_STAND) return;
  if (now.position.head<2>().isZero(0.0) && now.velocity.head<2>().isZero(0.0)) return;
  MinimumJerkPath::Sample from;
  from.value.head<2>() = now.position.head<2>();
  from.velocity.head<2>() = now.velocity.head<2>();
  from.acceleration.head<2>() = now.acceleration.head<2>();
  const MinimumJerkPath::Axes home = MinimumJerkPath::Axes::Zero();
  way_back_.begin(from, &kLeaving, &home, 1);
  leaving_ = true;
  left_for_ = 0.0;
}

void TrajectoryPlayer::play_body(GaitdTaskReferences& out) const {
  const PosePath::Sample& pelvis = parts_[GAITD_PART_PELVIS].pose_now;
  view(out.com_shift) = pelvis.position;
  view(out.com_shift_velocity) = pelvis.velocity;
  view(out.com_shift_acceleration) = pelvis.acceleration;
  sdk::store(pelvis.orientation, out.pelvis_turn);
  view(out.pelvis_turn_rate) = pelvis.angular_velocity;
  const PosePath::Sample& chest = parts_[GAITD_PART_CHEST].pose_now;
  sdk::store(chest.orientation, out.chest_turn);
  view(out.chest_turn_rate) = chest.angular_velocity;
}

void TrajectoryPlayer::play_arm(int hand, const GaitdTaskSourceInput& in,
                                GaitdTaskReferences& out) {
  const JointChain& arm = arms_[hand];
  const Part& p = parts_[part_of(hand)];
  GaitdHandReference& reference = out.hands[hand];
  reference.goal.orientation[3] = 1.0;
  if (p.kind == GAITD_MOTION_HAND) {
    const GaitdMotion& motion = in.motions->parts[part_of(hand)];
    follow_hand(hand, motion, in.time.period, reference);
    const GaitdFrame& frame = model_.hands[hand];
    const JointChain::Pose goal{view(reference.goal.position),
                                sdk::quaternion(reference.goal.orientation)};
    const JointChain::Pose now{
        kinematics_.frame_position(frame.body, view(frame.origin)),
        Eigen::Quaterniond(kinematics_.R_WB(frame.body)) * sdk::quaternion(frame.orientation)};
    const JointChain::Miss miss = JointChain::miss(goal, now);
    reference.position_error = miss.position;
    reference.turn_error = miss.turn;
    reference.on_its_way = p.elapsed < p.pose.duration() + kSettle ? 1 : 0;
    reference.active = 1;
  } else if (p.kind == GAITD_MOTION_ARM) {
    position_[hand] = p.joints_now.value.head(arm.size());
    velocity_[hand] = p.joints_now.velocity.head(arm.size());
    acceleration_[hand] = p.joints_now.acceleration.head(arm.size());
  } else if (position_[hand] != arm.nominal()) {  // another variant moved it
    velocity_[hand] = kPull * (arm.nominal() - position_[hand]);
    acceleration_[hand].setZero();
    position_[hand] += in.time.period * velocity_[hand];
  }
  for (int i = 0; i < arm.size(); ++i) {
    const int joint = arm.joint(i);
    out.joint_position[joint] = position_[hand][i];
    out.joint_velocity[joint] = velocity_[hand][i];
    out.joint_acceleration[joint] = acceleration_[hand][i];
  }
}

void TrajectoryPlayer::follow_hand(int hand, const GaitdMotion& motion, double dt,
                                   GaitdHandReference& out) {
  const JointChain& arm = arms_[hand];
  const PosePath::Sample& path = parts_[part_of(hand)].pose_now;
  const Eigen::Isometry3d frame = frame_pose(motion.frame);
  const Eigen::Isometry3d chest = kinematics_.X_WB(model_.chest_body);
  const Eigen::Isometry3d frame_in_chest = chest.inverse() * frame;
  const Eigen::Quaterniond turn(frame_in_chest.linear());
  const JointChain::Pose goal{frame_in_chest * path.position,
                              (turn * path.orientation).normalized()};
  view(out.goal.position) = frame * path.position;
  sdk::store((Eigen::Quaterniond(frame.linear()) * path.orientation).normalized(),
             out.goal.orientation);

  Joints& q = position_[hand];
  const Joints before = q;
  arm.step(goal, kRateShare * dt * arm.fastest(), std::min(1.0, kPull * dt), q);
  const JointChain::Miss miss = JointChain::miss(goal, arm.pose(q));
  out.reach_error[0] = miss.position;
  out.reach_error[1] = miss.turn;
  velocity_[hand] = (q - before) / dt;
  // What the frame does itself is measured, and its acceleration would be noise.
  JointChain::Twist wanted;
  wanted << turn * path.angular_acceleration, turn * path.acceleration;
  wanted -= (arm.jacobian(q) - arm.jacobian(before)) * velocity_[hand] / dt;
  acceleration_[hand] = arm.rates(q, wanted);
}

Eigen::Isometry3d TrajectoryPlayer::frame_pose(int frame) const {
  if (frame == GAITD_RELATIVE_TO_WORLD) return Eigen::Isometry3d::Identity();
  return kinematics_.X_WB(frame == GAITD_RELATIVE_TO_CHEST ? model_.chest_body : 0);
}

JointChain::Twist TrajectoryPlayer::twist_at(int body, const Eigen::Vector3d& at) const {
  JointChain::Twist twist = kinematics_.body_twist(body);
  twist.tail<3>() += twist.head<3>().cross(at - kinematics_.p_WB(body));
  return twist;
}

JointChain::Twist TrajectoryPlayer::frame_twist(int frame, const Eigen::Vector3d& at) const {
  if (frame == GAITD_RELATIVE_TO_WORLD) return JointChain::Twist::Zero();
  return twist_at(frame == GAITD_RELATIVE_TO_CHEST ? model_.chest_body : 0, at);
}

// Where the reference of the hand is, in the frame of a motion that begins.
PosePath::Sample TrajectoryPlayer::hand_in(int hand, int frame) const {
  const JointChain& arm = arms_[hand];
  const JointChain::Pose now = arm.pose(position_[hand]);
  const Eigen::Isometry3d chest = kinematics_.X_WB(model_.chest_body);
  const Eigen::Isometry3d in = frame_pose(frame).inverse();
  const Eigen::Vector3d at = chest * now.position;
  JointChain::Twist twist = arm.jacobian(position_[hand]) * velocity_[hand];
  twist.head<3>() = chest.linear() * twist.head<3>();
  twist.tail<3>() = chest.linear() * twist.tail<3>();
  twist += twist_at(model_.chest_body, at) - frame_twist(frame, at);
  PosePath::Sample out;
  out.position = in * at;
  out.orientation = Eigen::Quaterniond((in * chest).linear()) * now.orientation;
  out.orientation.normalize();
  out.velocity = in.linear() * twist.tail<3>();
  out.angular_velocity = in.linear() * twist.head<3>();
  return out;
}

void TrajectoryPlayer::get_state(GaitdTaskSourceState& state) const {
  for (int i = 0; i < GAITD_PART_COUNT; ++i) {
    const Part& p = parts_[i];
    GaitdMotionProgress& out = state.parts[i];
    out.id = p.id;
    out.kind = p.kind;
    // A walk has taken back what is over of the pelvis, and takes back the rest.
    const bool over = i == GAITD_PART_PELVIS && leaving_ && p.elapsed >= p.pose.duration();
    out.elapsed = over ? kOver : p.begun + p.elapsed;
    if (p.kind == GAITD_MOTION_ARM) {
      view(out.value) = p.joints_now.value;
      view(out.velocity) = p.joints_now.velocity;
      view(out.acceleration) = p.joints_now.acceleration;
      continue;
    }
    view(out.value).head<3>() = p.pose_now.position;
    view(out.value).segment<4>(3) = p.pose_now.orientation.coeffs();
    view(out.velocity).head<3>() = p.pose_now.velocity;
    view(out.velocity).segment<3>(3) = p.pose_now.angular_velocity;
    view(out.acceleration).head<3>() = p.pose_now.acceleration;
    view(out.acceleration).segment<3>(3) = p.pose_now.angular_acceleration;
  }
  for (int hand = 0; hand < GAITD_MAX_HANDS; ++hand) {
    for (int i = 0; i < arms_[hand].size(); ++i) {
      state.joint_position[arms_[hand].joint(i)] = position_[hand][i];
      state.joint_velocity[arms_[hand].joint(i)] = velocity_[hand][i];
    }
  }
}

void TrajectoryPlayer::set_state(const GaitdTaskSourceState& state) {
  reset();
  for (int i = 0; i < GAITD_PART_COUNT; ++i) {
    Part& p = parts_[i];
    const GaitdMotionProgress& in = state.parts[i];
    p.id = in.id;
    p.kind = in.kind;
    p.begun = in.elapsed;
    p.resumed = in.kind != GAITD_MOTION_NONE;
    p.joints_now = {view(in.value), view(in.velocity), view(in.acceleration)};
    p.pose_now.position = view(in.value).head<3>();
    if (p.resumed) p.pose_now.orientation.coeffs() = view(in.value).segment<4>(3);
    p.pose_now.velocity = view(in.velocity).head<3>();
    p.pose_now.angular_velocity = view(in.velocity).segment<3>(3);
    p.pose_now.acceleration = view(in.acceleration).head<3>();
    p.pose_now.angular_acceleration = view(in.acceleration).segment<3>(3);
  }
  for (int hand = 0; hand < GAITD_MAX_HANDS; ++hand) {
    position_[hand] = arms_[hand].of(state.joint_position);
    velocity_[hand] = arms_[hand].of(state.joint_velocity);
  }
}

}  // namespace gaitd::plugins
