// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/telemetry/message_sink.h"
#include "daemon/telemetry/output_file.h"

namespace gaitd::daemon {

enum class McapCompression { kNone, kZstd };

struct McapOptions {
  McapCompression compression = McapCompression::kZstd;
  // Of zstd. Measured on a walk: -1 gives files 4 % larger than 1 in half to three quarters of the
  // time; 3 gains nothing over 1.
  int level = -1;
  std::size_t chunk_bytes = 1u << 20;      // a chunk is closed when it holds this much
  std::uint64_t chunk_ns = 1'000'000'000;  // or when its messages span this much time
};

// Writes MCAP (https://mcap.dev/spec, version 0): chunks with message indexes and checksums, seals
// over everything (daemon/log/seal.h), and a summary at the end. Schemas, channels and metadata
// stand outside the chunks, so that a file that was cut off still has them. After a failed write it
// does nothing more; see error().
class McapWriter : public MessageSink {
 public:
  McapWriter();
  ~McapWriter() override;
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  bool open(const std::string& path, const std::string& library, const McapOptions& options);

  std::uint16_t add_schema(const std::string& name, const std::string& encoding,
                           const std::string& data) override;
  std::uint16_t add_channel(std::uint16_t schema, const std::string& topic,
                            const std::string& message_encoding,
                            const std::map<std::string, std::string>& metadata) override;
  void add_metadata(const std::string& name, const std::map<std::string, std::string>& metadata);

  std::string& begin_message(std::uint16_t channel, std::uint64_t time_ns) override;
  void end_message() override;

  void flush();
  bool check() { return file_.check(); }  // see OutputFile
  bool close();

  bool is_open() const { return file_.is_open(); }
  bool ok() const { return file_.error().empty(); }
  const std::string& error() const { return file_.error(); }
  std::uint64_t bytes_written() const { return file_.size(); }

 private:
  struct Channel {
    std::string record;
    std::uint32_t sequence = 0;
    std::uint64_t message_count = 0;
    std::vector<std::pair<std::uint64_t, std::uint64_t>> index;  // of the chunk: time, offset
  };
  struct Compressor;

  void write(std::string_view bytes);
  void write_record(std::uint8_t opcode, std::string_view content);
  void seal();
  void write_chunk();
  std::string write_message_indexes();
  void write_summary();
  void clear_chunk();

  OutputFile file_;
  McapOptions options_;
  std::unique_ptr<Compressor> compressor_;
  std::vector<std::string> schemas_;  // contents of the records, for the summary
  std::vector<Channel> channels_;
  std::vector<std::string> chunk_indexes_;
  std::vector<std::string> metadata_indexes_;

  std::string chunk_;  // records of the chunk being filled
  std::uint64_t chunk_start_time_ = 0;
  std::uint64_t chunk_end_time_ = 0;
  std::size_t message_start_ = 0;
  std::uint16_t message_channel_ = 0;
  std::uint64_t start_time_ = 0;
  std::uint64_t end_time_ = 0;
  std::uint64_t message_count_ = 0;

  std::uint32_t checksum_ = 0;         // of the file so far
  std::uint64_t sealed_size_ = 0;      // bytes of the file with its last seal
  std::uint32_t sealed_checksum_ = 0;  // of those
};

}  // namespace gaitd::daemon
