// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/hip_descent.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gaitd::walking {
namespace {

constexpr int kSamples = 8;        // of what is left of the swing
constexpr double kSpeed = 0.09;    // sqrt(g h), with which a hip comes down
constexpr double kLead = 0.4;      // 1/omega, by which a leg is behind what it is told
constexpr double kSteepest = 0.5;  // longest leg: lower no foot makes it

}  // namespace

double highest_hip(const SwingTrajectory& swing, double now, double duration, const SwingLeg& leg) {
  const double speed = kSpeed * leg.gravity / leg.omega;
  const double lead = kLead / leg.omega;
  // Nobody knows when a foot that is late comes down: as far ahead as the leg is behind.
  const double left = duration > now ? duration - now : lead;
  double highest = std::numeric_limits<double>::max();
  for (int i = 0; i <= kSamples; ++i) {
    const double ahead = left * i / kSamples;
    const SwingTrajectory::Sample foot = swing.evaluate(now + ahead);
    const Eigen::Vector3d ankle = foot.position + foot.orientation * leg.ankle_in_sole;
    const Eigen::Vector2d hip = leg.hip.head<2>() +
                                leg.lever * (std::cosh(leg.omega * ahead) - 1.0) +
                                leg.velocity * (std::sinh(leg.omega * ahead) / leg.omega);
    const double vertical = leg.longest * leg.longest - (hip - ankle.head<2>()).squaredNorm();
    const double least = kSteepest * leg.longest;
    const double height = ankle.z() + std::sqrt(std::max(vertical, least * least));
    highest = std::min(highest, height + speed * std::max(0.0, ahead - lead));
  }
  return highest;
}

}  // namespace gaitd::walking
