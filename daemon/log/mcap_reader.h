// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/log/input_file.h"

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

// Where the records of a chunk stand in the file.
struct McapChunk {
  std::uint64_t offset = 0;
  std::uint64_t size = 0;  // in the file; less than was written if `cut`
  std::uint64_t uncompressed_size = 0;
  std::uint32_t crc = 0;  // of the uncompressed records; 0: none
  std::string compression;
  bool cut = false;  // the file ends inside
};

struct McapMessage {
  std::uint16_t channel = 0;
  std::uint64_t time_ns = 0;
  std::string_view data;
  std::uint64_t offset = 0;  // of the data, in the chunk
};

// The records of an MCAP file, up to its end or to the first byte that makes no sense. Only what
// our own writer writes is taken: schemas, channels and metadata outside the chunks, messages
// inside.
class McapReader {
 public:
  // False with `error` if it is not an MCAP file at all.
  bool open(const std::string& path, std::string* error);

  // The uncompressed records of a chunk. False with `error` if they do not decompress or their
  // checksum is wrong; of a chunk that is cut off, all that can be had.
  bool read_chunk(const McapChunk& chunk, std::string* records, std::string* error) const;

  const std::string& library() const { return library_; }
  const std::vector<McapSchema>& schemas() const { return schemas_; }
  const std::vector<McapChannel>& channels() const { return channels_; }
  const std::vector<McapMetadata>& metadata() const { return metadata_; }
  const std::vector<McapChunk>& chunks() const { return chunks_; }
  const McapChannel* find_channel(std::string_view topic) const;
  bool finished() const { return break_reason_.empty(); }
  const std::string& break_reason() const { return break_reason_; }
  std::uint64_t file_size() const { return file_.size(); }

 private:
  // Reads the record there and moves on. False at the end of the data or at the break.
  bool read_record(std::uint64_t* offset);
  bool read_small_record(std::uint8_t opcode, std::uint64_t offset, std::uint64_t length);
  bool read_chunk_head(std::uint64_t offset, std::uint64_t length);
  bool break_at(std::uint64_t offset, const std::string& why);
  void check_end(std::uint64_t offset);

  InputFile file_;
  std::string library_;
  std::vector<McapSchema> schemas_;
  std::vector<McapChannel> channels_;
  std::vector<McapMetadata> metadata_;
  std::vector<McapChunk> chunks_;
  std::string break_reason_;
};

// Takes the next message from the records of a chunk, starting at `offset`, which moves on. Other
// records are skipped. False at the end or where the records make no sense any more.
bool next_message(std::string_view records, std::uint64_t* offset, McapMessage* message);

}  // namespace gaitd::daemon
