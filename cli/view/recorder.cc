// SPDX-License-Identifier: Apache-2.0
#include "cli/view/recorder.h"

#include <boost/asio/post.hpp>
#include <ctime>
#include <filesystem>
#include <utility>

#include "cli/live/robot_metadata.h"
#include "cli/report/report_data.h"
#include "daemon/log/log_reader.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr std::size_t kKeptReports = 8;  // that are kept; each has some megabytes

std::string new_file(const std::string& folder) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char name[64];
  std::strftime(name, sizeof(name), "gaitd-view-%Y%m%d-%H%M%S", &local);
  fs::path file = fs::path(folder) / (std::string(name) + ".mcap");
  for (int i = 2; fs::exists(file); ++i) {
    file = fs::path(folder) / (std::string(name) + "-" + std::to_string(i) + ".mcap");
  }
  return file.string();
}

}  // namespace

std::string Recorder::begin(const json& robot, const daemon::SignalTable& signals) {
  file_ = new_file(folder_);
  width_ = signals.size();
  tick_signal_ = find_signal(signals, "tick");
  rows_ = 0;
  auto writer = std::make_unique<daemon::LogWriter>(signals);
  std::string error;
  if (!writer->open(file_, log_metadata_of(robot), {}, &error)) return error;
  writer_ = std::move(writer);
  return "";
}

void Recorder::add(const LiveFrame& frame) {
  if (!writer_ || frame.values.size() != width_) return;
  std::vector<double> values = frame.values;
  if (tick_signal_ >= 0)
    values[static_cast<std::size_t>(tick_signal_)] = static_cast<double>(rows_);
  writer_->write_tick(rows_++, frame.time, values, nullptr);
}

void Recorder::add(const daemon::Event& event) {
  if (!writer_) return;
  daemon::Event numbered = event;
  numbered.tick = rows_;
  writer_->write_event(numbered);
}

void Recorder::end(std::function<void(const End&)> done) {
  if (!writer_) return done({.log = "", .report = {}, .error = "nothing is being recorded"});
  boost::asio::post(threads_, [this, file = file_,
                               writer = std::shared_ptr(std::exchange(writer_, nullptr)),
                               done = std::move(done)]() mutable {
    End end{.log = file, .report = {}, .error = ""};
    Message page;
    if (!writer->close()) {
      end.error = writer->error();
    } else {
      std::vector<std::unique_ptr<daemon::LogReader>> logs;
      logs.push_back(daemon::LogReader::open(file, &end.error));
      if (logs.back() && logs.back()->tick_count() == 0) end.error = file + ": holds no tick";
      if (end.error.empty()) {
        page = std::make_shared<const std::string>(report_page(report_data(logs), &end.error));
      }
    }
    boost::asio::post(*io_, [this, page, end = std::move(end), done = std::move(done)]() mutable {
      if (end.error.empty()) {
        end.report = next_report_++;
        reports_[*end.report] = page;
        if (reports_.size() > kKeptReports) reports_.erase(reports_.begin());
      }
      done(end);
    });
  });
}

Message Recorder::report(int number) const {
  const auto found = reports_.find(number);
  return found == reports_.end() ? nullptr : found->second;
}

}  // namespace gaitd::cli
