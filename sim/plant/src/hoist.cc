// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/hoist.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gaitd::sim {
namespace {

constexpr double kRope = 1.0;          // m, from the bar to the robot
constexpr double kAbove = 0.5;         // m, where it is held above its centre of mass
constexpr double kApart = 0.4;         // m between the ropes
constexpr double kSlack = 0.35;        // m, by which the bar comes down further
constexpr double kSpeed = 0.06;        // m/s
constexpr double kPatience = 2.0;      // s, from the drives holding to the bar going down
constexpr double kFrequency = 3.0;     // Hz, of the robot bouncing in its ropes
constexpr double kDampingRatio = 0.3;  // of that
constexpr double kSwingRatio = 0.1;    // of its swinging: somebody steadies it

Eigen::Vector3d centre_of_mass(const GaitdModel& model, Bodies bodies) {
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  double mass = 0;
  for (int i = 0; i < model.body_count; ++i) {
    const GaitdBody& body = model.bodies[i];
    moment += body.mass * bodies[i].point(Eigen::Vector3d(body.com));
    mass += body.mass;
  }
  return moment / mass;
}

double mass_of(const GaitdModel& model) {
  double mass = 0;
  for (int i = 0; i < model.body_count; ++i) mass += model.bodies[i].mass;
  return mass;
}

}  // namespace

Hoist::Hoist(const GaitdModel& model, const HoistConfig& config)
    : model_(model), config_(config), chest_(std::max(0, model.chest_body)) {
  const double mass = 0.5 * mass_of(model);
  const double omega = 2 * std::numbers::pi * kFrequency;
  stiffness_ = mass * omega * omega;
  damping_ = 2 * kDampingRatio * mass * omega;
  swing_damping_ = 2 * kSwingRatio * mass * std::sqrt(model.gravity / kRope);
}

void Hoist::reset(Bodies bodies) {
  lowered_ = held_ = 0;
  const Eigen::Vector3d com = centre_of_mass(model_, bodies);
  const Eigen::Matrix3d R_WP = bodies[0].R_WB;
  const double stretched = 0.5 * mass_of(model_) * model_.gravity / stiffness_;
  for (size_t i = 0; i < ropes_.size(); ++i) {
    const double side = i == 0 ? 0.5 : -0.5;
    const Eigen::Vector3d held =
        com + R_WP * Eigen::Vector3d(0, side * kApart, 0) + Eigen::Vector3d(0, 0, kAbove);
    const BodyMotion& chest = bodies[chest_];
    ropes_[i].point = chest.R_WB.transpose() * (held - chest.p_WB);
    ropes_[i].hook = held + Eigen::Vector3d(0, 0, kRope + stretched);
  }
}

void Hoist::command(const GaitdJointCommands& commands, double period) {
  const auto holds = [](const GaitdJointCommand& c) { return c.mode == GAITD_JOINT_MODE_TORQUE; };
  const bool held = commands.joint_count > 0 &&
                    std::all_of(commands.joints, commands.joints + commands.joint_count, holds);
  held_ = held ? held_ + period : 0;
  const double lowest = config_.height + kSlack;
  double next = lowered_;
  if (held_ > kPatience) next += kSpeed * period;
  if (!held) next -= kSpeed * period;
  lowered_ = std::clamp(next, 0.0, lowest);
}

double Hoist::stretch(const Rope& rope, Bodies bodies) const {
  const Eigen::Vector3d hook = rope.hook - Eigen::Vector3d(0, 0, lowered_);
  return (hook - bodies[chest_].point(rope.point)).norm() - kRope;
}

void Hoist::add_forces(Bodies bodies, std::vector<BodyForce>* forces) const {
  const BodyMotion& chest = bodies[chest_];
  for (const Rope& rope : ropes_) {
    const double longer = stretch(rope, bodies);
    if (longer <= 0) continue;
    const Eigen::Vector3d held = chest.point(rope.point);
    const Eigen::Vector3d up = (rope.hook - Eigen::Vector3d(0, 0, lowered_) - held).normalized();
    const Eigen::Vector3d velocity = chest.velocity(held);
    const double away = -velocity.dot(up);
    const double pull = std::max(0.0, stiffness_ * longer + damping_ * away);
    const Eigen::Vector3d across = velocity + away * up;
    forces->push_back({chest_, rope.point, pull * up - swing_damping_ * across, 1});
  }
}

}  // namespace gaitd::sim
