// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

namespace gaitd::cli {

inline constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

/// Draws of one scenario, each by its own name, so that one more changes none of the others. All
/// are rounded: what is written is what was meant, to the last digit.
class Draws {
 public:
  Draws(std::string_view kind, std::uint64_t seed) : kind_(kind), seed_(seed) {}

  double between(std::string_view what, double low, double high, int place = 0) const;
  int whole(std::string_view what, int low, int high, int place = 0) const;
  bool coin(std::string_view what, int place = 0) const { return whole(what, 0, 1, place) == 1; }
  /// 1 or -1.
  double sign(std::string_view what, int place = 0) const { return coin(what, place) ? 1.0 : -1.0; }

 private:
  double uniform(std::string_view what, int place) const;

  std::string kind_;
  std::uint64_t seed_;
};

/// m and rad, in the world.
struct Box {
  double x, y, z;  ///< middle
  double length, width, height;
  double roll = 0.0, pitch = 0.0, yaw = 0.0;
};

/// Pose of a sole, m and rad, in the world.
struct Foothold {
  bool left = false;
  double x = 0.0, y = 0.0, z = 0.0;
  double roll = 0.0, pitch = 0.0;
};

struct Walk {
  int steps = 0;
  double length = 0.0, lateral = 0.0, width = 0.0;  ///< m; no width: that of the robot
  double turn = 0.0;                                ///< rad per step
  bool left_first = false;
};

/// A velocity to walk at until the next one.
struct Drive {
  double at = 0.0;                                  ///< s
  double forward = 0.0, lateral = 0.0, turn = 0.0;  ///< m/s, m/s, rad/s
};

struct Push {
  double force = 0.0, direction = 0.0;  ///< N; rad
  double duration = 0.0;                ///< s
  int step = 0;                         ///< while walking; 0: at a time
  bool in_swing = false;                ///< else in the transfer before
  double fraction = 0.0;                ///< of that phase
  double time = 0.0;                    ///< s
};

/// What happens in a scenario of the gauntlet, and where it ends.
struct Story {
  double start_z = 0.0;  ///< m, where the robot stands at the beginning
  std::vector<Box> boxes;
  double at = 2.5;                      ///< s, when it goes off: straight legs are straight by then
  Walk walk;                            ///< either this
  std::vector<Foothold> footholds;      ///< or these
  std::vector<Drive> drives;            ///< or these, to a stand at the end
  std::vector<std::string> commands;    ///< or these, as in a scenario, to anywhere
  bool goes = false;                    ///< or to the goal, as it finds its way
  bool sees = false;                    ///< the ground, which it does not know
  double time = 0.0;                    ///< s, for going there; when the last command is done
  double swing = 0.7, transfer = 0.25;  ///< s
  std::vector<Push> pushes;
  double goal_x = 0.0, goal_y = 0.0, goal_yaw = 0.0;  ///< m, rad
  double tolerance = 0.25;                            ///< m
  int steps = 0;                                      ///< to be taken
  bool more_steps = false;  ///< may be taken: a pushed robot catches itself
};

/// Four digits, the same on every machine.
std::string text_of(double value);

/// As a scenario, with a robot whose masses the controller does not know on ground whose friction
/// it does not know.
std::string scenario_text(std::string_view kind, std::uint64_t seed, const Story& story);

}  // namespace gaitd::cli
