// SPDX-License-Identifier: Apache-2.0
#include "cli/calibrate/motions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "cli/doctor/finding.h"
#include "gaitd/dynamics/kinematics.h"
#include "gaitd/sdk/views.h"

namespace gaitd::calibrate {
namespace {

using doctor::format;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kComHeight = 1.1772;  // m, of Atlas, which the lengths below are for
constexpr double kHeightAbove = 0.1;   // m, of the hanging feet over the ground
// Swings of a joint, there and back.
constexpr double kBend = 0.3;     // rad, of a knee
constexpr double kRoll = 0.2;     // rad, of a hip that lifts its leg sideways
constexpr double kSwing = 0.25;   // rad, of any other joint
constexpr double kLeast = 0.05;   // rad, a swing that is worth while
constexpr double kRoom = 0.8;     // of what is left to the end of the range
constexpr double kBegin = 3.0;    // s
constexpr double kSlow = 3.0;     // s, of a swing
constexpr double kFast = 1.0;     // s
constexpr double kPause = 0.3;    // s, after it
constexpr double kToArm = 1.0;    // s
constexpr double kToLower = 8.0;  // s, for the hoist to come down
constexpr double kHold = 3.0;     // s, from posture to posture
constexpr double kStep = 5.0;     // s, for a step and the stand after it
constexpr double kToAbort = 0.2;  // s, so that one step is taken

struct PelvisPose {  // m and rad, against the nominal stance
  double x, y, z, roll, pitch, yaw;
};

constexpr PelvisPose kSideBySide[] = {
    {0, 0, -0.03, 0, 0, 0},     {0, 0, -0.08, 0, 0, 0},     {0.04, 0, -0.03, 0, 0, 0},
    {-0.04, 0, -0.06, 0, 0, 0}, {0, 0.07, -0.03, 0, 0, 0},  {0, -0.07, -0.05, 0, 0, 0},
    {0, 0, -0.03, 0, 0, 0.25},  {0, 0, -0.06, 0, 0, -0.25}, {0, 0, -0.05, 0.12, 0, 0},
    {0, 0, -0.03, -0.12, 0, 0}, {0, 0, -0.03, 0, 0.18, 0},  {0, 0, -0.06, 0, -0.18, 0}};
constexpr PelvisPose kApart[] = {{0, 0, -0.03, 0, 0, 0},         {0.05, 0, -0.07, 0, 0, 0},
                                 {-0.05, 0, -0.03, 0, 0, 0.15},  {0, 0.05, -0.06, 0.1, 0, 0},
                                 {0, -0.05, -0.03, -0.1, 0, 0},  {0, 0, -0.06, 0, 0.15, 0},
                                 {0, 0, -0.03, 0, -0.15, -0.15}, {0, 0, -0.09, 0, 0, 0}};

struct Stance {  // m and rad, of the step that leads to it
  double length, lateral, turn;
  const char* first;
};

constexpr Stance kStances[] = {
    {0.25, 0, 0, "left"}, {0.4, 0, 0, "right"}, {0.15, 0.1, 0.25, "left"}};

// Which way a joint swings a leg that hangs, and how far, rad. Hips lift or turn it outwards or
// ahead, away from the other one; knees bend; ankles go both ways.
class Swings {
 public:
  explicit Swings(const GaitdModel& model) : model_(model), kinematics_(model) {
    const VectorXd q = sdk::head(model.nominal_position, model.joint_count);
    kinematics_.update(Vector3d::Zero(), Eigen::Quaterniond::Identity(), Vector6d::Zero(), q,
                       VectorXd::Zero(q.size()));
  }

  std::vector<double> of(int side, int joint) const {
    const GaitdLeg& leg = model_.legs[side];
    std::vector<double> swings;
    const auto add = [&](double wanted) {
      const double amplitude =
          std::copysign(std::min(std::abs(wanted), room(joint, wanted)), wanted);
      if (std::abs(amplitude) >= kLeast) swings.push_back(amplitude);
    };
    if (joint == leg.knee) {
      add(leg.knee_bend_sign * kBend);
    } else if (joint == leg.hip_pitch) {
      add(leg.hip_pitch_bend_sign * kSwing);
      if (swings.empty()) add(-leg.hip_pitch_bend_sign * kSwing);
    } else if (joint == leg.ankle_pitch || joint == leg.ankle_roll) {
      add(kSwing);
      add(-kSwing);
    } else {
      add(outwards(side, joint));
      if (swings.empty()) add(-outwards(side, joint));
    }
    return swings;
  }

 private:
  // rad. The robot hangs somewhere between its posture and the zero of the joint.
  double room(int joint, double direction) const {
    const GaitdJoint& j = model_.joints[joint];
    const double posture = model_.nominal_position[joint];
    const double zero = std::clamp(0.0, j.position_min, j.position_max);
    const double left = direction > 0 ? j.position_max - std::max(posture, zero)
                                      : std::min(posture, zero) - j.position_min;
    return kRoom * std::max(0.0, left);
  }

