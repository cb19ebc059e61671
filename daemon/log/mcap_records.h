// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace gaitd::daemon {

struct McapSchema {
  std::uint16_t id = 0;
  std::string name;
  std::string encoding;
  std::string data;
};

struct McapChannel {
  std::uint16_t id = 0;
  std::uint16_t schema = 0;
  std::string topic;
  std::string message_encoding;
  std::map<std::string, std::string> metadata;
};

struct McapMetadata {
  std::string name;
  std::map<std::string, std::string> entries;
};

// No record of ours comes near; a length beyond is a damaged file, not a reason to allocate.
inline constexpr std::uint64_t kMaxMcapRecord = 64u << 20;  // bytes

// The contents of records, without their heads. Nothing if they make no sense.
std::optional<McapSchema> parse_schema(std::string_view content);
std::optional<McapChannel> parse_channel(std::string_view content);
std::optional<McapMetadata> parse_metadata(std::string_view content);

// "schema", "chunk", ... for people.
std::string mcap_record_name(std::uint8_t opcode);

}  // namespace gaitd::daemon
