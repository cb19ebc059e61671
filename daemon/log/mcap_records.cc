// SPDX-License-Identifier: Apache-2.0
#include "daemon/log/mcap_records.h"

#include "daemon/log/bytes.h"
#include "daemon/log/mcap_format.h"

namespace gaitd::daemon {

std::optional<McapSchema> parse_schema(std::string_view content) {
  ByteReader reader(content);
  McapSchema schema;
  schema.id = reader.take<std::uint16_t>();
  schema.name = reader.take_string();
  schema.encoding = reader.take_string();
  schema.data = reader.take_string();
  if (!reader.ok()) return std::nullopt;
  return schema;
}

std::optional<McapChannel> parse_channel(std::string_view content) {
  ByteReader reader(content);
  McapChannel channel;
  channel.id = reader.take<std::uint16_t>();
  channel.schema = reader.take<std::uint16_t>();
  channel.topic = reader.take_string();
  channel.message_encoding = reader.take_string();
  channel.metadata = reader.take_map();
  if (!reader.ok()) return std::nullopt;
  return channel;
}

std::optional<McapMetadata> parse_metadata(std::string_view content) {
  ByteReader reader(content);
  McapMetadata metadata;
  metadata.name = reader.take_string();
  metadata.entries = reader.take_map();
  if (!reader.ok()) return std::nullopt;
  return metadata;
}

std::string mcap_record_name(std::uint8_t opcode) {
  switch (opcode) {
    case mcap::kHeader:
      return "the head of the file";
    case mcap::kSchema:
      return "a schema";
    case mcap::kChannel:
      return "a channel";
    case mcap::kChunk:
      return "a chunk";
    case mcap::kMessageIndex:
      return "an index";
    case mcap::kMetadata:
      return "metadata";
    default:
      return "a record of type " + std::to_string(opcode);
  }
}

}  // namespace gaitd::daemon
