// SPDX-License-Identifier: Apache-2.0
#include "daemon/log/mcap_reader.h"

#include <zstd.h>

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

#include "daemon/log/bytes.h"
#include "daemon/log/crc32.h"
#include "daemon/log/mcap_format.h"
#include "daemon/log/seal.h"

namespace gaitd::daemon {

namespace {

constexpr std::uint64_t kMaxChunkSize = 64u << 20;
constexpr std::uint64_t kChunkHeadSize = 8 + 8 + 8 + 4;  // before the name of the compression
constexpr std::uint64_t kMaxCompressionName = 16;
constexpr int kMaxWindowLog = 26;

// Decompresses up to `limit` bytes and stops quietly where the input ends. False if the input is
// not zstd.
bool decompress(std::string_view input, std::uint64_t limit, std::string* output) {
  const std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)> context(ZSTD_createDCtx(),
                                                                        ZSTD_freeDCtx);
  if (context == nullptr) return false;
  ZSTD_DCtx_setParameter(context.get(), ZSTD_d_windowLogMax, kMaxWindowLog);
  // Grows with what is really there: the size that a damaged file claims is no reason to allocate.
  output->resize(std::min<std::uint64_t>(limit, 8 * input.size() + 4096));
  ZSTD_inBuffer in{input.data(), input.size(), 0};
  std::size_t written = 0;
  bool valid = true;
  bool done = false;
  while (!done) {
    ZSTD_outBuffer out{output->data(), output->size(), written};
    const std::size_t read_before = in.pos;
    const std::size_t result = ZSTD_decompressStream(context.get(), &out, &in);
    valid = !ZSTD_isError(result);
    const bool full = out.pos == output->size();
    const bool stuck = in.pos == read_before && out.pos == written;
    written = out.pos;
    done = !valid || result == 0 || (full && written >= limit) || (stuck && !full);
    if (!done && full) output->resize(std::min<std::uint64_t>(limit, 2 * output->size()));
  }
  output->resize(written);
  return valid;
}

}  // namespace

bool McapReader::open(const std::string& path, std::string* error) {
  if (!file_.open(path, error)) return false;
  std::string magic;
  if (!file_.read(0, mcap::kMagic.size(), &magic) || magic != mcap::kMagic) {
    *error = path +
             ": not an MCAP file: it does not begin with the bytes of one; expected a log "
             "written by gaitd";
    return false;
  }
  std::uint64_t offset = 0;
  while (read_sealed(&offset)) {
  }
  read_tail(std::max<std::uint64_t>(offset, mcap::kMagic.size()));
  drop_copies();
  std::string damaged_summary;
  summary_ = read_summary(file_, &damaged_summary);
  if (!summary_ && finished()) break_reason_ = damaged_summary;
  // A table of signals is too much to lose for one byte: there is a copy.
  if (!summary_ || damage_.empty()) return true;
  for (const McapChannel& channel : summary_->channels) {
    if (find_channel(channel.topic) == nullptr) channels_.push_back(channel);
  }
  return true;
}

std::optional<McapReader::Head> McapReader::read_head(std::uint64_t offset) const {
  std::string bytes;
  if (!file_.read(offset, mcap::kRecordHeaderSize, &bytes)) return std::nullopt;
  ByteReader reader(bytes);
  Head head;
  head.opcode = reader.take<std::uint8_t>();
  head.length = reader.take<std::uint64_t>();
  head.content = offset + mcap::kRecordHeaderSize;
  head.whole = head.length <= file_.size() - head.content;
  return head;
}

bool McapReader::read_sealed(std::uint64_t* offset) {
  const std::uint64_t begin = *offset;
  std::vector<Head> heads;
  std::optional<FoundSeal> found;
  std::uint64_t at = std::max<std::uint64_t>(begin, mcap::kMagic.size());
  for (auto head = read_head(at); head && head->whole && head->opcode != 0; head = read_head(at)) {
    if (head->opcode == mcap::kDataEnd) break;
    std::string content;
    if (head->opcode == mcap::kSeal && head->length == kSealContentSize &&
        file_.read(head->content, head->length, &content)) {
      if (const auto seal = parse_seal(content)) found = {at, *seal};
      break;
    }
    heads.push_back(*head);
    at = head->end();
  }
  bool sound = found && found->seal.start == begin && found->seal.before == checksum_ &&
               file_crc32(file_, begin, found->offset, found->seal.before) == found->seal.after;
  if (!sound) found = find_seal(file_, begin);
  if (!found) return false;
  sealed_ = true;
  if (sound) {
    for (const Head& head : heads) sound = take_record(head) && sound;
  }
  if (!sound) {
    add_damage(begin, found->offset);
    salvage_chunks(std::max<std::uint64_t>(begin, mcap::kMagic.size()), found->offset);
  }
  *offset = found->offset + kSealSize;
  checksum_ = file_crc32(file_, found->offset, *offset, found->seal.after).value_or(0);
  return true;
}

