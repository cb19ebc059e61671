// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "daemon/log/column_file.h"

namespace gaitd::daemon {

// Where the columns of a log are kept: beside it.
std::string columns_beside(const std::string& log);

struct ColumnLog {
  std::unique_ptr<ColumnFile> columns;  // its info() is that of log_info_json()
  std::string file;                     // where they are kept; empty: nowhere
  bool read_anew = false;               // the whole log was read for it
};

// Opens a log by its columns. The first time, and when the log is another one since, it is read by
// LogReader, damaged or not, and the columns are kept: beside it, else, where that folder cannot be
// written to, in $XDG_CACHE_HOME/gaitd/columns (~/.cache), else or without `keep` in a file of the
// temporary folder that goes with this process. No columns, with `error`, if it is no log or
// nothing could be written.
ColumnLog open_by_columns(const std::string& path, bool keep, std::string* error);

}  // namespace gaitd::daemon
