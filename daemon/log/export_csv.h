// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <ostream>
#include <string>

#include "daemon/log/log_reader.h"

namespace gaitd::daemon {

struct CsvOptions {
  std::string signals;                                      // comma-separated globs; empty: all
  double start = -std::numeric_limits<double>::infinity();  // s, of the signal "time"
  double end = std::numeric_limits<double>::infinity();     // s, included
};

// One row per tick below a header with the names. Booleans 0/1, enumerations as words (nothing if
// out of range), reals with the fewest digits that read back to the same bits. False with `error`
// if nothing matches, a time range is asked of a log without "time", or writing fails.
bool export_csv(const LogReader& log, const CsvOptions& options, std::ostream& out,
                std::string* error);

}  // namespace gaitd::daemon