bool McapReader::take_record(const Head& head) {
  if (head.opcode != mcap::kChunk) return take_small_record(head);
  auto chunk = read_chunk_head(head);
  if (chunk && chunk->offset != 0) chunks_.push_back(std::move(*chunk));
  return chunk.has_value();
}

void McapReader::salvage_chunks(std::uint64_t begin, std::uint64_t end) {
  for (std::uint64_t at = begin; at < end;) {
    const auto head = read_head(at);
    if (!head || head->opcode == 0 || head->end() > end || !head->whole) return;
    if (head->opcode == mcap::kChunk) {
      if (auto chunk = read_chunk_head(*head)) {
        chunk->suspect = true;
        chunks_.push_back(std::move(*chunk));
      }
    }
    at = head->end();
  }
}

// A block of the file that was written over another one: its chunks are sound, but stand there
// twice.
void McapReader::drop_copies() {
  if (damage_.empty() && finished()) return;
  std::set<std::pair<std::uint32_t, std::uint64_t>> seen;
  const auto key = [](const McapChunk& chunk) {
    return std::pair(chunk.crc, chunk.uncompressed_size);
  };
  for (const McapChunk& chunk : chunks_) {
    if (!chunk.suspect && !chunk.cut) seen.insert(key(chunk));
  }
  std::set<std::pair<std::uint32_t, std::uint64_t>> kept;
  std::erase_if(chunks_, [&](const McapChunk& chunk) {
    const bool doubtful = chunk.suspect || chunk.cut;
    return !(doubtful ? seen : kept).insert(key(chunk)).second;
  });
}

void McapReader::read_tail(std::uint64_t offset) {
  std::vector<Head> heads;
  std::uint64_t at = offset;
  auto head = read_head(at);
  for (; head && head->whole && head->opcode != 0; head = read_head(at)) {
    if (head->opcode == mcap::kDataEnd) break;
    heads.push_back(*head);
    at = head->end();
  }
  const bool ends = head && head->whole && head->opcode == mcap::kDataEnd;
  const bool cut = !head || !head->whole;
  // With seals, what follows the last one is proven by the end of the data; of a file that was cut
  // off it is what was being written.
  bool sound = !sealed_ || cut;
  if (sealed_ && ends) {
    std::string content;
    const auto checksum = file_crc32(file_, offset, at, checksum_);
    sound = head->length == 4 && file_.read(head->content, head->length, &content) &&
            ByteReader(content).take<std::uint32_t>() == checksum;
    if (!sound) add_damage(offset, head->end());
  }
  for (std::size_t i = 0; i < heads.size(); ++i) {
    if (!sound && heads[i].opcode != mcap::kChunk) continue;
    if (take_record(heads[i])) {
      if (!sound && !chunks_.empty()) chunks_.back().suspect = true;
      continue;
    }
    return break_at(heads[i].content - mcap::kRecordHeaderSize,
                    "damaged record: " + mcap_record_name(heads[i].opcode));
  }
  if (ends) return check_magic(*head);
  if (!head) {
    return break_at(at, "the file ends without its end record (cut off, or still being written)");
  }
  if (head->opcode == 0) return break_at(at, "bytes that are no record");
  if (head->opcode != mcap::kChunk) {
    return break_at(at, "a record is longer than the rest of the file");
  }
  if (!take_record(*head)) return break_at(at, "damaged head of a chunk");
  break_at(at, "the file ends inside a chunk");
}

void McapReader::check_magic(const Head& data_end) {
  std::string end;
  const std::size_t size = mcap::kMagic.size();
  if (file_.size() < data_end.end() + size || !file_.read(file_.size() - size, size, &end) ||
      end != mcap::kMagic) {
    break_reason_ = "cut off after the data, which are complete: the summary behind them is not";
  }
}

bool McapReader::take_small_record(const Head& head) {
  const bool wanted = head.opcode == mcap::kHeader || head.opcode == mcap::kSchema ||
                      head.opcode == mcap::kChannel || head.opcode == mcap::kMetadata;
  if (!wanted) return true;
  std::string content;
  if (head.length > kMaxMcapRecord || !file_.read(head.content, head.length, &content)) {
    return false;
  }
  if (head.opcode == mcap::kHeader) {
    ByteReader reader(content);
    reader.take_string();  // profile
    library_ = reader.take_string();
    return reader.ok();
  }
  if (head.opcode == mcap::kSchema) {
    auto schema = parse_schema(content);
    if (schema) schemas_.push_back(std::move(*schema));
    return schema.has_value();
  }
  if (head.opcode == mcap::kChannel) {
    auto channel = parse_channel(content);
    if (channel) channels_.push_back(std::move(*channel));
    return channel.has_value();
  }
  auto metadata = parse_metadata(content);
  if (metadata) metadata_.push_back(std::move(*metadata));
  return metadata.has_value();
}

