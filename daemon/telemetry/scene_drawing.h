// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "daemon/log/signal.h"

namespace foxglove {
class SceneUpdate;
}

namespace gaitd::daemon {

// What SceneTopics draws around the robot.
class SceneDrawing {
 public:
  // `metadata`: "world" (the simulator's configuration) and "soles" (outlines, m, sole frame).
  SceneDrawing(const std::map<std::string, std::string>& metadata, const SignalTable& table);

  // Ground and boxes of the simulation.
  void add_terrain(foxglove::SceneUpdate* scene) const;
  // Footsteps ahead or under the feet, and ICP, its plan, CMP and CoP on the ground.
  void add_gait(std::span<const double> values, foxglove::SceneUpdate* scene) const;

 private:
  using Colour = std::array<double, 4>;
  struct Marker {
    const char* name = "";
    std::array<int, 2> signal{};  // x, y; -1: not in the log
    Colour colour{};
  };
  struct Footstep {
    const char* name = "";
    std::array<int, 4> signal{};  // x, y, z, yaw
    std::vector<std::array<double, 2>> outline;
    Colour colour{};
  };
  struct Box {
    std::array<double, 3> centre{}, size{}, rpy{};
  };

  std::array<Marker, 4> markers_;
  std::array<Footstep, 2> footsteps_;
  std::vector<Box> boxes_;
};

}  // namespace gaitd::daemon
