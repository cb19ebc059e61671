// SPDX-License-Identifier: Apache-2.0
#include "cli/view/recorder.h"

#include <atomic>
#include <boost/asio/post.hpp>
#include <ctime>
#include <filesystem>
#include <utility>

#include "cli/live/robot_metadata.h"
#include "cli/report/report_data.h"
#include "daemon/log/log_reader.h"
#include "daemon/telemetry/log_writer.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr std::size_t kKeptReports = 8;    // that are kept; each has some megabytes
constexpr std::size_t kMostWaiting = 600;  // frames for the disk: ten seconds, some megabytes

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

// Belongs to the writing thread but for what is atomic, and what is lost.
struct Recorder::Recording {
  explicit Recording(const daemon::SignalTable& signals)
      : writer(signals), width(signals.size()), tick_signal(find_signal(signals, "tick")) {}

  void write(LiveFrame frame) {
    if (!opened) return;
    if (tick_signal >= 0) {
      frame.values[static_cast<std::size_t>(tick_signal)] = static_cast<double>(rows);
    }
    writer.write_tick(rows++, frame.time, frame.values, nullptr);
    failed = !writer.ok();
  }
  void write(daemon::Event event) {
    if (!opened) return;
    event.tick = rows;
    writer.write_event(event);
  }

  daemon::LogWriter writer;
  std::string file;
  bool opened = false;
  const std::size_t width;  // signals of a frame
  const int tick_signal;
  // A log has no gaps between its ticks: those of a recording are numbered anew.
  std::int64_t rows = 0;
  std::atomic<std::size_t> waiting{0};  // frames and events
  std::atomic<bool> failed{false};
  // That were not even taken; the thread of the io_context counts them.
  std::uint64_t lost_frames = 0, lost_events = 0;
};

Recorder::~Recorder() {
  writing_.join();
  reporting_.join();
}

bool Recorder::failed() const { return now_ != nullptr && now_->failed; }

void Recorder::begin(const json& robot, const daemon::SignalTable& signals,
                     std::function<void(const std::string& error)> done) {
  now_ = std::make_shared<Recording>(signals);
  boost::asio::post(writing_,
                    [this, now = now_, metadata = log_metadata_of(robot), done = std::move(done)] {
                      std::string error;
                      now->file = new_file(folder_);
                      now->opened = now->writer.open(now->file, metadata, {}, &error);
                      boost::asio::post(*io_, [this, now, error, done] {
                        if (!error.empty() && now_ == now) now_ = nullptr;
                        done(error);
                      });
                    });
}

template <class Item>
void Recorder::take(const Item& item, std::uint64_t& lost) {
  if (now_->waiting >= kMostWaiting) {
    ++lost;
    return;
  }
  ++now_->waiting;
  boost::asio::post(writing_, [now = now_, item]() mutable {
    now->write(std::move(item));
    --now->waiting;
  });
}

void Recorder::add(const LiveFrame& frame) {
  if (now_ && frame.values.size() == now_->width) take(frame, now_->lost_frames);
}

void Recorder::add(const daemon::Event& event) {
  if (now_) take(event, now_->lost_events);
}

void Recorder::end(std::function<void(const End&)> done) {
  if (!now_)
    return done({.log = "", .lost = 0, .report = {}, .error = "nothing is being recorded"});
  boost::asio::post(writing_, [this, now = std::exchange(now_, nullptr), done = std::move(done)] {
    End end{.log = now->file, .lost = now->lost_frames, .report = {}, .error = ""};
    now->writer.set_dropouts(now->lost_frames, now->lost_events);
    if (!now->opened || !now->writer.close()) {
      end.error = now->writer.error();
      return tell(std::move(end), nullptr, done);
    }
    boost::asio::post(reporting_, [this, end = std::move(end), done]() mutable {
      Message page;
      std::vector<std::unique_ptr<daemon::LogReader>> logs;
      logs.push_back(daemon::LogReader::open(end.log, &end.error));
      if (logs.back() && logs.back()->tick_count() == 0) end.error = end.log + ": holds no tick";
      if (end.error.empty()) {
        page = std::make_shared<const std::string>(report_page(report_data(logs), &end.error));
      }
      tell(std::move(end), page, done);
    });
  });
}

void Recorder::tell(End end, const Message& page, const std::function<void(const End&)>& done) {
  boost::asio::post(*io_, [this, page, done, end = std::move(end)]() mutable {
    if (end.error.empty()) {
      end.report = next_report_++;
      reports_[*end.report] = page;
      if (reports_.size() > kKeptReports) reports_.erase(reports_.begin());
    }
    done(end);
  });
}

Message Recorder::report(int number) const {
  const auto found = reports_.find(number);
  return found == reports_.end() ? nullptr : found->second;
}

}  // namespace gaitd::cli
