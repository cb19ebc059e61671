// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/mcap_writer.h"

#include <zstd.h>

#include <algorithm>
#include <cstring>

#include "daemon/log/bytes.h"
#include "daemon/log/crc32.h"
#include "daemon/log/mcap_format.h"
#include "daemon/log/seal.h"

namespace gaitd::daemon {

struct McapWriter::Compressor {
  ZSTD_CCtx* context = ZSTD_createCCtx();
  std::string output;

  Compressor() = default;
  ~Compressor() { ZSTD_freeCCtx(context); }
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;

  // The compressed bytes, valid until the next call; nothing if that failed.
  std::string_view compress(std::string_view bytes, int level) {
    if (context == nullptr) return {};
    output.resize(ZSTD_compressBound(bytes.size()));
    const std::size_t size =
        ZSTD_compressCCtx(context, output.data(), output.size(), bytes.data(), bytes.size(), level);
    return ZSTD_isError(size) ? std::string_view() : std::string_view(output.data(), size);
  }
};

McapWriter::McapWriter() : compressor_(std::make_unique<Compressor>()) {}

McapWriter::~McapWriter() { close(); }

bool McapWriter::open(const std::string& path, const std::string& library,
                      const McapOptions& options) {
  options_ = options;
  if (!file_.open(path)) return false;
  chunk_.reserve(options.chunk_bytes + (64u << 10));
  checksum_ = sealed_checksum_ = 0;
  sealed_size_ = 0;
  write(mcap::kMagic);
  std::string header;
  put_string(header, "");  // profile
  put_string(header, library);
  write_record(mcap::kHeader, header);
  seal();
  return ok();
}

std::uint16_t McapWriter::add_schema(const std::string& name, const std::string& encoding,
                                     const std::string& data) {
  const auto id = static_cast<std::uint16_t>(schemas_.size() + 1);
  std::string record;
  put(record, id);
  put_string(record, name);
  put_string(record, encoding);
  put_string(record, data);
  write_record(mcap::kSchema, record);
  seal();
  schemas_.push_back(std::move(record));
  return id;
}

std::uint16_t McapWriter::add_channel(std::uint16_t schema, const std::string& topic,
                                      const std::string& message_encoding,
                                      const std::map<std::string, std::string>& metadata) {
  const auto id = static_cast<std::uint16_t>(channels_.size());
  Channel channel;
  put(channel.record, id);
  put(channel.record, schema);
  put_string(channel.record, topic);
  put_string(channel.record, message_encoding);
  put_map(channel.record, metadata);
  write_record(mcap::kChannel, channel.record);
  seal();
  channels_.push_back(std::move(channel));
  return id;
}

void McapWriter::add_metadata(const std::string& name,
                              const std::map<std::string, std::string>& metadata) {
  flush();
  std::string record;
  put_string(record, name);
  put_map(record, metadata);
  std::string index;
  put(index, file_.size());
  put(index, static_cast<std::uint64_t>(record.size() + mcap::kRecordHeaderSize));
  put_string(index, name);
  write_record(mcap::kMetadata, record);
  seal();
  metadata_indexes_.push_back(std::move(index));
}

std::string& McapWriter::begin_message(std::uint16_t channel, std::uint64_t time_ns) {
  const bool first = chunk_.empty();
  chunk_start_time_ = first ? time_ns : std::min(chunk_start_time_, time_ns);
  chunk_end_time_ = first ? time_ns : std::max(chunk_end_time_, time_ns);
  start_time_ = message_count_ == 0 ? time_ns : std::min(start_time_, time_ns);
  end_time_ = message_count_ == 0 ? time_ns : std::max(end_time_, time_ns);

  Channel& own = channels_[channel];
  message_start_ = chunk_.size();
  message_channel_ = channel;
  own.index.emplace_back(time_ns, message_start_);
  put(chunk_, static_cast<std::uint8_t>(mcap::kMessage));
  put(chunk_, std::uint64_t{0});  // length, set by end_message()
  put(chunk_, channel);
  put(chunk_, own.sequence++);
  put(chunk_, time_ns);
  put(chunk_, time_ns);
  return chunk_;
}

void McapWriter::end_message() {
  const std::uint64_t length = chunk_.size() - message_start_ - mcap::kRecordHeaderSize;
  std::memcpy(chunk_.data() + message_start_ + 1, &length, sizeof(length));
  ++channels_[message_channel_].message_count;
  ++message_count_;
  if (chunk_.size() >= options_.chunk_bytes ||
      chunk_end_time_ - chunk_start_time_ >= options_.chunk_ns) {
    flush();
  }
}

void McapWriter::flush() {
  if (!chunk_.empty() && ok() && is_open()) write_chunk();
  clear_chunk();
}

void McapWriter::clear_chunk() {
  chunk_.clear();
  for (Channel& channel : channels_) channel.index.clear();
}

void McapWriter::write(std::string_view bytes) {
  checksum_ = crc32(bytes, checksum_);
  file_.write(bytes);
}

void McapWriter::write_record(std::uint8_t opcode, std::string_view content) {
  std::string header;
  put(header, opcode);
  put(header, static_cast<std::uint64_t>(content.size()));
  write(header);
  write(content);
}

void McapWriter::seal() {
  write_record(mcap::kSeal, encode_seal({sealed_size_, sealed_checksum_, checksum_}));
  sealed_size_ = file_.size();
  sealed_checksum_ = checksum_;
}

void McapWriter::write_chunk() {
  std::string_view records = chunk_;
  std::string compression;
  if (options_.compression == McapCompression::kZstd) {
    const std::string_view smaller = compressor_->compress(chunk_, options_.level);
    if (!smaller.empty()) {
      records = smaller;
      compression = "zstd";
    }
  }
  const std::uint64_t start = file_.size();
  std::string head;
  put(head, chunk_start_time_);
  put(head, chunk_end_time_);
  put(head, static_cast<std::uint64_t>(chunk_.size()));
  put(head, crc32(chunk_));
  put_string(head, compression);
  put(head, static_cast<std::uint64_t>(records.size()));
  std::string record;
  put(record, static_cast<std::uint8_t>(mcap::kChunk));
  put(record, static_cast<std::uint64_t>(head.size() + records.size()));
  write(record + head);
  write(records);

  std::string index;
  put(index, chunk_start_time_);
  put(index, chunk_end_time_);
  put(index, start);
  put(index, file_.size() - start);
  const std::uint64_t indexes_start = file_.size();
  put_string(index, write_message_indexes());
  put(index, file_.size() - indexes_start);
  seal();
  put_string(index, compression);
  put(index, static_cast<std::uint64_t>(records.size()));
  put(index, static_cast<std::uint64_t>(chunk_.size()));
  chunk_indexes_.push_back(std::move(index));
}

// Returns where each of them stands: the entries of a map from channel to offset.
std::string McapWriter::write_message_indexes() {
  std::string offsets;
  for (std::size_t id = 0; id < channels_.size(); ++id) {
    const Channel& channel = channels_[id];
    if (channel.index.empty()) continue;
    put(offsets, static_cast<std::uint16_t>(id));
    put(offsets, file_.size());
    std::string entries;
    for (const auto& [time, offset] : channel.index) {
      put(entries, time);
      put(entries, offset);
    }
    std::string record;
    put(record, static_cast<std::uint16_t>(id));
    put_string(record, entries);
    write_record(mcap::kMessageIndex, record);
  }
  return offsets;
}

bool McapWriter::close() {
  if (!is_open()) return ok();
  flush();
  std::string data_end;
  put(data_end, checksum_);
  write_record(mcap::kDataEnd, data_end);
  write_summary();
  return file_.close();
}

void McapWriter::write_summary() {
  const std::uint64_t start = file_.size();
  std::uint64_t position = start;
  std::string section;  // kept for its checksum
  std::string offsets;
  const auto add_group = [&](std::uint8_t opcode, const std::vector<std::string>& records) {
    if (records.empty()) return;
    const std::uint64_t group_start = start + section.size();
    for (const std::string& record : records) {
      put(section, opcode);
      put(section, static_cast<std::uint64_t>(record.size()));
      section += record;
    }
    position = start + section.size();
    put(offsets, static_cast<std::uint8_t>(mcap::kSummaryOffset));
    put(offsets, std::uint64_t{17});
    put(offsets, opcode);
    put(offsets, group_start);
    put(offsets, position - group_start);
  };

  std::vector<std::string> channels;
  std::string counts;
  for (std::size_t id = 0; id < channels_.size(); ++id) {
    channels.push_back(channels_[id].record);
    put(counts, static_cast<std::uint16_t>(id));
    put(counts, channels_[id].message_count);
  }
  std::string statistics;
  put(statistics, message_count_);
  put(statistics, static_cast<std::uint16_t>(schemas_.size()));
  put(statistics, static_cast<std::uint32_t>(channels_.size()));
  put(statistics, std::uint32_t{0});  // attachments
  put(statistics, static_cast<std::uint32_t>(metadata_indexes_.size()));
  put(statistics, static_cast<std::uint32_t>(chunk_indexes_.size()));
  put(statistics, start_time_);
  put(statistics, end_time_);
  put_string(statistics, counts);

  add_group(mcap::kSchema, schemas_);
  add_group(mcap::kChannel, channels);
  add_group(mcap::kStatistics, {statistics});
  add_group(mcap::kChunkIndex, chunk_indexes_);
  add_group(mcap::kMetadataIndex, metadata_indexes_);
  section += offsets;

  put(section, static_cast<std::uint8_t>(mcap::kFooter));
  put(section, std::uint64_t{20});
  put(section, start);
  put(section, position);
  put(section, crc32(section));
  section += mcap::kMagic;
  file_.write(section);
}

}  // namespace gaitd::daemon
