// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "gaitd/abi/plugin.h"

namespace gaitd::daemon {

// What run_child() and its child agree on: the model is readable on kChildModelFd, libraries that
// were handed over on kChildLibraryFd and above, and the child writes lines to kChildReportFd:
// "error <text>" before it gives up, "done" when all went well.
inline constexpr int kChildModelFd = 3;
inline constexpr int kChildReportFd = 4;
inline constexpr int kChildLibraryFd = 5;
inline constexpr const char* kChildLibraryPath = "/proc/self/fd/5";  // of the first

/// For the start of a child in which a crash is expected: no core file, no handler of a sanitizer,
/// and no life after the parent.
void expect_the_worst();

/// The model that the parent handed over.
bool read_model(GaitdModel* model);

/// Writes one line to the parent; line ends within it become spaces.
void report_line(std::string line);

/// A GaitdHost::log that appends warnings and errors to the std::string in `context`.
void remember_log(void* context, int32_t level, const char* message);

}  // namespace gaitd::daemon
