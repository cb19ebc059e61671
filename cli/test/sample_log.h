// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace gaitd::cli {

/// Writes a log of one second in which the robot stands with its CoM at 1 m.
void write_sample_log(const std::string& path);

}  // namespace gaitd::cli
