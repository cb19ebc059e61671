// SPDX-License-Identifier: Apache-2.0
// What the feet tell: contacts, trust, and the specific force of a robot that balances.
#include <algorithm>
#include <cmath>

#include "gaitd/sdk/loads.h"
#include "gaitd/sdk/sensors.h"
#include "invariant_ekf.h"

namespace gaitd::plugins {
namespace {

using sdk::view;

constexpr double kBalancedLoad = 0.5;     // weights; less is flight, or a robot that hangs
constexpr double kStandingBalance = 0.2;  // of the noise of a walk
constexpr double kPushStanding = 0.6;     // m/s^2 that only a push makes
constexpr double kPushWalking = 3.0;
constexpr double kTrustOn = 0.35;     // share of the load that makes a foot a contact
constexpr double kHoistNoise = 0.05;  // m/sqrt(Hz), by which a robot on its hoist moves about
// rad, by which a sole lies otherwise than where it came to rest: it turns, or rolls on an edge.
// And s, after which it lies there.
constexpr double kTurned = 0.05;
constexpr double kLies = 0.5;
// Densities: of a foot seen through the encoders (m/sqrt(Hz)), of the specific force that CoP and
// CoM tell (m/s^2/sqrt(Hz)).
constexpr double kKinematicNoise = 5e-5;
constexpr double kBalanceNoise = 0.12;

// Standard deviation of one sample, from a density.
double per_sample(double density, double dt) { return density / std::sqrt(dt); }

}  // namespace

void InvariantEkf::read_forces(const GaitdStateEstimatorInput& in, GaitdRobotState& out) {
  const double share = 1.0 - std::exp(-2.0 * M_PI * p_[P::kForceFilter] * in.time.period);
  const double least = p_[P::kContactOn] * weight_;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const sdk::Vector6d computed =
        ground_ ? ground_->wrench(side) : sdk::Vector6d(sdk::Vector6d::Zero());
    feet_[side].read(in, model_, side, computed, least, share, weight_, out.feet[side]);
  }
}

void InvariantEkf::observe_ground(const GaitdStateEstimatorInput& in) {
  if (!ground_) return;
  const dynamics::FootWrenches::Motion motion = {
      .imu = imu_,
      .orientation = filter_.orientation,
      .rate = rate_ + place_.rate - filter_.gyro_bias,
      .specific_force = specific_force_ - filter_.accelerometer_bias};
  ground_->update(motion, p_[P::kForceFilter], in.time.period, *in.sensors);
}

void InvariantEkf::update_trust(const GaitdStateEstimatorInput& in) {
  const double total = feet_[0].normal_force + feet_[1].normal_force;
  const double least = 0.2 * weight_;  // in flight no share means anything
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    Foot& f = feet_[side];
    const double share = f.normal_force / std::max(total, least);
    const bool swinging = swings(*in.gait, side);
    f.time_above = share > kTrustOn && !swinging ? f.time_above + in.time.period : 0.0;
    const bool earned = f.time_above >= kTrustDelay;
    f.trusted = earned || (f.trusted && share >= kTrustOff && !swinging);
    f.time_trusted = f.trusted ? f.time_trusted + in.time.period : 0.0;
  }
}

// The frame itself is a point that stays about where it is.
void InvariantEkf::hold_on_hoist(double dt) {
  const double sigma = per_sample(kHoistNoise, dt);
  const int here = index(GAITD_LEFT, kToe);
  if (filter_.has_point(here)) {
    filter_.correct_point(here, Eigen::Vector3d::Zero(), sigma);
  } else {
    filter_.add_point(here, Eigen::Vector3d::Zero(), kHoistNoise);
  }
}

