// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/teleop/key_decoder.h"

namespace gaitd::cli::teleop {

inline Time at(int ms) { return Time{} + std::chrono::hours(1) + std::chrono::milliseconds(ms); }

}  // namespace gaitd::cli::teleop
