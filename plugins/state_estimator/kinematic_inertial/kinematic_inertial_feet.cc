// SPDX-License-Identifier: Apache-2.0
// What the feet tell: contacts, anchors, and the errors of the IMU.
#include <algorithm>
#include <cmath>

#include "gaitd/sdk/loads.h"
#include "gaitd/sdk/sensors.h"
#include "kinematic_inertial.h"

namespace gaitd::plugins {
namespace {

using sdk::usable;
using sdk::view;

// The accelerometer bias is found this many times faster while standing.
constexpr double kStandingBalanceFactor = 6.0;
// Share of the weight that the feet must carry before CoP and CoM tell anything.
constexpr double kBalancedShare = 0.5;
// m/s^2, most that the accelerometer may show beside the balance: a push is in it too. Touchdowns
// must fit in: clipped, they would leave what feet do the rest of the time, and tilt the robot.
constexpr double kLargestError = 5.0;
// A robot at rest: for so long (s) no more of that (m/s^2), no foot turned faster (rad/s), and no
// joint of arms and neck, whose motions shift the pelvis against the CoM and take angular momentum.
constexpr double kQuietTime = 0.1;
constexpr double kQuiet = 1.0;
constexpr double kStill = 0.2;
constexpr double kArmsStill = 0.3;      // rad/s
constexpr double kLargestDrift = 0.01;  // rad/s, taken for a bias
constexpr double kStillTime = 0.2;      // s
// Share of the load that makes a foot an anchor: near half, as feet sink in under their load, and
// rise as they lose it.
constexpr double kTrustOn = 0.48;
// Of what the feet of a robot at rest tell in kStillTime of its bias about level axes. If they tell
// it wrongly, the tilt soon puts it right.
constexpr double kStillShare = 0.2;
constexpr double kHeadingRate = 2.0;  // 1/s, of a standing robot, by feet at rest
// s, of contacts of which the bias about the vertical is the mean: each turns by 2 mrad that are
// none.
constexpr double kBiasMemory = 40.0;
constexpr double kShortestStance = 0.2;  // s, which tells anything
constexpr double kBalanceRate = 0.08;    // 1/s, accelerometer bias from CoP and CoM
constexpr double kBalanceLimit = 0.2;    // m/s^2, of that bias

double low_pass(double hertz, double dt) { return 1.0 - std::exp(-2.0 * M_PI * hertz * dt); }

}  // namespace

void KinematicInertial::read_feet(const GaitdStateEstimatorInput& in, GaitdRobotState& out) {
  const double blend = low_pass(p_[P::kForceFilter], in.time.period);
  const double least = p_[P::kContactOn] * weight_;
  Eigen::Vector2d weighted = Eigen::Vector2d::Zero();
  double total = 0.0;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    GaitdFootState& state = out.feet[side];
    const sdk::Vector6d computed =
        ground_ ? ground_->wrench(side) : sdk::Vector6d(sdk::Vector6d::Zero());
    feet_[side].read(in, model_, side, computed, least, blend, weight_, state);
    view(state.cop_world) = sole_point(side, {state.cop[0], state.cop[1], 0.0});
    if (state.cop_valid != 0) {
      weighted += state.normal_force * view(state.cop_world).head<2>();
      total += state.normal_force;
    }
  }
  if (total > 0.0) last_cop_ = weighted / total;
  view(out.cop) = last_cop_;
}

void KinematicInertial::observe_bias(const GaitdStateEstimatorInput& in,
                                     const GaitdRobotState& robot) {
  int index = 0;
  const GaitdImuSensor* sensor = imu(*in.sensors, index);
  if (sensor == nullptr || sensor->has_orientation != 0 || pulled(in)) return;
  if (ground_) return;  // what its feet carry is computed with this very gravity
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), cop = Eigen::Vector3d::Zero();
  double total = 0.0;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    if (sdk::has_force_sensor(model_.feet[side]) && !usable(in.sensors->feet[side])) return;
    const GaitdFootState& foot = robot.feet[side];
    if (foot.cop_valid == 0) continue;
    force += sole_orientation(side) * view(foot.wrench).tail<3>();
    cop += foot.wrench[5] * view(foot.cop_world);
    total += foot.wrench[5];
  }
  if (total < kBalancedShare * weight_) return;  // in flight, or hanging
  const Eigen::Vector3d arm = kinematics_.com() - cop / total;
  const double mass = sdk::total_mass(model_, *in.loads);
  const Eigen::Vector3d balanced = force.dot(arm) / arm.squaredNorm() / mass * arm;
  // The difference of a noisy rate over one tick would be cut off below, and no longer average out.
  const Eigen::Vector3d turning = kShakingPole * (about_ - about_slow_);
  Eigen::Vector3d error = specific_force_ - orientation_.conjugate() * (balanced + turning);
  error.z() = 0.0;
  const bool starting = time_since_start_ < kAveragingTime;
  const bool standing = in.gait->phase == GAITD_PHASE_STAND;
  shaking_ += std::min(1.0, kShakingPole * in.time.period) * (error - shaking_);
  bool arms_move = false;
  for (int i = 0; i < model_.joint_count; ++i) {
    arms_move |= !late_joint_[i] && std::abs(joint_rate_[i]) > kArmsStill;
  }
  if (!standing || arms_move || shaking_.norm() > kQuiet) time_quiet_ = 0.0;
  if (standing && !starting && time_quiet_ < kQuietTime) return;
  error = error.cwiseMax(-kLargestError).cwiseMin(kLargestError);
  const double faster = standing ? kStandingBalanceFactor : 1.0;
  const double share = starting ? averaging_share(in.time.period)
                                : std::min(1.0, faster * kBalanceRate * in.time.period);
  const Eigen::Vector3d before = balance_bias_;
  balance_bias_ = (before + share * error).cwiseMax(-kBalanceLimit).cwiseMin(kBalanceLimit);
  if (!standing) return;  // levelling does it, smoothly
  // The accelerometer has tilted the attitude by this bias.
  const Eigen::Vector3d change = orientation_ * (balance_bias_ - before);
  const Eigen::Vector3d tilt(-change.y() / model_.gravity, change.x() / model_.gravity, 0.0);
  orientation_ = (sdk::exp_so3(tilt) * orientation_).normalized();
}

