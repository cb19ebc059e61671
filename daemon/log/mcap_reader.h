// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/log/input_file.h"
#include "daemon/log/mcap_records.h"
#include "daemon/log/mcap_summary.h"

namespace gaitd::daemon {

// Where the records of a chunk stand in the file.
struct McapChunk {
  std::uint64_t offset = 0;
  std::uint64_t size = 0;  // in the file; less than was written if `cut`
  std::uint64_t uncompressed_size = 0;
  std::uint32_t crc = 0;  // of the uncompressed records; 0: none
  std::string compression;
  bool cut = false;      // the file ends inside
  bool suspect = false;  // what stands around it is damaged: it needs a checksum of its own
};

struct McapMessage {
  std::uint16_t channel = 0;
  std::uint64_t time_ns = 0;
  std::string_view data;
  std::uint64_t offset = 0;  // of the data, in the chunk
};

// Bytes of the file that are not what was written.
struct McapDamage {
  std::uint64_t begin = 0;
  std::uint64_t end = 0;  // the first byte behind them that is sound again
  std::string what;       // what stands there, as far as that can be told
};

// The records of an MCAP file, up to its end or to the byte from which on nothing makes sense. Only
// what our own writer writes is taken: schemas, channels and metadata outside the chunks, messages
// inside. In a file with seals (seal.h) only what they prove is taken outside the chunks, and
// reading goes on behind what is damaged; channels are taken from the summary where theirs are.
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

  bool sealed() const { return sealed_; }  // checksums cover everything, not the chunks alone
  const std::vector<McapDamage>& damage() const { return damage_; }  // in the order of the file
  // How many messages of a channel were written. Nothing if the file does not tell.
  std::optional<std::uint64_t> written_messages(std::uint16_t channel) const;

 private:
  // The head of a record.
  struct Head {
    std::uint8_t opcode = 0;
    std::uint64_t content = 0;  // byte of the file
    std::uint64_t length = 0;   // bytes
    bool whole = false;         // the file does not end inside
    std::uint64_t end() const { return content + length; }
  };
  std::optional<Head> read_head(std::uint64_t offset) const;

  // What the seals prove, or disprove, from `*offset` on. False when there is no further seal.
  bool read_sealed(std::uint64_t* offset);
  // The records there, which a seal has proven or which a file without seals has.
  bool take_record(const Head& head);
  void salvage_chunks(std::uint64_t begin, std::uint64_t end);
  void drop_copies();
  // Behind the last seal: the end of the file, or what was being written when it ended.
  void read_tail(std::uint64_t offset);
  void check_magic(const Head& data_end);

  bool take_small_record(const Head& head);
  std::optional<McapChunk> read_chunk_head(const Head& head) const;
  void add_damage(std::uint64_t begin, std::uint64_t end);
  void break_at(std::uint64_t offset, const std::string& why);

  InputFile file_;
  std::string library_;
  std::vector<McapSchema> schemas_;
  std::vector<McapChannel> channels_;
  std::vector<McapMetadata> metadata_;
  std::vector<McapChunk> chunks_;
  std::vector<McapDamage> damage_;
  std::optional<McapSummary> summary_;
  std::string break_reason_;
  bool sealed_ = false;
  std::uint32_t checksum_ = 0;  // of the file up to the last sound seal and with it
};

// Takes the next message from the records of a chunk, starting at `offset`, which moves on. Other
// records are skipped. False at the end or where the records make no sense any more.
bool next_message(std::string_view records, std::uint64_t* offset, McapMessage* message);

}  // namespace gaitd::daemon
