// SPDX-License-Identifier: Apache-2.0
// A log file: opened, described as text and JSON, exported as CSV, its sensors read.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <ostream>
#include <streambuf>
#include <string>

#include "daemon/log/export_csv.h"
#include "daemon/log/log_info.h"
#include "daemon/log/log_reader.h"
#include "fuzz/require.h"

namespace gaitd::daemon {
namespace {

// Takes everything and keeps nothing.
class NullBuffer : public std::streambuf {
 protected:
  int overflow(int c) override { return c == traits_type::eof() ? 0 : c; }
  std::streamsize xsputn(const char*, std::streamsize count) override { return count; }
};

void read(const std::string& path) {
  std::string error;
  const std::unique_ptr<LogReader> log = LogReader::open(path, &error);
  if (log == nullptr) {
    fuzz::require(!error.empty(), "what is not read has an error");
    return;
  }
  fuzz::require(nlohmann::json::accept(log_info_json(*log)), "the description is JSON");
  fuzz::require(!log_info_text(*log).empty(), "the description has a text");
  NullBuffer nowhere;
  std::ostream out(&nowhere);
  export_csv(*log, {}, out, &error);
  CsvOptions some;
  some.signals = "time,joint/*,?ick";
  some.start = 0.001;
  export_csv(*log, some, out, &error);
  LogReader::SensorsCursor cursor = log->sensors();
  const auto sensors = std::make_unique<GaitdSensors>();
  std::uint64_t count = 0;
  while (cursor.next(sensors.get())) ++count;
  fuzz::require(count == log->sensors_count(), "all sensors are read again");
  fuzz::require(log->column("time").empty() || log->column("time").size() == log->tick_count(),
                "a value for every tick");
}

// A file in memory that lives as long as the process.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(memfd_create("log", MFD_CLOEXEC)) {
    fuzz::require(descriptor_ >= 0, "there are files in memory");
  }
  std::string with(const std::uint8_t* data, std::size_t size) const {
    fuzz::require(ftruncate(descriptor_, 0) == 0, "a file can be emptied");
    fuzz::require(pwrite(descriptor_, data, size, 0) == static_cast<ssize_t>(size),
                  "a file can be written");
    return "/proc/self/fd/" + std::to_string(descriptor_);
  }

 private:
  int descriptor_;
};

}  // namespace
}  // namespace gaitd::daemon

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const gaitd::daemon::MemoryFile file;
  gaitd::daemon::read(file.with(data, size));
  return 0;
}