void InvariantEkf::correct(const GaitdStateEstimatorInput& in, const GaitdRobotState& joints) {
  update_joint_kinematics(joints);
  const bool carried = feet_[GAITD_LEFT].trusted || feet_[GAITD_RIGHT].trusted;
  time_unsupported_ = carried ? 0.0 : time_unsupported_ + in.time.period;
  const bool hung = hangs_;
  hangs_ = time_unsupported_ > sdk::kLongestFlight;
  if (hung && !hangs_) filter_.remove_point(index(GAITD_LEFT, kToe));
  if (hangs_) return hold_on_hoist(in.time.period);
  const double sigma = per_sample(kKinematicNoise, in.time.period);
  const bool turned[] = {has_turned(GAITD_LEFT, in.time.period),
                         has_turned(GAITD_RIGHT, in.time.period)};
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const bool only_toe = in.gait->footholds[side].contact == GAITD_CONTACT_TOE ||
                          feet_[side].time_trusted < kRestDelay || turned[side];
    for (const Point point : {kToe, kHeel}) {
      const int i = index(side, point);
      const Eigen::Vector3d place = sole_point(side, feet_[side].points[point]) - lever();
      if (!feet_[side].trusted || (only_toe && point == kHeel)) {
        filter_.remove_point(i);
      } else if (!filter_.has_point(i)) {
        filter_.add_point(i, place, sigma);
      } else {
        filter_.correct_point(i, place, sigma);
      }
    }
  }
}

bool InvariantEkf::has_turned(int side, double dt) {
  Foot& f = feet_[side];
  const Eigen::Quaterniond now = sole_orientation(side);
  if (f.time_trusted < kRestDelay || f.time_turned > kLies) {
    f.rest = now;
    f.time_turned = 0.0;
  }
  const bool turned = now.angularDistance(f.rest) > kTurned;
  f.time_turned = turned ? f.time_turned + dt : 0.0;
  return turned;
}

void InvariantEkf::observe_balance(const GaitdStateEstimatorInput& in,
                                   const GaitdRobotState& robot) {
  if (sdk::first_usable_imu(model_, *in.sensors) < 0) return;
  if (pulled(in) || ground_) return;  // without sensors the load is computed with this gravity
  double load = 0.0;
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), loaded = Eigen::Vector3d::Zero();
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    if (sdk::has_force_sensor(model_.feet[side]) && !sdk::usable(in.sensors->feet[side])) return;
    const GaitdFootState& foot = robot.feet[side];
    if (foot.cop_valid == 0) continue;
    load += foot.wrench[5];
    loaded += foot.wrench[5] * sole_point(side, {foot.cop[0], foot.cop[1], 0.0});
    force += sole_orientation(side) * view(foot.wrench).tail<3>();
  }
  if (load < kBalancedLoad * weight_) return;
  const Eigen::Vector3d line = (kinematics_.com() - loaded / load).normalized();
  const Eigen::Vector3d balanced = line.dot(force) / sdk::total_mass(model_, *in.loads) * line;
  // A push is in it too.
  const Eigen::Vector3d error = specific_force_ - balanced - filter_.accelerometer_bias;
  const bool standing = in.gait->phase == GAITD_PHASE_STAND;
  if (error.head<2>().norm() > (standing ? kPushStanding : kPushWalking)) return;
  const double share = standing ? kStandingBalance : 1.0;
  filter_.correct_specific_force(specific_force_, balanced,
                                 per_sample(share * kBalanceNoise, in.time.period));
}

void InvariantEkf::write_feet(GaitdRobotState& out) {
  Eigen::Vector2d weighted = Eigen::Vector2d::Zero();
  double total = 0.0;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    GaitdFootState& state = out.feet[side];
    const GaitdFoot& foot = model_.feet[side];
    view(state.position) = sole_point(side, Eigen::Vector3d::Zero());
    sdk::store(sole_orientation(side), state.orientation);
    view(state.twist) = kinematics_.frame_velocity(foot.body, view(foot.sole.origin));
    view(state.cop_world) = sole_point(side, {state.cop[0], state.cop[1], 0.0});
    if (feet_[side].trusted) {
      feet_[side].anchor = view(state.position);
      feet_[side].anchor_yaw = sdk::yaw_of(sdk::quaternion(state.orientation));
    }
    if (state.cop_valid == 0) continue;
    weighted += state.normal_force * view(state.cop_world).head<2>();
    total += state.normal_force;
  }
  if (total > 0.0) last_cop_ = weighted / total;
  view(out.cop) = last_cop_;
}

}  // namespace gaitd::plugins