void KinematicInertial::update_trust(const GaitdStateEstimatorInput& in, double dt) {
  const double total = feet_[0].normal_force + feet_[1].normal_force;
  const double least = 0.2 * weight_;  // in flight no share means anything
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    Foot& f = feet_[side];
    const double share = f.normal_force / std::max(total, least);
    const bool swinging = swings(*in.gait, side);
    f.time_above = share > kTrustOn && !swinging ? f.time_above + dt : 0.0;
    const bool was = f.trusted;
    if (!f.trusted) f.trusted = f.time_above >= kTrustDelay;
    if (share < kTrustOff || swinging) f.trusted = false;
    f.time_trusted = f.trusted && was ? f.time_trusted + dt : 0.0;
    if (f.trusted && !was) {
      f.anchored_point.setZero();
      f.anchor = sole_point(side, f.anchored_point);
      f.orientation_anchored = false;
    }
  }
}

// Feet on which the robot stands do not turn. Only whole windows of rest count, so that the onset
// of a push is no bias.
void KinematicInertial::observe_gyro_bias(double dt) {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  double total = 0.0;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const Foot& f = feet_[side];
    rate += f.normal_force * kinematics_.body_twist(model_.feet[side].body).head<3>();
    total += f.normal_force;
  }
  rate /= std::max(total, 1.0);
  if (rate.norm() > kStill) time_quiet_ = 0.0;
  if (time_quiet_ < kQuietTime) {
    time_still_ = 0.0;
    turned_.setZero();
    return;
  }
  time_still_ += dt;
  // What the attitude has turned by, which the rates of joints between pelvis and IMU are not in.
  turned_ += dt * (orientation_.conjugate() * rate + (turn_ - rate_));
  if (time_still_ < kStillTime) return;
  const Eigen::Vector3d found = turned_ / time_still_;
  if (found.norm() < kLargestDrift) {
    const Eigen::Vector3d up = orientation_.conjugate() * Eigen::Vector3d::UnitZ();
    const double turn = found.dot(up);
    gyro_bias_ += kStillShare * (found - turn * up);
    learn_turn_bias(turn, time_still_);
  }
  time_still_ = 0.0;
  turned_.setZero();
}

void KinematicInertial::learn_turn_bias(double found, double time) {
  if (std::abs(found) > kLargestDrift) return;
  time_bias_ = std::min(kBiasMemory, time_bias_ + time);
  gyro_bias_ += time / time_bias_ * found * (orientation_.conjugate() * Eigen::Vector3d::UnitZ());
}

bool KinematicInertial::rolls(int side, const GaitdStateEstimatorInput& in) const {
  return in.gait->footholds[side].contact == GAITD_CONTACT_TOE;
}

// In a walk, the bias about the vertical from by what each foot turned while it carried alone: as
// the other one lands and takes the load, it turns by some milliradians.
void KinematicInertial::observe_turns(const GaitdStateEstimatorInput& in, double dt) {
  const bool walking = in.gait->phase != GAITD_PHASE_STAND;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    Foot& f = feet_[side];
    const bool alone = feet_[1 - side].contact == GAITD_CONTACT_NONE;
    if (walking && alone && f.rests() && !rolls(side, in)) {
      f.heading_last = sdk::yaw_of(sole_orientation(side));
      if (f.time_carrying <= 0.0) f.heading_first = f.heading_last;
      f.time_carrying += dt;
      continue;
    }
    if (f.time_carrying > kShortestStance) {
      const double turned = std::remainder(f.heading_last - f.heading_first, 2.0 * M_PI);
      learn_turn_bias(turned / f.time_carrying, f.time_carrying);
    }
    f.time_carrying = 0.0;
  }
}

void KinematicInertial::update_anchors(const GaitdStateEstimatorInput& in, double dt) {
  const bool standing = in.gait->phase == GAITD_PHASE_STAND;
  Eigen::Vector3d error = Eigen::Vector3d::Zero();
  double total = 0.0;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    Foot& f = feet_[side];
    if (!f.trusted) continue;
    const bool toe = rolls(side, in);
    const Eigen::Vector3d point =
        toe ? Eigen::Vector3d(view(model_.feet[side].toe_point)) : Eigen::Vector3d::Zero();
    if (point != f.anchored_point) {  // the foot begins to roll over its toe, or comes down again
      f.anchored_point = point;
      f.anchor = sole_point(side, point);
    }
    // In a walk feet turn under their load, as the gyroscope shows: what a foot has to keep is the
    // heading that it has when the robot comes to a stand.
    if (toe || !standing) f.orientation_anchored = false;
    if (toe || !standing || !f.rests()) continue;
    const Eigen::Quaterniond now = sole_orientation(side);
    if (!f.orientation_anchored) {
      f.orientation_anchored = true;
      f.anchor_orientation = now;
    }
    // The heading only: under load a foot tilts by some milliradians.
    error.z() += f.normal_force * sdk::log_so3(f.anchor_orientation * now.conjugate()).z();
    total += f.normal_force;
  }
  if (total <= 0.0) return;
  orientation_ = (sdk::exp_so3(kHeadingRate * dt * error / total) * orientation_).normalized();
}

}  // namespace gaitd::plugins
