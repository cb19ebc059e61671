// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "daemon/usage/man_page.h"
#include "ros2/bridge.h"

namespace gaitd::ros2 {

/// The options of gaitd-ros2.
void add_options(CLI::App* app, BridgeOptions* options);

/// The prose of gaitd-ros2(8).
usage::ManText man_text();

}  // namespace gaitd::ros2
