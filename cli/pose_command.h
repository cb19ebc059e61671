// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "cli/context.h"

namespace gaitd::cli {

/// Adds `pose`: pelvis, chest, arms and hands while the robot stands or walks.
void add_pose_command(CLI::App* app, Context* context);

}  // namespace gaitd::cli
