// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/log_rotation.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include "daemon/log/column_log.h"

namespace gaitd::daemon {

using Clock = std::chrono::steady_clock;

namespace fs = std::filesystem;

RotatingLog::RotatingLog(SignalTable table)
    : table_(std::move(table)), writer_(std::make_unique<LogWriter>(table_)) {}

std::string RotatingLog::path_of(int number) const {
  if (number == 1) return path_;
  const fs::path path(path_);
  const std::string name =
      path.stem().string() + "-" + std::to_string(number) + path.extension().string();
  return (path.parent_path() / name).string();
}

// Nobody has named the files after the first: what is there already stays.
int RotatingLog::next_number() const {
  int number = number_ + 1;
  std::error_code unknown;
  while (number > 1 && fs::is_regular_file(path_of(number), unknown)) ++number;
  return number;
}

bool RotatingLog::open(const std::string& path, const LogMetadata& metadata,
                       const McapOptions& options, const LogLimits& limits, std::string* error) {
  path_ = path;
  metadata_ = metadata;
  options_ = options;
  limits_ = limits;
  const bool opened = open_next_part();
  *error = error_;
  return opened;
}

bool RotatingLog::open_next_part() {
  LogMetadata metadata = metadata_;
  if (part_ > 0) {
    metadata["part"] = std::to_string(part_ + 1);
    metadata["previous"] = fs::path(file_).filename().string();
  }
  auto writer = std::make_unique<LogWriter>(table_);
  const int number = next_number();
  const std::string next = path_of(number);
  std::string error;
  if (!writer->open(next, metadata, options_, &error)) {
    error_ = error;
    std::error_code ignored;  // what could not even be begun is not to be left behind
    if (part_ > 0 && fs::is_regular_file(next, ignored) && fs::file_size(next, ignored) == 0) {
      fs::remove(next, ignored);
    }
    return false;
  }
  error_ = this->error();
  before_ = {bytes_written(), ticks_written(), ticks_lost(), events_lost()};
  writer_ = std::move(writer);
  ++part_;
  number_ = number;
  file_ = next;
  files_.push_back(next);
  delete_oldest();
  return true;
}

void RotatingLog::next_file_if_due() {
  if (part_ == 0) return;
  if (!writer_->is_open()) return go_on_after_failure();
  if (limits_.max_bytes == 0 || writer_->bytes_written() < limits_.max_bytes) return;
  const std::string next = fs::path(path_of(next_number())).filename().string();
  if (!writer_->close({{"next", next}})) return;
  told_ = latest_;
  open_next_part();
}

// In a file of its own: the old one may be cut off in the middle of a record.
void RotatingLog::go_on_after_failure() {
  const auto now = Clock::now();
  const bool first = next_try_ == Clock::time_point();
  if (!first && now < next_try_) return;
  next_try_ = now + std::chrono::duration_cast<Clock::duration>(
                        std::chrono::duration<double>(limits_.retry));
  if (!first && has_room() && open_next_part()) next_try_ = {};
}

bool RotatingLog::has_room() const {
  std::error_code unknown;
  const fs::path folder = fs::absolute(path_, unknown).parent_path();
  const fs::space_info space = fs::space(folder, unknown);
  return !unknown && space.available >= limits_.room;
}

void RotatingLog::set_dropouts(std::uint64_t ticks, std::uint64_t events) {
  latest_ = {ticks + ticks_lost(), events + events_lost()};
  writer_->set_dropouts(latest_.ticks - told_.ticks, latest_.events - told_.events);
}

void RotatingLog::delete_oldest() {
  while (limits_.keep > 0 && files_.size() > static_cast<std::size_t>(limits_.keep)) {
    std::error_code ignored;  // gone already, or not ours to delete: the log goes on
    fs::remove(files_.front(), ignored);
    fs::remove(columns_beside(files_.front()), ignored);
    files_.pop_front();
  }
}

}  // namespace gaitd::daemon