  // rad, of a joint that lifts the foot away from the other one, or turns its toes there.
  double outwards(int side, int joint) const {
    const dynamics::Matrix6X j = jacobian(side);
    const auto column = j.col(dynamics::kBaseSize + joint);
    const double outward = side == GAITD_LEFT ? 1.0 : -1.0;
    const double lift = outward * column[4] / model_.nominal_com_height;
    const double turn = outward * column[2];
    return std::abs(lift) > std::abs(turn) ? std::copysign(kRoll, lift)
                                           : std::copysign(kSwing, turn);
  }

  dynamics::Matrix6X jacobian(int side) const {
    const GaitdFoot& foot = model_.feet[side];
    dynamics::Matrix6X j(6, kinematics_.velocity_size());
    kinematics_.frame_jacobian(foot.body, sdk::view(foot.sole.origin), j);
    return j;
  }

  const GaitdModel& model_;
  dynamics::Kinematics kinematics_;
};

class Commands {
 public:
  void after(double seconds) { time_ += seconds; }
  double time() const { return time_; }
  // `command` as YAML.
  void add(const std::string& command) {
    text_ += format("  - {at: %.1f, ", time_) + command + "}\n";
  }
  const std::string& text() const { return text_; }

 private:
  double time_ = kBegin;
  std::string text_;
};

// As JSON, which YAML takes as it is.
std::string quoted(const std::string& text) { return nlohmann::json(text).dump(); }

std::string pose_text(const PelvisPose& pose, double scale) {
  std::string axes;
  const auto add = [&](const char* name, double value) {
    if (value == 0.0) return;
    if (!axes.empty()) axes += ", ";
    axes += format("%s: %.3g", name, value);
  };
  add("x", scale * pose.x);
  add("y", scale * pose.y);
  add("z", scale * pose.z);
  add("roll", pose.roll);
  add("pitch", pose.pitch);
  add("yaw", pose.yaw);
  return "pose: {pelvis: {" + axes + "}}";
}

void hang(const GaitdModel& model, Commands* commands) {
  const Swings swings(model);
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdLeg& leg = model.legs[side];
    for (const int joint : std::span(leg.joints, static_cast<std::size_t>(leg.joint_count))) {
      const auto swing = [&](double amplitude, double duration) {
        commands->add("joint.test: {joint: " + quoted(model.joints[joint].name) +
                      format(", amplitude: %.3g, duration: %.1f}", amplitude, duration));
        commands->after(duration + kPause);
      };
      const std::vector<double> amplitudes = swings.of(side, joint);
      for (const double amplitude : amplitudes) swing(amplitude, kSlow);
      if (!amplitudes.empty()) swing(amplitudes.back(), kFast);
    }
  }
}

void stand(std::span<const PelvisPose> poses, double scale, Commands* commands) {
  for (const PelvisPose& pose : poses) {
    commands->add(pose_text(pose, scale));
    commands->after(kHold);
  }
}

}  // namespace

std::string motions_yaml(const GaitdModel& model, const std::string& robot) {
  const double scale = model.nominal_com_height / kComHeight;
  Commands commands;
  hang(model, &commands);
  commands.after(kToArm);
  commands.add("arm: true");
  commands.after(kToLower);
  stand(kSideBySide, scale, &commands);
  for (const Stance& stance : kStances) {
    std::string step = format("walk: {steps: 2, length: %.3g", scale * stance.length);
    if (stance.lateral != 0) step += format(", lateral: %.3g", scale * stance.lateral);
    if (stance.turn != 0) step += format(", turn: %.3g", stance.turn);
    commands.add(step + ", first: " + stance.first + "}");
    commands.after(kToAbort);
    commands.add("abort: true");
    commands.after(kStep - kToAbort);
    stand(kApart, scale, &commands);
  }
  commands.add("pose: {pelvis: {}}");
  const double height = std::clamp(scale * kHeightAbove, 0.02, 0.2);  // what a scenario takes
  return "# What " + std::string(model.name) +
         " does to be calibrated: it hangs, moves the joints of its legs one by one, is armed and\n"
         "# lowered, and takes postures on both feet in four stances.\n"
         "schema: gaitd.scenario/1\nname: calibration\nrobot: " +
         quoted(robot) +
         format("\nduration: %.1f\nstart: {hoist: {height: %.3g}}\n", commands.time() + 2 * kHold,
                height) +
         "mode: walk-bent\nterrain: {ground_z: 0.0}\ncommands:\n" + commands.text() +
         "expect: {no_fall: true}\n";
}

}  // namespace gaitd::calibrate
