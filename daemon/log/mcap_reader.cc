// SPDX-License-Identifier: Apache-2.0
#include "daemon/log/mcap_reader.h"

#include <zstd.h>

#include <algorithm>
#include <memory>

#include "daemon/log/bytes.h"
#include "daemon/log/crc32.h"
#include "daemon/log/mcap_format.h"

namespace gaitd::daemon {

namespace {

// No record of ours comes near; a length beyond is a damaged file, not a reason to allocate.
constexpr std::uint64_t kMaxRecordSize = 64u << 20;
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
  std::uint64_t offset = mcap::kMagic.size();
  while (read_record(&offset)) {
  }
  return true;
}

bool McapReader::read_record(std::uint64_t* offset) {
  const std::uint64_t start = *offset;
  std::string header;
  if (!file_.read(start, mcap::kRecordHeaderSize, &header)) {
    return break_at(start,
                    "the file ends without its end record (cut off, or still being written)");
  }
  ByteReader reader(header);
  const auto opcode = reader.take<std::uint8_t>();
  const auto length = reader.take<std::uint64_t>();
  const std::uint64_t content = start + mcap::kRecordHeaderSize;
  const bool whole = length <= file_.size() - content;
  if (opcode == mcap::kChunk) {
    if (!read_chunk_head(content, length)) return break_at(start, "damaged head of a chunk");
    if (!whole) return break_at(start, "the file ends inside a chunk");
  } else if (opcode == mcap::kDataEnd) {
    check_end(start);
    return false;
  } else if (!whole) {
    return break_at(start, "a record is longer than the rest of the file");
  } else if (!read_small_record(opcode, content, length)) {
    return break_at(start, "damaged record of type " + std::to_string(opcode));
  }
  *offset = content + length;
  return true;
}

bool McapReader::read_small_record(std::uint8_t opcode, std::uint64_t offset,
                                   std::uint64_t length) {
  if (opcode == 0) return false;
  const bool wanted = opcode == mcap::kHeader || opcode == mcap::kSchema ||
                      opcode == mcap::kChannel || opcode == mcap::kMetadata;
  if (!wanted) return true;
  std::string content;
  if (length > kMaxRecordSize || !file_.read(offset, length, &content)) return false;
  ByteReader reader(content);
  if (opcode == mcap::kHeader) {
    reader.take_string();  // profile
    library_ = reader.take_string();
  } else if (opcode == mcap::kSchema) {
    McapSchema schema;
    schema.id = reader.take<std::uint16_t>();
    schema.name = reader.take_string();
    schema.encoding = reader.take_string();
    schema.data = reader.take_string();
    if (reader.ok()) schemas_.push_back(std::move(schema));
  } else if (opcode == mcap::kChannel) {
    McapChannel channel;
    channel.id = reader.take<std::uint16_t>();
    channel.schema = reader.take<std::uint16_t>();
    channel.topic = reader.take_string();
    channel.message_encoding = reader.take_string();
    channel.metadata = reader.take_map();
    if (reader.ok()) channels_.push_back(std::move(channel));
  } else {
    McapMetadata metadata;
    metadata.name = reader.take_string();
    metadata.entries = reader.take_map();
    if (reader.ok()) metadata_.push_back(std::move(metadata));
  }
  return reader.ok();
}

bool McapReader::read_chunk_head(std::uint64_t offset, std::uint64_t length) {
  const std::uint64_t most = kChunkHeadSize + 4 + kMaxCompressionName + 8;
  const std::uint64_t available = std::min({most, length, file_.size() - offset});
  std::string head;
  if (!file_.read(offset, available, &head)) return false;
  ByteReader reader(head);
  McapChunk chunk;
  reader.take<std::uint64_t>();
  reader.take<std::uint64_t>();
  chunk.uncompressed_size = reader.take<std::uint64_t>();
  chunk.crc = reader.take<std::uint32_t>();
  chunk.compression = reader.take_string();
  const auto size = reader.take<std::uint64_t>();
  if (!reader.ok()) return available < std::min(most, length);  // cut off inside the head: no data
  chunk.offset = offset + (head.size() - reader.rest().size());
  if (size != length - (chunk.offset - offset)) return false;
  chunk.size = std::min(size, file_.size() - chunk.offset);
  chunk.cut = chunk.size < size;
  chunks_.push_back(std::move(chunk));
  return true;
}

bool McapReader::break_at(std::uint64_t offset, const std::string& why) {
  break_reason_ = "at byte " + std::to_string(offset) + " of " + std::to_string(file_.size()) +
                  ": " + why + "; all before it is read";
  return false;
}

void McapReader::check_end(std::uint64_t offset) {
  std::string end;
  const std::size_t size = mcap::kMagic.size();
  if (file_.size() < offset + size || !file_.read(file_.size() - size, size, &end) ||
      end != mcap::kMagic) {
    break_at(offset, "the data are complete, the summary after them is not");
  }
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
  if (chunk.crc != 0 && crc32(*records) != chunk.crc) {
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
