// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/teleop/console.h"
#include "cli/teleop/motion.h"

namespace gaitd::cli::teleop {

/// What the operator sees.
struct Scene {
  nlohmann::json status;  ///< null: none
  Speed asked, real;
  int percent = 100;  ///< of the speed
  std::string pad;    ///< its name and state, "" without one
  std::string hint;
  bool blocked = false;  ///< the hint says why the robot cannot be driven
  std::string message;
  bool bad = false;   ///< the message is of something that went wrong
  std::string alarm;  ///< above all else; "" if none
  bool keys = false;  ///< all keys are explained
};

/// As lines of at most `columns`, 60 or more, and at most `rows`.
std::vector<Line> screen(const Scene& scene, std::size_t columns, std::size_t rows);

/// The same on one line, for terminals on which nothing stays in place.
std::string plain_line(const Scene& scene);
std::string plain_keys();

}  // namespace gaitd::cli::teleop
