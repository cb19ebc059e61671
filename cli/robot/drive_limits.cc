// SPDX-License-Identifier: Apache-2.0
#include "cli/robot/drive_limits.h"

#include <algorithm>
#include <cmath>

#include "gaitd/walking/leg_geometry.h"

namespace gaitd::porting {
namespace {

// Efforts of Atlas over its weight times the height of its centre of mass; those of a Unitree G1
// lie between a third of them and a tenth more.
constexpr double kHipEffort = 0.42;
constexpr double kKneeEffort = 0.45;
constexpr double kAnkleEffort = 0.37;
constexpr double kOtherEffort = 0.25;
constexpr double kVelocity = 4.2;      // of joints of Atlas, over sqrt(g / height)
constexpr double kPlaceholder = 3.0;   // an effort that no robot has, over weight times height
constexpr double kMostVelocity = 100;  // rad/s
constexpr double kKneeRange = 2.4;     // rad, from straight
constexpr double kRange = 1.57;        // rad, about the posture, of the other joints

double effort_share(const LegGuess& leg, int joint) {
  if (joint == leg.hip_pitch) return kHipEffort;
  if (joint == leg.knee) return kKneeEffort;
  return joint == leg.ankle_pitch ? kAnkleEffort : kOtherEffort;
}

// Two digits are enough for what nobody knows.
double two_digits(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::round(value / unit) * unit;
}

}  // namespace

void guess_drive_limits(Guess* guess) {
  GaitdModel& model = guess->model;
  const double height = model.nominal_com_height;
  const double moment = model.total_mass * model.gravity * height;  // N m
  const double velocity = two_digits(kVelocity * std::sqrt(model.gravity / height));
  for (int side = 0; side < 2; ++side) {
    const LegGuess& leg = guess->legs[static_cast<std::size_t>(side)];
    for (const int index : leg.joints) {
      GaitdJoint& joint = model.joints[index];
      DriveLimitGuess limit{joint.name, 0.0, 0.0, {}, false};
      if (joint.effort_limit > kPlaceholder * moment) {
        joint.effort_limit = limit.effort = two_digits(effort_share(leg, index) * moment);
      }
      if (joint.velocity_limit >= kMostVelocity) {
        joint.velocity_limit = limit.velocity = velocity;
      }
      if (joint.position_max >= dynamics::kNoUrdfLimit) {
        limit.has_range = true;
        const double at = model.nominal_position[index];
        limit.range = {at - kRange, at + kRange};
        if (index == leg.knee) {
          const double straight = walking::LegGeometry(model, side).straight();
          const double bent = straight + model.legs[side].knee_bend_sign * kKneeRange;
          limit.range = {std::min(straight, bent), std::max(straight, bent)};
        }
        joint.position_min = limit.range[0];
        joint.position_max = limit.range[1];
      } else if (range_of_continuous(*guess, joint.name) != nullptr) {
        limit.has_range = true;
        limit.range = {joint.position_min, joint.position_max};
      }
      if (limit.effort > 0.0 || limit.velocity > 0.0 || limit.has_range) {
        guess->drive_limits.push_back(limit);
      }
    }
  }
  if (guess->drive_limits.empty()) return;
  guess->drive_limits_why.push_back(format(
      "The URDF gives nothing for these, no end or a placeholder. In proportion to Atlas, with "
      "%.1f kg at %.2f m: enough to walk in simulation. Write what the data sheets of the "
      "drives say before you trust a torque. Ranges of continuous joints are those of the URDF.",
      model.total_mass, height));
}

}  // namespace gaitd::porting
