// SPDX-License-Identifier: Apache-2.0
#include "cli/teleop/teleop.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <utility>

namespace gaitd::cli::teleop {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr int kRound = 20;                // ms, at most, until what has run out is looked at
constexpr milliseconds kStall{250};       // keys that were waiting so long are none of now
constexpr milliseconds kStatus{100};      // between two
constexpr milliseconds kPicture{100};     // between two
constexpr milliseconds kPlainLine{1000};  // between two, while nothing changes
constexpr milliseconds kAnswer{2000};     // until the connection is given up
constexpr milliseconds kReconnect{500};
constexpr milliseconds kStand{10000};  // waited for, at the end
constexpr milliseconds kFresh{400};    // until the status tells of the last command
constexpr milliseconds kHangUp{500};   // for the last command, where nobody looks any more

std::int64_t new_session() {
  const std::int64_t now = Clock::now().time_since_epoch().count();
  return ((now << 16) ^ getpid()) & ((std::int64_t{1} << 53) - 1);
}

double number(const json& object, const char* name) {
  const json value = object.is_object() ? object.value(name, json()) : json();
  return value.is_number() ? value.get<double>() : 0.0;
}

}  // namespace

Teleop::Teleop(const std::string& socket, std::unique_ptr<Pad> pad)
    : robot_(Destination::of(socket, daemon::least_role("drive"))),
      estop_(Destination::of(socket, daemon::least_role("estop"))),
      pilot_(new_session()),
      pad_(std::move(pad)) {}

void Teleop::wait() const {
  pollfd sources[] = {{STDIN_FILENO, POLLIN, 0},
                      {pad_ ? pad_->fd() : -1, POLLIN, 0},
                      {robot_.fd(), POLLIN, 0},
                      {estop_.fd(), POLLIN, 0}};
  poll(sources, std::size(sources), kRound);
}

void Teleop::send(const std::vector<Request>& requests, Time now) {
  for (const Request& request : requests) {
    const int id = robot_.send(request.method, request.params);
    if (id != 0) pending_[id] = {request.method, now};
  }
}

void Teleop::press(Key key, Time now) {
  switch (key) {
    case Key::kEstop:
      estop_.pull(now);
      send(pilot_.finish(), now);
      pilot_.let_go();
      return keys_.let_go();
    case Key::kStop:
      keys_.let_go();
      return send(pilot_.press(key, estop_.open()), now);
    case Key::kArm:
    case Key::kReset:
      return send(pilot_.press(key, estop_.open()), now);
    case Key::kFaster:
      return scale_.faster();
    case Key::kSlower:
      return scale_.slower();
    case Key::kHelp:
      help_ = !help_;
      return;
    case Key::kQuit:
      return quit(now);
    default:
      return keys_.press(key, now);
  }
}

void Teleop::take_input(Time now) {
  const bool stalled = now - round_ > kStall && round_ != Time{};
  round_ = now;
  std::vector<Key> keys = decoder_.take(console_->read(), now);
  if (decoder_.lone_escape(now)) keys.push_back(Key::kEstop);
  if (pad_ && !pad_->gone()) {
    pad_->read();
    for (const Key key : pad_->state().pressed()) keys.push_back(key);
  }
  // The e-stop before all that was typed with it.
  std::stable_partition(keys.begin(), keys.end(), [](Key key) { return key == Key::kEstop; });
  const bool estop = !keys.empty() && keys.front() == Key::kEstop;
  for (const Key key : keys) {
    const bool moves = key <= Key::kTurnRight;
    if (moves && (stalled || estop)) continue;
    press(key, now);
  }
  if (console_->ended()) {
    hurry_ = true;
    quit(now);
  }
  if (StopSignals::take()) quit(now);
  if (SuspendSignal::requested()) {
    send(pilot_.finish(), now);
    keys_.let_go();
    pilot_.let_go();  // nor what is held still when it goes on
    console_->suspend();
  }
}

void Teleop::quit(Time now) {
  if (leaving_) {
    hurry_ = true;
    return;
  }
  leaving_ = now;
  keys_.let_go();
  send(pilot_.finish(), now);
  pilot_.let_go();
}

bool Teleop::left(Time now) const {
  if (!leaving_) return false;
  const auto time = now - *leaving_;
  const bool answered = !estop_.open() && std::ranges::all_of(pending_, [](const auto& entry) {
    return entry.second.method == "status";
  });
  if (hurry_) return answered || time > kHangUp;
  if (estop_.open()) return false;
  if (!drove_ || time > kStand) return true;
  return time > kFresh && !pilot_.walking();
}

