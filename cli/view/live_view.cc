// SPDX-License-Identifier: Apache-2.0
#include "cli/view/live_view.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <utility>

#include "cli/installed_page.h"
#include "cli/view/raw_bytes.h"
#include "daemon/log/glob.h"
#include "daemon/telemetry/log_writer.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;

constexpr char kProtocol[] = "gaitd.v1";
constexpr char kPolicy[] =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: "
    "blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
constexpr std::string_view kReports = "/report/";

static_assert(std::endian::native == std::endian::little, "frames are little-endian");

bool is_shown(const std::string& signal) {
  return std::ranges::any_of(LiveSource::shown_signals(),
                             [&](const auto& glob) { return daemon::glob_match(glob, signal); });
}

WebAnswer not_found() {
  return {.status = 404, .body = message_of("there is no such page\n"), .policy = {}};
}

}  // namespace

// A WebSocket of the live page.
class LiveView::Peer : public WebPeer {
 public:
  Peer(LiveView* view, std::shared_ptr<Viewer> viewer) : view_(view), viewer_(std::move(viewer)) {}
  void on_message(std::string_view text, bool binary) override {
    if (!binary) viewer_->on_message(text);
  }
  void on_end() override {
    viewer_->end();
    view_->viewers_.erase(viewer_);
    view_->tell_viewers();
  }

 private:
  LiveView* view_;
  std::shared_ptr<Viewer> viewer_;
};

class LiveView::FoxglovePeer : public WebPeer {
 public:
  FoxglovePeer(LiveView* view, std::shared_ptr<FoxgloveClient> client)
      : view_(view), client_(std::move(client)) {}
  void on_message(std::string_view text, bool binary) override {
    if (binary) {
      client_->on_binary(text);
    } else {
      client_->on_text(text);
    }
  }
  void on_end() override {
    client_->end();
    view_->foxgloves_.erase(client_);
    view_->choose_signals();
  }

 private:
  LiveView* view_;
  std::shared_ptr<FoxgloveClient> client_;
};

LiveView::LiveView(boost::asio::io_context* io, const std::string& socket, Access access,
                   std::string page, std::string log_folder)
    : access_(std::move(access)),
      page_(message_of(std::move(page))),
      connector_(io, socket),
      source_(io, &connector_,
              {.on_robot = [this] { on_robot(); },
               .on_status =
                   [this](const json& status, double silent) {
                     json message = {{"type", "status"}, {"status", status}};
                     if (silent > 0.0) message["silent"] = silent;
                     send_all(text_of(message));
                   },
               .on_event = [this](const daemon::Event& event) { on_event(event); },
               .on_frame = [this](const LiveFrame& frame) { on_frame(frame); },
               // A page that hears nothing takes its own connection for lost.
               .on_away =
                   [this] {
                     send_all(text_of({{"type", "alive"}}));
                   }}),
      recorder_(io, std::move(log_folder)),
      robot_(text_of({{"type", "robot"}, {"connected", false}, {"reason", "not connected yet"}})) {}

void LiveView::stop() {
  source_.stop();
  for (const auto& viewer : std::exchange(viewers_, {})) viewer->end();
  for (const auto& client : std::exchange(foxgloves_, {})) client->end();
}

WebAnswer LiveView::get(std::string_view path, std::string_view token) {
  if (path == "/" || path == "/index.html") {
    return {.status = 200, .type = "text/html; charset=utf-8", .body = page_, .policy = kPolicy};
  }
  if (!path.starts_with(kReports)) return not_found();
  if (!access_.role_of(token))
    return {.status = 401, .body = message_of("no valid token\n"), .policy = {}};
  int number = 0;
  path.remove_prefix(kReports.size());
  const auto [end, error] = std::from_chars(path.data(), path.data() + path.size(), number);
  if (error != std::errc() || end != path.data() + path.size()) return not_found();
  const Message report = recorder_.report(number);
  return report ? WebAnswer{.status = 200,
                            .type = "text/html; charset=utf-8",
                            .body = report,
                            .policy = {}}
                : not_found();
}

std::string LiveView::choose_protocol(std::string_view path, std::string_view offered) {
  if (path == "/live") return offered.find(kProtocol) != std::string_view::npos ? kProtocol : "";
  return path == "/" ? FoxgloveClient::choose_protocol(offered) : "";
}

std::shared_ptr<WebPeer> LiveView::open(daemon::Role role, const std::string& protocol,
                                        std::shared_ptr<ViewerSocket> socket) {
  auto relay = std::make_shared<RpcRelay>(role, &connector_);
  relay->connect_ahead();
  if (protocol != kProtocol) {
    const auto client =
        std::make_shared<FoxgloveClient>(std::move(relay), std::move(socket), [this] {
          if (channels_) channels_->begin_again();
        });
    foxgloves_.insert(client);
    client->start();
    if (channels_) client->advertise(&channels_->list(), "");
    if (!source_.connected()) client->advertise(nullptr, source_.reason());
    choose_signals();
    return std::make_shared<FoxglovePeer>(this, client);
  }
  const auto viewer = std::make_shared<Viewer>(std::move(relay), std::move(socket),
                                               [this](bool on) { record(on); });
  viewers_.insert(viewer);
  viewer->send_text(
      text_of({{"type", "hello"}, {"role", daemon::role_name(role)}, {"version", GAITD_VERSION}}));
  viewer->send_text(robot_);
  if (recorder_.recording()) {
    viewer->send_text(text_of(
        {{"type", "record"}, {"on", true}, {"since", recording_since_}, {"report", nullptr}}));
  }
  tell_viewers();
  return std::make_shared<Peer>(this, viewer);
}