// One without an offset: the file ends inside its head, so that it holds nothing.
std::optional<McapChunk> McapReader::read_chunk_head(const Head& head) const {
  const std::uint64_t most = kChunkHeadSize + 4 + kMaxCompressionName + 8;
  const std::uint64_t available = std::min({most, head.length, file_.size() - head.content});
  std::string bytes;
  if (!file_.read(head.content, available, &bytes)) return std::nullopt;
  ByteReader reader(bytes);
  McapChunk chunk;
  reader.take<std::uint64_t>();
  reader.take<std::uint64_t>();
  chunk.uncompressed_size = reader.take<std::uint64_t>();
  chunk.crc = reader.take<std::uint32_t>();
  chunk.compression = reader.take_string();
  const auto size = reader.take<std::uint64_t>();
  if (!reader.ok()) {
    return available < std::min(most, head.length) ? std::optional(McapChunk{}) : std::nullopt;
  }
  chunk.offset = head.content + (bytes.size() - reader.rest().size());
  if (size != head.length - (chunk.offset - head.content)) return std::nullopt;
  chunk.size = std::min(size, file_.size() - chunk.offset);
  chunk.cut = chunk.size < size;
  return chunk;
}

// Names the first record that stands there, if its head was spared.
void McapReader::add_damage(std::uint64_t begin, std::uint64_t end) {
  const auto head = read_head(std::max<std::uint64_t>(begin, mcap::kMagic.size()));
  const std::string what =
      head && head->end() <= end ? mcap_record_name(head->opcode) : "something";
  damage_.push_back({begin, end, what});
}

void McapReader::break_at(std::uint64_t offset, const std::string& why) {
  break_reason_ = "cut off at byte " + std::to_string(offset) + " of " +
                  std::to_string(file_.size()) + ": " + why + "; all before it is read";
}

std::optional<std::uint64_t> McapReader::written_messages(std::uint16_t channel) const {
  if (!summary_) return std::nullopt;
  const auto count = summary_->message_counts.find(channel);
  if (count == summary_->message_counts.end()) return std::nullopt;
  return count->second;
}

bool McapReader::read_chunk(const McapChunk& chunk, std::string* records,
                            std::string* error) const {
  std::string bytes;
  const std::string where = file_.path() + ": chunk at byte " + std::to_string(chunk.offset) + ": ";
  if (chunk.uncompressed_size > kMaxChunkSize || chunk.size > kMaxChunkSize) {
    *error = where + "says to be larger than 64 MiB";
    return false;
  }
  if (!file_.read(chunk.offset, chunk.size, &bytes)) {
    *error = where + "cannot be read any more";
    return false;
  }
  if (chunk.compression == "zstd") {
    const bool valid = decompress(bytes, chunk.uncompressed_size, records);
    if (chunk.cut) return true;
    if (!valid || records->size() != chunk.uncompressed_size) {
      *error = where + "does not decompress";
      return false;
    }
  } else if (chunk.compression.empty()) {
    *records = std::move(bytes);
    if (chunk.cut) return true;
  } else {
    *error = where + "compression '" + chunk.compression + "' is not known; expected zstd or none";
    return false;
  }
  if ((chunk.crc != 0 || chunk.suspect) && crc32(*records) != chunk.crc) {
    *error = where + "wrong checksum";
    return false;
  }
  return true;
}

const McapChannel* McapReader::find_channel(std::string_view topic) const {
  for (const McapChannel& channel : channels_) {
    if (channel.topic == topic) return &channel;
  }
  return nullptr;
}

bool next_message(std::string_view records, std::uint64_t* offset, McapMessage* message) {
  while (*offset <= records.size() && records.size() - *offset >= mcap::kRecordHeaderSize) {
    ByteReader reader(records.substr(*offset));
    const auto opcode = reader.take<std::uint8_t>();
    const auto length = reader.take<std::uint64_t>();
    const std::string_view content = reader.take_bytes(length);
    if (!reader.ok()) return false;
    *offset += mcap::kRecordHeaderSize + length;
    if (opcode != mcap::kMessage) continue;
    ByteReader fields(content);
    message->channel = fields.take<std::uint16_t>();
    fields.take<std::uint32_t>();  // sequence
    message->time_ns = fields.take<std::uint64_t>();
    fields.take<std::uint64_t>();  // publish time
    if (!fields.ok()) return false;
    message->data = fields.rest();
    message->offset = *offset - message->data.size();
    return true;
  }
  return false;
}

}  // namespace gaitd::daemon
