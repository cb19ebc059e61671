// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace gaitd::cli {

/// Starts a program – arguments[0] is its path – with no input and its outputs in files, which may
/// be the same. It gets SIGTERM when this process ends. -1 with errno if it could not be started.
pid_t start_child(std::vector<std::string> arguments, const std::string& output,
                  const std::string& errors);

}  // namespace gaitd::cli
