// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "daemon/log/input_file.h"
#include "daemon/log/mcap_records.h"

namespace gaitd::daemon {

// What stands at the end of a finished file, under a checksum of its own: how much was written, and
// the channels once more.
struct McapSummary {
  std::vector<McapChannel> channels;
  std::map<std::uint16_t, std::uint64_t> message_counts;  // by channel
};

// Nothing with `error` if it is not there or damaged. A file without a checksum of its summary has
// none.
std::optional<McapSummary> read_summary(const InputFile& file, std::string* error);

}  // namespace gaitd::daemon
