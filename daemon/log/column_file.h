// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/log/input_file.h"
#include "daemon/log/log_reader.h"
#include "daemon/log/signal.h"
#include "daemon/log/signal_codec.h"

namespace gaitd::daemon {

// Tells whether a log is still the one that was read.
struct LogIdentity {
  std::uint64_t size = 0;       // bytes
  std::int64_t changed_ns = 0;  // when it was written last
  std::uint32_t tail_crc = 0;   // of its last bytes, where a summary has its checksum

  bool operator==(const LogIdentity&) const = default;
  // False with `error` if there is no such file.
  bool of(const std::string& path, std::string* error);
};

// Writes the values of a log by signal: blocks of rows, in each the values of one signal after
// those of the other, every one compressed by itself; at the end where each begins. Takes the ticks
// while the log is opened and compresses on a thread of its own.
class ColumnWriter final : public LogReader::RowSink {
 public:
  ColumnWriter();
  ~ColumnWriter() override;
  ColumnWriter(const ColumnWriter&) = delete;
  ColumnWriter& operator=(const ColumnWriter&) = delete;

  // Writes to the descriptor, which stays open and belongs to the caller.
  void write_to(int descriptor) { descriptor_ = descriptor; }
  void begin(const SignalTable& table, const SignalCodec& codec) override;
  void row(std::string_view message) override;
  // `info`: text that is kept with the columns. False with `error` if anything could not be
  // written.
  bool finish(const LogIdentity& identity, const std::string& info, std::string* error);

 private:
  struct Compressor;
  void hand_over();
  void write_block(const std::string& rows);
  void encode(std::span<const double> values, bool narrow);
  void write(std::string_view bytes);

  int descriptor_ = -1;
  SignalTable table_;
  std::unique_ptr<SignalCodec> codec_;
  std::string filling_, writing_;  // messages of a block, one behind the other
  std::uint64_t rows_ = 0;
  std::future<void> pending_;
  std::unique_ptr<Compressor> compressor_;
  std::vector<std::uint32_t> sizes_;  // by block and signal
  std::string output_;
  std::uint64_t written_ = 0;
  int failed_ = 0;  // errno of the first write that failed
};

// Reads them. Any bytes whatever are either read or refused.
class ColumnFile {
 public:
  // Null if there is none, if it is damaged, or of another log than `identity`.
  static std::unique_ptr<ColumnFile> open(const std::string& path, const LogIdentity& identity);

  const SignalTable& signals() const { return table_; }
  const std::string& info() const { return info_; }
  std::uint64_t rows() const { return rows_; }

  // Of the rows `first`, `first` + `step` and so on, which must be there. False if the file is not
  // any more what was written.
  bool read(std::size_t signal, std::uint64_t first, std::uint64_t step,
            std::span<double> values) const;

 private:
  bool read_index(const LogIdentity& identity);
  bool decode(std::size_t signal, std::uint64_t block, std::vector<double>* values,
              std::string* scratch) const;

  InputFile file_;
  SignalTable table_;
  std::string info_;
  std::uint64_t rows_ = 0;
  std::vector<std::uint64_t> offsets_;  // by block and signal, and the end
};

}  // namespace gaitd::daemon
