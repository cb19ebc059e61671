// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/log_rotation.h"

#include <filesystem>
#include <system_error>
#include <utility>

namespace gaitd::daemon {

namespace fs = std::filesystem;

RotatingLog::RotatingLog(SignalTable table)
    : table_(std::move(table)), writer_(std::make_unique<LogWriter>(table_)) {}

std::string RotatingLog::path_of(int part) const {
  if (part == 1) return path_;
  const fs::path path(path_);
  const std::string name =
      path.stem().string() + "-" + std::to_string(part) + path.extension().string();
  return (path.parent_path() / name).string();
}

bool RotatingLog::open(const std::string& path, const LogMetadata& metadata,
                       const McapOptions& options, const LogLimits& limits, std::string* error) {
  path_ = path;
  metadata_ = metadata;
  options_ = options;
  limits_ = limits;
  const bool opened = open_part();
  *error = error_;
  return opened;
}

bool RotatingLog::open_part() {
  LogMetadata metadata = metadata_;
  const std::string previous = fs::path(file_).filename().string();
  file_ = path_of(++part_);
  if (part_ > 1) {
    metadata["part"] = std::to_string(part_);
    metadata["previous"] = previous;
  }
  if (!writer_->open(file_, metadata, options_, &error_)) return false;
  files_.push_back(file_);
  return true;
}

void RotatingLog::rotate_if_full() {
  const bool writing = writer_->is_open() && writer_->ok();
  if (!writing || limits_.max_bytes == 0 || writer_->bytes_written() < limits_.max_bytes) return;
  const std::string next = fs::path(path_of(part_ + 1)).filename().string();
  if (!writer_->close({{"next", next}})) return;
  before_ = {bytes_written(), ticks_written(), latest_.tick_dropouts, latest_.event_dropouts};
  writer_ = std::make_unique<LogWriter>(table_);
  if (open_part()) delete_oldest();
}

void RotatingLog::set_dropouts(std::uint64_t ticks, std::uint64_t events) {
  latest_.tick_dropouts = ticks;
  latest_.event_dropouts = events;
  writer_->set_dropouts(ticks - before_.tick_dropouts, events - before_.event_dropouts);
}

void RotatingLog::delete_oldest() {
  while (limits_.keep > 0 && files_.size() > static_cast<std::size_t>(limits_.keep)) {
    std::error_code ignored;  // gone already, or not ours to delete: the log goes on
    fs::remove(files_.front(), ignored);
    files_.pop_front();
  }
}

}  // namespace gaitd::daemon
