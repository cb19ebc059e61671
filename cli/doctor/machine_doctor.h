// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "cli/doctor/finding.h"

namespace gaitd::doctor {

// What real time needs of this machine: kernel, limits of this user, processors, wake-ups, CAN
// interfaces. Reads sysfs and procfs below `root` and tries out SCHED_FIFO and locked memory; takes
// about half a second. Problems are what keeps a robot from being driven at all; what makes it late
// is a warning.
Findings diagnose_machine(const std::filesystem::path& root = "/");

// The parts that only read files.
Findings check_kernel(const std::filesystem::path& root);
Findings check_processors(const std::filesystem::path& root);
Findings check_can(const std::filesystem::path& root);

}  // namespace gaitd::doctor
