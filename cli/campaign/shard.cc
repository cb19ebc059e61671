// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/shard.h"

#include <charconv>

namespace gaitd::cli {
namespace {

constexpr int kMostShards = 100000;

std::optional<int> whole_number(const char* begin, const char* end) {
  int value = 0;
  const auto [rest, code] = std::from_chars(begin, end, value);
  if (code != std::errc() || rest != end || value < 1 || value > kMostShards) return std::nullopt;
  return value;
}

}  // namespace

std::optional<Shard> parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) return std::nullopt;
  const auto index = whole_number(text.data(), text.data() + slash);
  const auto count = whole_number(text.data() + slash + 1, text.data() + text.size());
  if (!index || !count || *index > *count) return std::nullopt;
  return Shard{*index, *count};
}

std::string shard_text(const Shard& shard) {
  return std::to_string(shard.index) + "/" + std::to_string(shard.count);
}

ShardRange shard_range(const Shard& shard, std::size_t size) {
  const auto border = [&](int index) {
    return size * static_cast<std::size_t>(index) / static_cast<std::size_t>(shard.count);
  };
  return {border(shard.index - 1), border(shard.index)};
}

}  // namespace gaitd::cli
