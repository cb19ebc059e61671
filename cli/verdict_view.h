// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "daemon/verdict/verdict.h"

namespace gaitd::cli {

/// Each expectation on a line, in tables of at most `columns` (0: no limit); ends with a newline.
std::string expectations_text(const daemon::Verdict& verdict, std::size_t columns);

/// Each figure on a line under "figures"; ends with a newline.
std::string figures_text(const daemon::Verdict& verdict);

/// The expectations that do not hold, with what was measured: "no_fall 1 fall, steps_taken 7".
std::string failed_expectations(const daemon::Verdict& verdict);

}  // namespace gaitd::cli
