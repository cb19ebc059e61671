// SPDX-License-Identifier: Apache-2.0
#include "cli/robot/arms.h"

#include <algorithm>
#include <cmath>

namespace gaitd::porting {
namespace {

constexpr double kSideways = 0.4;  // of half the distance of the hips: an arm is further to a side
constexpr double kMargin = 0.1;    // rad, from a stop

struct Range {
  double lower, upper;
};

Range inner_range(const GaitdJoint& joint) {
  const double lower = std::max(joint.position_min, -M_PI);
  const double upper = std::min(joint.position_max, M_PI);
  const double margin = std::min(kMargin, 0.2 * (upper - lower));
  return {lower + margin, upper - margin};
}

std::vector<bool> joints_of_legs(const Guess& guess) {
  std::vector<bool> of_leg(static_cast<std::size_t>(guess.urdf.model.joint_count), false);
  for (const LegGuess& leg : guess.legs) {
    for (const int joint : leg.joints) of_leg[static_cast<std::size_t>(joint)] = true;
  }
  return of_leg;
}

}  // namespace

std::vector<double> arms_begin(const Guess& guess) {
  const GaitdModel& model = guess.urdf.model;
  const std::vector<bool> of_leg = joints_of_legs(guess);
  const auto poses = body_poses(model, zero_position(model));
  const double middle = middle_of(guess);
  const auto bodies = static_cast<std::size_t>(model.body_count);
  std::vector<double> mass(bodies, 0.0);    // kg, with all that hangs on it
  std::vector<double> moment(bodies, 0.0);  // kg m, of it, to the left of the middle
  for (std::size_t i = bodies - 1; i > 0; --i) {
    const GaitdBody& body = model.bodies[i];
    mass[i] += body.mass;
    moment[i] += body.mass * ((poses[i] * Eigen::Vector3d(body.com)).y() - middle);
    mass[static_cast<std::size_t>(body.parent)] += mass[i];
    moment[static_cast<std::size_t>(body.parent)] += moment[i];
  }
  const LegGuess& left = guess.legs[0];
  const double hip = std::abs(poses[left.joints.front() + 1].translation().y() - middle);
  std::vector<double> begins(bodies, 0.0);
  for (std::size_t i = 1; i < bodies; ++i) {
    const GaitdBody& body = model.bodies[i];
    if (of_leg[static_cast<std::size_t>(body.joint)]) continue;
    begins[i] = begins[static_cast<std::size_t>(body.parent)];
    if (begins[i] != 0.0 || !(mass[i] > 0.0)) continue;
    // A waist may have its origin anywhere along its axis: what it carries is in the middle.
    const double carried = moment[i] / mass[i];
    const double origin = poses[i].translation().y() - middle;
    if (std::abs(carried) < kSideways * hip) continue;
    begins[i] = origin * carried > 0.0 && std::abs(origin) > kSideways * hip ? origin : carried;
  }
  return begins;
}

void hang_arms(const Guess& guess, Eigen::VectorXd* q) {
  const GaitdModel& model = guess.model;
  const std::vector<bool> of_leg = joints_of_legs(guess);
  const std::vector<double> begins = arms_begin(guess);
  const double middle = middle_of(guess);
  std::vector<int> arm_joints;
  for (int i = 0; i < model.joint_count; ++i) {
    if (of_leg[static_cast<std::size_t>(i)]) continue;
    const GaitdJoint& joint = model.joints[i];
    const Range range = inner_range(joint);
    (*q)[i] = std::clamp((*q)[i], range.lower, range.upper);
    const bool arm = begins[static_cast<std::size_t>(joint.child_body)] != 0.0;
    if (arm && joint.type == GAITD_JOINT_REVOLUTE) arm_joints.push_back(i);
  }
  // Height of the mass of the arms; how far they reach into the body; how far from zero.
  const auto cost = [&](const Eigen::VectorXd& at) {
    const auto poses = body_poses(model, at);
    double sum = 0.0;
    double mass = 1e-6;
    for (int i = 1; i < model.body_count; ++i) {
      const auto body = static_cast<std::size_t>(i);
      if (begins[body] == 0.0) continue;
      const Eigen::Vector3d com = poses[body] * Eigen::Vector3d(model.bodies[i].com);
      const double side = begins[body] > 0 ? 1.0 : -1.0;
      const double inside = std::max(0.0, std::abs(begins[body]) - side * (com.y() - middle));
      sum += model.bodies[i].mass * (com.z() + 3.0 * inside);
      mass += model.bodies[i].mass;
    }
    double bent = 0.0;
    for (const int joint : arm_joints) bent += at[joint] * at[joint];
    return sum / mass + 0.002 * bent;
  };
  double now = cost(*q);
  for (double step = 0.4; step > 0.02; step *= 0.5) {
    for (int round = 0; round < 8; ++round) {
      const double before = now;
      for (const int joint : arm_joints) {
        const Range range = inner_range(model.joints[joint]);
        for (const double sign : {-1.0, 1.0}) {
          Eigen::VectorXd next = *q;
          next[joint] = std::clamp(next[joint] + sign * step, range.lower, range.upper);
          const double better = cost(next);
          if (better >= now - 1e-9) continue;
          now = better;
          *q = next;
        }
      }
      if (before - now < 1e-6) break;
    }
  }
}

}  // namespace gaitd::porting