void Teleop::take_answers(Time now) {
  for (const Link::Answer& answer : robot_.receive()) {
    const auto request = pending_.find(answer.id);
    if (request == pending_.end()) continue;
    const std::string method = request->second.method;
    pending_.erase(request);
    if (method != "status") {
      pilot_.take_answer(method, answer.result);
      continue;
    }
    const json* status = std::get_if<json>(&answer.result);
    if (status == nullptr) continue;
    pilot_.take_status(*status);
    const json pelvis = status->is_object() ? status->value("pelvis", json()) : json();
    if (pelvis.is_object()) {
      real_.add(number(*status, "time"), number(pelvis, "x"), number(pelvis, "y"),
                number(pelvis, "yaw"));
    }
  }
  estop_.tick(now);
}

void Teleop::keep_connected(Time now) {
  const bool overdue = std::ranges::any_of(
      pending_, [&](const auto& entry) { return now - entry.second.since > kAnswer; });
  if (overdue) robot_.give_up("gaitd does not answer");
  if (!robot_.up()) {
    pending_.clear();
    if (!pilot_.connection_lost()) {
      real_.clear();
      pilot_.lose_connection(robot_.why_down());
    }
    if (now >= reconnect_) {
      reconnect_ = now + kReconnect;
      robot_.open();
    }
  }
  const bool asked = std::ranges::any_of(
      pending_, [](const auto& entry) { return entry.second.method == "status"; });
  if (!robot_.up() || asked || now - ask_status_ < kStatus) return;
  ask_status_ = now;
  send({{"status"}}, now);
}

void Teleop::drive(Time now) {
  const bool by_keys = keys_.any(now);
  const bool by_pad = pad_ && pad_->state().held();
  const bool held = !leaving_ && (by_keys || by_pad);
  const Motion wanted = by_keys ? keys_.motion(now) : by_pad ? pad_->state().motion() : Motion{};
  const std::chrono::duration<double> passed = now - std::exchange(drove_at_, now);
  const Motion motion = ramp_.toward(held ? wanted : Motion{}, passed.count());
  asked_ = scale_.of(motion);
  send(pilot_.act(asked_, held, now), now);
  if (!pilot_.driving()) asked_ = {};
  drove_ = pilot_.driving() || (drove_ && (pilot_.walking() || leaving_));
}

Scene Teleop::scene() const {
  Scene scene{.status = pilot_.status(),
              .asked = asked_,
              .real = real_.speed(),
              .percent = scale_.percent(),
              .pad = "",
              .hint = pilot_.hint(),
              .blocked = !pilot_.can_drive(),
              .message = pilot_.message(),
              .bad = pilot_.bad(),
              .alarm = estop_.text(),
              .keys = help_};
  if (pad_) {
    scene.pad = pad_->name() + (pad_->gone()           ? ": UNPLUGGED"
                                : pad_->state().held() ? ", LB held"
                                                       : ", hold LB to move");
  }
  if (leaving_) scene.hint = "the robot stops; x again does not wait for it";
  return scene;
}

void Teleop::show(Time now) {
  if (console_->has_screen()) {
    if (now - draw_ < kPicture) return;
    draw_ = now;
    return console_->draw(screen(scene(), console_->columns(), console_->rows()));
  }
  const Scene now_shown = scene();
  const std::string state = now_shown.status.is_object() ? now_shown.status.value("state", "") : "";
  const std::string key = state + now_shown.hint + now_shown.message + now_shown.alarm +
                          now_shown.pad + std::to_string(now_shown.percent);
  const bool moving = pilot_.walking() && now - print_ >= kPlainLine;
  if (key == printed_ && !moving) return;
  printed_ = key;
  print_ = now;
  console_->print(plain_line(now_shown));
}

std::string Teleop::run() {
  signals_.emplace();
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGQUIT, SIG_IGN);
  console_ = std::make_unique<Console>();
  if (!console_->has_screen()) console_->print(plain_keys());
  for (Time now = Clock::now(); !left(now); now = Clock::now()) {
    take_input(now);
    take_answers(now);
    keep_connected(now);
    drive(now);
    show(now);
    wait();
  }
  console_.reset();
  if (estop_.open()) return estop_.text();
  if (!drove_ || !pilot_.walking()) return "";
  return "The robot has not come to a stand yet; its velocity is zero, or it stops by itself "
         "within "
         "drive.timeout.";
}

}  // namespace gaitd::cli::teleop
