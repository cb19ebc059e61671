// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "gaitd/dynamics/urdf.h"
#include "gaitd/dynamics/urdf_outline.h"

namespace gaitd::porting {

// Sentences that say what was guessed, from what, and how sure it is.
using Reasons = std::vector<std::string>;

// A frame in a link: m, axes of the link.
struct FrameGuess {
  std::string name;
  std::string link;
  Eigen::Isometry3d X_LF = Eigen::Isometry3d::Identity();
  Reasons why;
};

struct LegGuess {
  std::vector<int> joints;  // of the model, from the pelvis to the foot
  int hip_pitch = -1;
  int knee = -1;
  int ankle_pitch = -1;
  int ankle_roll = -1;
};

struct SoleGuess {
  FrameGuess frame;                      // x to the toe, z up, at the middle
  std::vector<Eigen::Vector2d> outline;  // m, in that frame, counter-clockwise, at most 7
};

struct FixedGuess {
  std::string joint;
  std::string why;
  bool lacks_limits = false;  // the URDF gives no effort, velocity or range
};

// What a person knows better than the URDF.
struct Told {
  std::vector<std::string> fix;  // joints, by name or glob, that do not move
  // m: length and width of a sole, the last joint of the leg above it, and its middle ahead of the
  // joint that pitches the foot. Empty: the shapes of the foot show it.
  std::vector<double> sole;
};

// What the URDF does not say of a drive; 0: it does.
struct DriveLimitGuess {
  std::string joint;
  double effort = 0.0;               // N m
  double velocity = 0.0;             // rad/s
  std::array<double, 2> range = {};  // rad
  bool has_range = false;
};

// What the commanded gait takes from the size of the robot.
struct Proportions {
  double scale = 1.0;           // height of the centre of mass against that of Atlas
  double swing = 0.0;           // s
  double transfer = 0.0;        // s
  double first_swing = 0.0;     // s, of the real robot
  double first_transfer = 0.0;  // s
  double length = 0.0;          // m, of a step
  double swing_height = 0.0;    // m
};

// A robot as far as it is known. Every step of the guessing fills its part.
struct Guess {
  std::string name;
  std::string urdf_file;
  dynamics::UrdfOutline outline;
  dynamics::UrdfOptions options;
  dynamics::UrdfResult urdf;  // with the options
  GaitdModel model{};         // of it, with feet, legs and posture
  std::vector<FixedGuess> fixed;
  Reasons pelvis_why;
  std::string chest;  // empty: the pelvis
  Reasons chest_why;
  std::array<LegGuess, 2> legs;
  Reasons legs_why;
  std::array<SoleGuess, 2> soles;
  std::array<FrameGuess, 2> force_sensors;
  FrameGuess imu;
  Reasons posture_why;
  std::vector<DriveLimitGuess> drive_limits;
  Reasons drive_limits_why;
  Proportions proportions;
  Reasons proportions_why;
};

// The joint if it is continuous and yet has a range narrower than a turn, or null.
const dynamics::UrdfJointNote* range_of_continuous(const Guess& guess, const std::string& joint);
// Poses of all bodies with the joints at `q`, rad; body 0 at the origin.
std::vector<Eigen::Isometry3d> body_poses(const GaitdModel& model, const Eigen::VectorXd& q);
// Zero, or where the range of a joint is nearest to it.
Eigen::VectorXd zero_position(const GaitdModel& model);
// Axis of a joint, in the frame of body 0, of poses from body_poses().
Eigen::Vector3d joint_axis(const GaitdModel& model, const std::vector<Eigen::Isometry3d>& poses,
                           int joint);
// m, y of the middle of the robot, between its hips, with all joints at zero.
double middle_of(const Guess& guess);
std::string lower_case(std::string text);
// With '_' between words that are glued: "LHipYaw" is "L_Hip_Yaw", "leg_l1" is "leg_l_1".
std::string spaced(const std::string& name);
std::string format(const char* pattern, ...) __attribute__((format(printf, 1, 2)));

}  // namespace gaitd::porting
