// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/hip_descent.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gaitd::walking {
namespace {

constexpr double kComesDown = 0.5;  // of a swing: a foot that still rises asks for nothing
constexpr int kSamples = 8;         // of what is left of the swing
constexpr double kSpeed = 0.3;      // sqrt(g h), with which a hip comes down over level ground
constexpr double kBraking = 0.2;    // g, with which it comes to a stop over lower ground
constexpr double kLead = 0.4;       // 1/omega, by which a leg is behind what it is told
constexpr double kFall = 0.1;       // heights of the CoM, down to ground where that matters in full
constexpr double kSteepest = 0.5;   // longest leg: lower no foot makes it

// m, W: of a hip there, over an ankle that a leg of that length spans.
double height_over(const Eigen::Vector3d& ankle, const Eigen::Vector2d& hip, double longest) {
  const double vertical = longest * longest - (hip - ankle.head<2>()).squaredNorm();
  const double least = kSteepest * longest;
  return ankle.z() + std::sqrt(std::max(vertical, least * least));
}

}  // namespace

double highest_hip(const SwingTrajectory& swing, double now, double duration, const SwingLeg& leg) {
  // Who is late on level ground lands on a knee at its stop, and no harm is done; down a stair it
  // is a fall. To be in time costs a straighter leg.
  const double below = leg.ground - swing.evaluate(std::max(now, duration)).position.z();
  const double fall = kFall * leg.gravity / (leg.omega * leg.omega);
  const double share = std::clamp(below / fall, 0.0, 1.0);
  const double speed = (1.0 - share) * kSpeed * leg.gravity / leg.omega;
  const double braking = share * kBraking * leg.gravity;
  const double lead = share * kLead / leg.omega;
  const double longest = leg.longest + share * (leg.longest_down - leg.longest);
  // Nobody knows when a foot that is late comes down: as far ahead as the leg is behind.
  const double left = duration > now ? duration - now : lead;
  const double first = std::max(kComesDown * duration - now, 0.0);
  double highest = std::numeric_limits<double>::max();
  for (int i = 0; i <= kSamples; ++i) {
    const double ahead = first + (left - first) * i / kSamples;
    const SwingTrajectory::Sample foot = swing.evaluate(now + ahead);
    const Eigen::Vector3d ankle = foot.position + foot.orientation * leg.ankle_in_sole;
    const Eigen::Vector2d hip = leg.hip.head<2>() +
                                leg.lever * (std::cosh(leg.omega * ahead) - 1.0) +
                                leg.velocity * (std::sinh(leg.omega * ahead) / leg.omega);
    const double height = height_over(ankle, hip, longest);
    const double early = std::max(0.0, ahead - lead);
    highest = std::min(highest, height + speed * ahead + 0.5 * braking * early * early);
  }
  return highest;
}

double highest_hip(const TrailingLeg& leg) {
  // Over a foot that stands the CoM goes on as a pendulum, between two feet at its speed.
  const double growth = leg.omega * leg.swing;
  const Eigen::Vector2d way =
      leg.lever * (std::cosh(growth) - 1.0) + leg.velocity * (std::sinh(growth) / leg.omega);
  const Eigen::Vector2d velocity =
      leg.lever * (leg.omega * std::sinh(growth)) + leg.velocity * std::cosh(growth);
  const double lead = kLead / leg.omega;
  Eigen::Vector2d hip = leg.hip.head<2>() + way + velocity * std::max(leg.transfer, lead);
  const double ahead = (hip - leg.ankle.head<2>()).dot(leg.heading);
  hip -= std::max(ahead - leg.flat, 0.0) * leg.heading;
  // A leg that lands straight cannot lower the hip: it is down by then.
  const double early = std::max(leg.swing - lead, 0.0);
  return height_over(leg.ankle, hip, leg.longest) + 0.5 * kBraking * leg.gravity * early * early;
}

}  // namespace gaitd::walking
