// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace gaitd::cli {

/// One of so many parts of a campaign, for one machine each.
struct Shard {
  int index = 1;  ///< from 1
  int count = 1;

  bool whole() const { return count == 1; }
};

/// "2/4". Nothing if it is no such text.
std::optional<Shard> parse_shard(const std::string& text);
std::string shard_text(const Shard& shard);

/// Of `size` things in a row those of this shard, [first, end): blocks whose sizes differ by at
/// most one.
struct ShardRange {
  std::size_t first = 0, end = 0;
};
ShardRange shard_range(const Shard& shard, std::size_t size);

}  // namespace gaitd::cli