void LiveView::send_all(const Message& message) {
  for (const auto& viewer : viewers_) viewer->send_text(message);
}

void LiveView::tell_viewers() {
  send_all(text_of({{"type", "viewers"}, {"viewers", viewers_.size()}}));
}

// Comes with every new subscription too: the viewers are told only what has changed for them.
void LiveView::on_robot() {
  json message = {{"type", "robot"}, {"connected", source_.connected()}};
  places_.clear();
  if (source_.connected()) {
    const json& robot = source_.robot();
    for (const char* key : {"name", "simulation", "urdf", "robot", "world"}) {
      message[key] = robot.value(key, json());
    }
    json signals = json::array();
    const daemon::SignalTable& table = source_.signals();
    for (std::size_t i = 0; i < table.size(); ++i) {
      if (!is_shown(table[i].name)) continue;
      places_.push_back(i);
      json signal = {{"name", table[i].name}, {"unit", table[i].unit}};
      if (!table[i].words.empty()) signal["words"] = table[i].words;
      signals.push_back(std::move(signal));
    }
    message["signals"] = std::move(signals);
  } else {
    message["reason"] = source_.reason();
  }
  Message text = text_of(message);
  if (*text != *robot_) {
    robot_ = std::move(text);
    send_all(robot_);
  }
  show_channels();
  if (!source_.connected() && (recorder_.recording() || wants_recording_)) record(false);
  if (source_.has_all() && wants_recording_ && !recorder_.recording()) begin_recording();
}

void LiveView::on_frame(const LiveFrame& frame) {
  newest_time_ = frame.time;
  recorder_.add(frame);
  if (recorder_.failed()) record(false);
  if (channels_ && !foxgloves_.empty()) {
    for (const auto& client : foxgloves_) client->send_time(daemon::to_nanoseconds(frame.time));
    channels_->add(frame);
  }
  if (viewers_.empty()) return;
  std::string bytes;
  bytes.reserve(16 + 4 * places_.size());
  append_raw(&bytes, frame.time);
  append_raw(&bytes, static_cast<double>(frame.tick));
  for (const std::size_t place : places_) {
    append_raw(&bytes, static_cast<float>(frame.values[place]));
  }
  const Message message = message_of(std::move(bytes));
  for (const auto& viewer : viewers_) viewer->send_frame(message);
}

void LiveView::on_event(const daemon::Event& event) {
  recorder_.add(event);
  if (channels_) channels_->add(event);
  json text = json::parse(event.text, nullptr, false);
  send_all(text_of({{"type", "event"},
                    {"event",
                     {{"tick", event.tick},
                      {"time", event.time},
                      {"kind", event.kind},
                      {"text", text.is_discarded() ? json(event.text) : std::move(text)}}}}));
}

void LiveView::choose_signals() { source_.want_all(wants_recording_ || !foxgloves_.empty()); }

// Foxglove's messages are made from all signals.
void LiveView::show_channels() {
  channels_.reset();
  if (source_.has_all()) {
    channels_ = std::make_unique<FoxgloveChannels>(
        source_.robot(), source_.signals(),
        [this](std::uint16_t channel, std::uint64_t time_ns, std::string_view data, bool once) {
          for (const auto& client : foxgloves_) client->send_message(channel, time_ns, data, once);
        });
  }
  for (const auto& client : foxgloves_) {
    if (channels_ || !source_.connected()) {
      client->advertise(channels_ ? &channels_->list() : nullptr, source_.reason());
    }
  }
}

void LiveView::record(bool on) {
  if (on == wants_recording_) return tell_recording(nullptr, "");
  if (on && !source_.connected()) return tell_recording(nullptr, source_.reason());
  wants_recording_ = on;
  choose_signals();
  // Recording begins with the first subscription to all, which may be there.
  if (on && source_.has_all()) return begin_recording();
  if (on) return;
  if (!recorder_.recording()) return tell_recording(nullptr, "");
  recorder_.end([this](const Recorder::End& end) { tell_recording(&end, end.error); });
}

void LiveView::begin_recording() {
  recording_since_ = newest_time_;
  recorder_.begin(source_.robot(), source_.signals(), [this](const std::string& error) {
    if (!error.empty()) {
      wants_recording_ = false;
      choose_signals();
    }
    tell_recording(nullptr, error);
  });
}

void LiveView::tell_recording(const Recorder::End* end, const std::string& error) {
  json message = {{"type", "record"},
                  {"on", recorder_.recording()},
                  {"since", recording_since_},
                  {"report", nullptr}};
  if (end != nullptr) {
    message["log"] = end->log;
    message["lost"] = end->lost;
  }
  if (end != nullptr && end->report) {
    message["report"] = std::string(kReports) + std::to_string(*end->report);
  }
  if (!error.empty()) message["error"] = error;
  send_all(text_of(message));
}

std::string live_page(std::string* error) {
  auto [file, page] = installed_page("view");
  if (page.empty()) {
    *error = file + ": no such page; gaitd was built without it: install npm and build again";
  }
  return page;
}

}  // namespace gaitd::cli
