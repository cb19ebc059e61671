// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/gauntlet/story.h"

namespace gaitd::cli {

/// A course of obstacles on a walkway above a pit, to a place behind it, on ground that the robot
/// has to see. `difficulty`, 0 to 1: how many they are, how high, how far apart, how tilted.
Story world(const Draws& draws, double difficulty);

}  // namespace gaitd::cli
