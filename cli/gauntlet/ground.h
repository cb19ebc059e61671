// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/gauntlet/story.h"

namespace gaitd::cli {

/// Stories over ground that is not flat: the footholds are on it, or, of unknown steps, pass it by;
/// of partial ones half of the sole hangs over an edge that nobody announced.
Story stairs(const Draws& draws, bool up);
Story drops(const Draws& draws);
Story slope(const Draws& draws, bool up);
Story blocks(const Draws& draws);
Story unknown_steps(const Draws& draws);
Story partial_footholds(const Draws& draws);

}  // namespace gaitd::cli
