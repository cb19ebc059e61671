// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace gaitd::cli {

/// Writes a log of one second in which the robot stands with its CoM at that height (m).
void write_sample_log(const std::string& path, double com_z = 1.0);

}  // namespace gaitd::cli
