// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "daemon/log/log_reader.h"

namespace gaitd::cli {

/// Everything of logs that the report page shows, as one JSON document that may stand inside a
/// <script>: that of the first log, the others in its list `others`. Of each its name, metadata,
/// verdict, events, the robot, and the signals as base64 of 32-bit floats, one signal after the
/// other. At most 100 rows per second of simulated time and 12000 in all; of the times of a tick
/// the longest between two rows. What the log or this machine does not have is left out.
std::string report_data(const std::vector<std::unique_ptr<daemon::LogReader>>& logs);

/// The page with these data in it. Empty with a reason in `error` if the page of this installation
/// cannot be read.
std::string report_page(const std::string& data, std::string* error);

}  // namespace gaitd::cli
