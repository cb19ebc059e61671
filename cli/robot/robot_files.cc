// SPDX-License-Identifier: Apache-2.0
#include "cli/robot/robot_files.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "cli/robot/proportions.h"

namespace gaitd::porting {
namespace {

constexpr std::size_t kColumns = 98;
constexpr int kSteps = 6;

// A number as people write it: four digits behind the point, without those that say nothing.
std::string number(double value, int digits = 5) {
  std::string text =
      format("%.*f", digits, std::abs(value) < 0.5 * std::pow(10, -digits) ? 0.0 : value);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text;
}

// Names that YAML might take for something else are put in quotes.
std::string quoted(const std::string& text) {
  const bool plain = !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.' || c == '/';
  }) && std::isalpha(static_cast<unsigned char>(text[0])) != 0;
  const std::string low = lower_case(text);
  if (plain && low != "null" && low != "true" && low != "false" && low != "yes" && low != "no" &&
      low != "on" && low != "off" && low != "y" && low != "n") {
    return text;
  }
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string vector_text(const Eigen::Vector3d& v, int digits = 5) {
  return "[" + number(v.x(), digits) + ", " + number(v.y(), digits) + ", " + number(v.z(), digits) +
         "]";
}

std::string rpy_text(const Eigen::Matrix3d& R) {
  const double pitch = std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0)));
  Eigen::Vector3d rpy(std::atan2(R(2, 1), R(2, 2)), pitch, std::atan2(R(1, 0), R(0, 0)));
  if (std::hypot(R(0, 0), R(1, 0)) < 1e-9) {
    rpy = {std::atan2(-R(1, 2), R(1, 1)), pitch, 0.0};
  }
  return vector_text(rpy, 7);
}

std::string frame_text(const FrameGuess& frame) {
  return "xyz: " + vector_text(frame.X_LF.translation()) +
         ", rpy: " + rpy_text(frame.X_LF.linear());
}

class Writer {
 public:
  void comment(const Reasons& reasons, const std::string& indent = "") {
    std::string line = indent + "#";
    for (const std::string& reason : reasons) {
      std::istringstream words(reason);
      for (std::string word; words >> word;) {
        if (line.size() + 1 + word.size() > kColumns) {
          out_ << line << "\n";
          line = indent + "#";
        }
        line += " " + word;
      }
    }
    if (line.size() > indent.size() + 1) out_ << line << "\n";
  }
  void line(const std::string& text) { out_ << text << "\n"; }
  std::string text() const { return out_.str(); }

 private:
  std::ostringstream out_;
};

const char* side_name(std::size_t side) { return side == 0 ? "left" : "right"; }

void write_feet(const Guess& guess, Writer* out) {
  out->line("\nfeet:");
  for (std::size_t side = 0; side < 2; ++side) {
    const SoleGuess& sole = guess.soles[side];
    out->line(std::string("  ") + side_name(side) + ":");
    out->line("    link: " + quoted(sole.frame.link));
    out->comment(sole.frame.why, "    ");
    out->line("    sole: {" + frame_text(sole.frame) + "}");
    std::string outline;
    for (const Eigen::Vector2d& p : sole.outline) {
      outline += (outline.empty() ? "[" : ", [") + number(p.x()) + ", " + number(p.y()) + "]";
    }
    out->line("    outline: [" + outline + "]");
    out->comment(guess.force_sensors[side].why, "    ");
    out->line("    force_sensor: {link: " + quoted(guess.force_sensors[side].link) + ", " +
              frame_text(guess.force_sensors[side]) + "}");
  }
}

void write_legs(const Guess& guess, Writer* out) {
  out->line("");
  out->comment(guess.legs_why);
  out->line("legs:");
  const auto name = [&](int joint) { return quoted(guess.urdf.model.joints[joint].name); };
  for (std::size_t side = 0; side < 2; ++side) {
    const LegGuess& leg = guess.legs[side];
    std::string joints;
    for (const int joint : leg.joints) joints += (joints.empty() ? "" : ", ") + name(joint);
    out->line(std::string("  ") + side_name(side) + ":");
    out->line("    joints: [" + joints + "]");
    out->line("    hip_pitch: " + name(leg.hip_pitch));
    out->line("    knee: " + name(leg.knee));
    out->line("    ankle_pitch: " + name(leg.ankle_pitch));
    if (leg.ankle_roll >= 0) out->line("    ankle_roll: " + name(leg.ankle_roll));
  }
}

void write_drive_limits(const Guess& guess, Writer* out) {
  if (guess.drive_limits.empty()) return;
  out->line("");
  out->comment(guess.drive_limits_why);
  out->line("drive_limits:");
  for (const DriveLimitGuess& limit : guess.drive_limits) {
    std::string text;
    const auto add = [&](const std::string& entry) { text += (text.empty() ? "" : ", ") + entry; };
    if (limit.effort > 0.0) add("effort: " + number(limit.effort));
    if (limit.velocity > 0.0) add("velocity: " + number(limit.velocity));
    if (limit.has_range) {
      add("range: [" + number(limit.range[0]) + ", " + number(limit.range[1]) + "]");
    }
    out->line("  " + quoted(limit.joint) + ": {" + text + "}");
  }
}

