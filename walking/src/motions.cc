// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/motions.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/footsteps.h"
#include "gaitd/walking/pose_path.h"
#include "gaitd/walking/support.h"

namespace gaitd::walking {
namespace {

constexpr double kShiftMargin = 0.03;  // m, of the ICP to the edge of the feet
constexpr double kLowestPelvis = 0.1;  // of the nominal height of the centre of mass
constexpr double kLargestTilt = 0.2;   // rad, roll and pitch
constexpr double kLargestYaw = 0.3;    // rad
constexpr double kFastestTurn = 1.2;   // rad/s, mean, from one way point to the next
// m and rad, beyond those of way points: what a smooth way between them takes.
constexpr double kBeyond = 0.02;
constexpr double kTurnBeyond = 0.05;
constexpr double kChestMiss = 0.02;  // rad, of a spine at its limits
constexpr double kRateShare = 0.5;   // of the velocity limit of a joint, for a motion
constexpr double kPeak = 1.875;      // speed of a minimum-jerk motion, over its mean
constexpr int kSearch = 40;          // steps of the search for where a hand ends
constexpr const char* kTurnNames[] = {"roll", "pitch", "yaw"};

bool is_hand(int part) { return part == GAITD_PART_LEFT_ARM || part == GAITD_PART_RIGHT_ARM; }

bool stands(const GaitdGaitState& gait) {
  return gait.phase == GAITD_PHASE_STAND && gait.footstep_count == 0;
}

Eigen::Quaterniond heading_of(const GaitdGaitState& gait) {
  return sdk::quaternion(
      middle_pose(gait.footholds[GAITD_LEFT].pose, gait.footholds[GAITD_RIGHT].pose).orientation);
}

Eigen::Vector2d turned(const Eigen::Quaterniond& heading, const double* shift) {
  return (heading * Eigen::Vector3d(shift[0], shift[1], 0.0)).head<2>();
}

Eigen::Quaterniond turn_of(const GaitdMotionPoint& point) {
  return sdk::from_roll_pitch_yaw(point.value[3], point.value[4], point.value[5]);
}

// At time 0.
GaitdMotionPoint point_of(const double* shift, const Eigen::Quaterniond& turn) {
  GaitdMotionPoint point{};
  std::copy_n(shift, 3, point.value);
  sdk::view(point.value).segment<3>(3) = sdk::roll_pitch_yaw(turn);
  return point;
}

// The mean rates, to way point `i` of a motion.
Refusal check_turn(const GaitdMotionPoint& from, const GaitdMotionPoint& to, int i) {
  for (int axis = 3; axis < 6; ++axis) {
    const double rate = std::abs(to.value[axis] - from.value[axis]) / (to.time - from.time);
    if (rate <= kFastestTurn) continue;
    return refuse("pose: way point %d turns at %.2f rad/s, at most %.1f expected; give it time",
                  i + 1, rate, kFastestTurn);
  }
  return {};
}

// Times that increase, and numbers; "" where everything is right.
Refusal check_points(const GaitdMotion& motion) {
  if (motion.point_count < 1 || motion.point_count > GAITD_MAX_MOTION_POINTS) {
    return refuse("pose: %d points, 1 to %d expected", motion.point_count, GAITD_MAX_MOTION_POINTS);
  }
  double before = 0.0;
  for (int i = 0; i < motion.point_count; ++i) {
    const GaitdMotionPoint& point = motion.points[i];
    if (!std::isfinite(point.time) || !sdk::view(point.value).allFinite()) {
      return refuse("pose: point %d: numbers expected", i + 1);
    }
    constexpr double kShortest = 0.05;  // s
    if (point.time < before + kShortest) {
      return refuse("pose: point %d: time %.3f s, at least %.2f s after the one before expected",
                    i + 1, point.time, kShortest);
    }
    before = point.time;
  }
  return {};
}

}  // namespace

Motions::Motions(const GaitdModel& model)
    : model_(model),
      kinematics_(model),
      arms_{JointChain::arm(model, GAITD_LEFT), JointChain::arm(model, GAITD_RIGHT)},
      spine_(JointChain::spine(model)) {
  reset();
}

void Motions::reset() {
  motions_ = {};
  motions_.size = sizeof(motions_);
  last_id_ = 0;
  miss_ = {};
}

Refusal Motions::command(const MotionCommand& command, const GaitdRobotState& robot,
                         const GaitdGaitState& gait, const GaitdTaskReferences& references) {
  miss_ = {};
  const GaitdMotion& motion = command.motion;
  Refusal refusal = check_points(motion);
  if (refusal.refused()) return refusal;
  if (command.part == GAITD_PART_PELVIS) {
    refusal = check_pelvis(motion, gait, references);
  } else if (command.part == GAITD_PART_CHEST) {
    refusal = check_chest(motion, references);
  } else if (is_hand(command.part)) {
    const int side = command.part == GAITD_PART_LEFT_ARM ? GAITD_LEFT : GAITD_RIGHT;
    if (arms_[side].size() == 0) {
      return refuse("pose: the robot has no %s hand; name it in robot.yaml: hands",
                    side_name(side));
    }
    refusal = motion.kind == GAITD_MOTION_ARM ? check_arm(arms_[side], motion, references)
                                              : check_hand(arms_[side], motion, robot, references);
  } else {
    return refuse("pose: part %d is none of the body", command.part);
  }
  if (refusal.refused()) return refusal;
  motions_.parts[command.part] = motion;
  motions_.parts[command.part].id = ++last_id_;
  return {};
}

// As far as nothing can follow it: no CMP inside the feet stops a centre of mass that starts so
// fast.
Refusal Motions::check_segment(const GaitdMotion& motion, int i, const GaitdGaitState& gait,
                               const GaitdTaskReferences& references) const {
  const GaitdMotionPoint from =
      i > 0 ? motion.points[i - 1]
            : point_of(references.com_shift, sdk::quaternion(references.pelvis_turn));
  const GaitdMotionPoint& to = motion.points[i];
  const double time = to.time - from.time;
  const Refusal fast = check_turn(from, to, i);
  if (fast.refused()) return fast;
  const Eigen::Vector2d way(to.value[0] - from.value[0], to.value[1] - from.value[1]);
  if (way.norm() == 0.0 || !stands(gait)) return {};
  // Full speed ahead for half of the time, then back.
  const Eigen::Vector2d most = 4.0 / (time * time * gait.omega * gait.omega) * way;
  const Eigen::Vector2d rest = middle(gait.footholds[GAITD_LEFT], gait.footholds[GAITD_RIGHT]);
  const Eigen::Vector2d goal(to.value[0] + most.x(), to.value[1] + most.y());
  const double shift[] = {goal.x(), goal.y()};
  const double inside =
      support_polygon(model_, gait).inside_distance(rest + turned(heading_of(gait), shift));
  if (inside >= 0.0) return {};
  return refuse(
      "pose: way point %d is %.3f m away in %.2f s, and the feet could not stop there; give it "
      "time",
      i + 1, way.norm(), time);
}

Refusal Motions::check_way(const GaitdMotion& motion, const GaitdGaitState& gait,
                           const GaitdTaskReferences& references) const {
  PosePath::Sample now;
  now.position = sdk::view(references.com_shift);
  now.velocity = sdk::view(references.com_shift_velocity);
  now.acceleration = sdk::view(references.com_shift_acceleration);
  now.orientation = sdk::quaternion(references.pelvis_turn);
  now.angular_velocity = sdk::view(references.pelvis_turn_rate);
  PosePath way;
  way.begin(now, motion, 0.0);
  const Eigen::Vector2d rest = middle(gait.footholds[GAITD_LEFT], gait.footholds[GAITD_RIGHT]);
  const auto feet = support_polygon(model_, gait);
  const double lowest = -kLowestPelvis * model_.nominal_com_height;
  constexpr int kSamples = 100;
  for (int k = 1; k <= kSamples; ++k) {
    const PosePath::Sample at = way.at(way.duration() * k / kSamples);
    const Eigen::Vector3d icp = at.position + at.velocity / gait.omega;
    const Eigen::Vector3d turn = sdk::roll_pitch_yaw(at.orientation);
    const bool shifted = !at.position.head<2>().isZero(0.0) || !at.velocity.head<2>().isZero(0.0);
    const bool beside = shifted && stands(gait) &&
                        feet.inside_distance(rest + turned(heading_of(gait), icp.data())) < 0.0;
    const bool low = at.position.z() < lowest - kBeyond || at.position.z() > kBeyond;
    const bool tilted = turn.head<2>().cwiseAbs().maxCoeff() > kLargestTilt + kTurnBeyond ||
                        std::abs(turn.z()) > kLargestYaw + kTurnBeyond;
    if (!beside && !low && !tilted) continue;
    return refuse(
        "pose: the pelvis would swing out to x %.3f, y %.3f, z %.3f m, roll %.2f, pitch %.2f, yaw "
        "%.2f rad on its way; wait until it is at rest, or give it another time",
        at.position.x(), at.position.y(), at.position.z(), turn.x(), turn.y(), turn.z());
  }
  return {};
}

Refusal Motions::check_pelvis(const GaitdMotion& motion, const GaitdGaitState& gait,
                              const GaitdTaskReferences& references) const {
  const double lowest = -kLowestPelvis * model_.nominal_com_height;
  const Eigen::Vector2d rest = middle(gait.footholds[GAITD_LEFT], gait.footholds[GAITD_RIGHT]);
  for (int i = 0; i < motion.point_count; ++i) {
    const double* shift = motion.points[i].value;
    if (shift[2] > 0.0 || shift[2] < lowest) {
      return refuse("pose: pelvis.z %.3f m, %.3f to 0 expected", shift[2], lowest);
    }
    if (shift[2] < 0.0 && gait.mode == GAITD_MODE_WALK_STRAIGHT) {
      return refuse(
          "pose: pelvis.z: straight legs have no height of their own; `gaitctl mode stand`");
    }
    for (int axis = 0; axis < 3; ++axis) {
      const double turn = motion.points[i].value[3 + axis];
      const double largest = axis == 2 ? kLargestYaw : kLargestTilt;
      if (!(std::abs(turn) <= largest)) {
        return refuse("pose: pelvis.%s %.3f rad, %.1f to %.1f expected", kTurnNames[axis], turn,
                      -largest, largest);
      }
    }
    if (shift[0] == 0.0 && shift[1] == 0.0) continue;
    if (!stands(gait)) {
      return refuse(
          "pose: pelvis.x and pelvis.y shift a robot that stands, this one walks; wait until it "
          "stands, or `gaitctl stop`");
    }
    const Eigen::Vector2d goal = rest + turned(heading_of(gait), shift);
    const double inside = support_polygon(model_, gait).inside_distance(goal);
    if (!(inside >= kShiftMargin)) {
      return refuse(
          "pose: pelvis.x %.3f, y %.3f m: the centre of mass would be %.3f m inside the "
          "edge of the feet, at least %.2f expected",
          shift[0], shift[1], inside, kShiftMargin);
    }
  }
  for (int i = 0; i < motion.point_count; ++i) {
    const Refusal fast = check_segment(motion, i, gait, references);
    if (fast.refused()) return fast;
  }
  return check_way(motion, gait, references);
}

Refusal Motions::check_chest(const GaitdMotion& motion,
                             const GaitdTaskReferences& references) const {
  if (spine_.size() == 0) {
    return refuse("pose: chest: no joint moves it against the pelvis; `gaitctl pose pelvis`");
  }
  const JointChain::Pose rest = spine_.pose(spine_.nominal());
  const Eigen::Quaterniond pelvis = sdk::quaternion(references.pelvis_turn);
  for (int i = 0; i < motion.point_count; ++i) {
    JointChain::Pose goal = rest;
    goal.orientation = pelvis.conjugate() * turn_of(motion.points[i]) * rest.orientation;
    JointChain::Joints q = spine_.nominal();
    const GaitdMotionPoint from =
        i > 0 ? motion.points[i - 1]
              : point_of(references.com_shift, sdk::quaternion(references.chest_turn));
    const Refusal fast = check_turn(from, motion.points[i], i);
    if (fast.refused()) return fast;
    const double miss = spine_.reach(goal, kSearch, q).turn;
    if (miss > kChestMiss) {
      const double* turn = motion.points[i].value + 3;
      return refuse(
          "pose: chest.roll %.3f, pitch %.3f, yaw %.3f rad: the spine misses it by %.3f rad at its "
          "limits, at most %.2f expected",
          turn[0], turn[1], turn[2], miss, kChestMiss);
    }
  }
  return {};
}

Refusal Motions::check_arm(const JointChain& arm, const GaitdMotion& motion,
                           const GaitdTaskReferences& references) const {
  for (int joint = 0; joint < arm.size(); ++joint) {
    if ((motion.axis_mask >> joint & 1u) == 0) continue;
    const char* name = model_.joints[arm.joint(joint)].name;
    double position = references.joint_position[arm.joint(joint)];
    double time = 0.0;
    for (int i = 0; i < motion.point_count; ++i) {
      const double goal = motion.points[i].value[joint];
      if (goal < arm.least(joint) || goal > arm.most(joint)) {
        return refuse("pose: %s %.3f rad, %.3f to %.3f expected", name, goal, arm.least(joint),
                      arm.most(joint));
      }
      const double rate = kPeak * std::abs(goal - position) / (motion.points[i].time - time);
      if (rate > kRateShare * arm.fastest()[joint]) {
        return refuse("pose: %s would turn at %.1f rad/s, at most %.1f expected: give it more time",
                      name, rate, kRateShare * arm.fastest()[joint]);
      }
      position = goal;
      time = motion.points[i].time;
    }
  }
  return {};
}

// A hand is not refused for being out of reach: it goes as near as it can.
Refusal Motions::check_hand(const JointChain& arm, const GaitdMotion& motion,
                            const GaitdRobotState& robot, const GaitdTaskReferences& references) {
  kinematics_.update(robot);
  const Eigen::Isometry3d chest = kinematics_.X_WB(model_.chest_body);
  const Eigen::Isometry3d frame =
      motion.frame == GAITD_RELATIVE_TO_WORLD
          ? Eigen::Isometry3d::Identity()
          : (motion.frame == GAITD_RELATIVE_TO_CHEST ? chest : kinematics_.X_WB(0));
  const Eigen::Isometry3d to_chest = chest.inverse() * frame;
  JointChain::Joints q = arm.of(references.joint_position);
  const JointChain::Pose now = arm.pose(q);
  Eigen::Vector3d position = now.position;
  double time = 0.0;
  for (int i = 0; i < motion.point_count; ++i) {
    constexpr double kFastest = 2.0;  // m/s
    const GaitdMotionPoint& point = motion.points[i];
    JointChain::Pose goal = now;
    if ((motion.axis_mask & 0b000111) != 0) {
      goal.position = to_chest * Eigen::Vector3d(point.value[0], point.value[1], point.value[2]);
    }
    if ((motion.axis_mask & 0b111000) != 0) {
      goal.orientation = Eigen::Quaterniond(to_chest.linear()) * turn_of(point);
    }
    const double speed = kPeak * (goal.position - position).norm() / (point.time - time);
    if (speed > kFastest) {
      return refuse(
          "pose: the hand would move at %.1f m/s, at most %.1f expected: give it more time", speed,
          kFastest);
    }
    position = goal.position;
    time = point.time;
    if (i == motion.point_count - 1) miss_ = arm.reach(goal, kSearch, q);
  }
  return {};
}

void shift_plan(const GaitdGaitState& gait, const GaitdTaskReferences& references,
                GaitdIcpPlan& plan) {
  const double* const moved[] = {references.com_shift, references.com_shift_velocity,
                                 references.com_shift_acceleration};
  const auto still = [](const double* v) { return v[0] == 0.0 && v[1] == 0.0; };
  if (std::all_of(std::begin(moved), std::end(moved), still)) return;
  const Eigen::Quaterniond heading = heading_of(gait);
  const Eigen::Vector2d shift = turned(heading, moved[0]);
  const Eigen::Vector2d velocity = turned(heading, moved[1]);
  const Eigen::Vector2d acceleration = turned(heading, moved[2]);
  const double omega = gait.omega;
  sdk::view(plan.icp) += shift + velocity / omega;
  sdk::view(plan.icp_velocity) += velocity + acceleration / omega;
  sdk::view(plan.ecmp) += shift - acceleration / (omega * omega);
}

}  // namespace gaitd::walking