void write_parameters(const Guess& guess, Writer* out) {
  const Proportions& p = guess.proportions;
  out->line("");
  out->comment(guess.proportions_why);
  out->line("parameters:");
  out->line("  gait.swing_height: " + number(p.swing_height));
  for (const auto& [name, value] : scaled_parameters(p)) {
    out->line("  " + name + ": " + number(value));
  }
  out->line("\nprofiles:\n  simulation:\n    parameters:");
  out->line("      gait.swing_duration: " + number(p.swing, 3));
  out->line("      gait.transfer_duration: " + number(p.transfer, 3));
  out->line("  hardware:\n    parameters:");
  out->comment({"Slower, for the first steps of the real robot."}, "      ");
  out->line("      gait.swing_duration: " + number(p.first_swing, 2));
  out->line("      gait.transfer_duration: " + number(p.first_transfer, 2));
}

}  // namespace

std::string robot_yaml(const Guess& guess, const std::string& urdf) {
  const GaitdModel& model = guess.model;
  Writer out;
  out.comment(
      {format("%s: %d joints, %.3f kg. Guessed by gaitctl robot init from the URDF; every "
              "guess says why. Lengths in m, angles in rad.",
              guess.name.c_str(), model.joint_count, model.total_mass)});
  out.line("schema: gaitd.robot/1");
  out.line("name: " + quoted(guess.name));
  out.line("urdf: " + quoted(urdf));
  if (guess.urdf.far_inertias) {
    out.comment(
        {"Some inertias in it are such as no body has, by far: the doctor names them. Until they "
         "are corrected the nearest possible ones are taken."});
    out.line("nearest_inertias: true");
  }
  out.line("");
  out.comment(guess.pelvis_why);
  const std::string pelvis = quoted(model.bodies[0].name);
  const Eigen::Matrix3d R = guess.options.R_LB.toRotationMatrix();
  const Eigen::Vector3d& origin = guess.options.p_LB;
  const std::string xyz = origin.isZero(0.0) ? "" : ", xyz: " + vector_text(origin);
  const std::string rpy = R.isIdentity(1e-9) ? "" : ", rpy: " + rpy_text(R);
  out.line("pelvis: " +
           (xyz.empty() && rpy.empty() ? pelvis : "{link: " + pelvis + xyz + rpy + "}"));
  out.comment(guess.chest_why);
  if (!guess.chest.empty()) out.line("chest: " + quoted(guess.chest));
  if (!guess.fixed.empty()) {
    out.line("");
    out.comment(
        {"Joints that walking has no use for. They stay where their range is nearest to 0; "
         "globs will do."});
    out.line("fixed:");
    for (const FixedGuess& fixed : guess.fixed) {
      out.line("  - " + quoted(fixed.joint) + "  # " + fixed.why);
    }
  }
  write_feet(guess, &out);
  write_legs(guess, &out);
  out.line("");
  out.comment(guess.imu.why);
  out.line("imus:");
  out.line("  - {name: " + guess.imu.name + ", link: " + quoted(guess.imu.link) + ", " +
           frame_text(guess.imu) + "}");
  out.line("");
  out.comment(guess.posture_why);
  out.line("posture:");
  for (int i = 0; i < model.joint_count; ++i) {
    out.line("  " + quoted(model.joints[i].name) + ": " + number(model.nominal_position[i], 5));
  }
  out.line("");
  out.comment(
      {"Reflected inertia of the drives by joint or glob, kg m^2. A URDF does not say it."});
  out.line("rotor_inertia: {\"*\": 0.0}");
  write_drive_limits(guess, &out);
  write_parameters(guess, &out);
  return out.text();
}

// m, from the middle of the soles, where a scenario begins, to the pelvis in the posture.
Eigen::Vector2d pelvis_over_soles(const Guess& guess) {
  const GaitdModel& model = guess.model;
  const auto poses = body_poses(
      model, Eigen::Map<const Eigen::VectorXd>(model.nominal_position, model.joint_count));
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const GaitdFoot& foot : model.feet) {
    const auto body = static_cast<std::size_t>(foot.sole.body);
    middle += 0.5 * (poses[body] * Eigen::Vector3d(foot.sole.origin)).head<2>();
  }
  return -middle;
}

std::string stand_scenario(const Guess& guess) {
  return "# Stands on its own: begin here.\nschema: gaitd.scenario/1\nname: " +
         quoted(guess.name + "-stand") +
         "\nrobot: robot.yaml\nduration: 5\nseed: 1\nmode: stand\n"
         "expect:\n  no_fall: true\n  contact_lost: false\n";
}

std::string walk_scenario(const Guess& guess) {
  const Proportions& p = guess.proportions;
  const double step = p.swing + p.transfer;
  const double duration = std::ceil(1.0 + (kSteps + 2) * step + 3.0);
  // The last step comes beside the foot before.
  const double way = kSteps * p.length;
  const Eigen::Vector2d pelvis = pelvis_over_soles(guess);
  return "# A first walk: bent knees, short steps that take their time.\nschema: gaitd.scenario/1\n"
         "name: " +
         quoted(guess.name + "-walk") + "\nrobot: robot.yaml\nduration: " + number(duration) +
         "\nseed: 1\nmode: walk-bent\ncommands:\n  - {at: 1.0, walk: {steps: " +
         std::to_string(kSteps) + ", length: " + number(p.length) +
         ", swing: " + number(p.swing, 3) + ", transfer: " + number(p.transfer, 3) +
         "}}\nexpect:\n  no_fall: true\n  steps_taken: " + std::to_string(kSteps) +
         "\n  final_pelvis: {x: " + number(way + pelvis.x()) + ", y: " + number(pelvis.y()) +
         ", tolerance: " + number(std::max(0.03, 0.1 * p.scale), 3) +
         ", yaw: 0.0, yaw_tolerance: 0.05}\n";
}

}  // namespace gaitd::porting
