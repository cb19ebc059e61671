// SPDX-License-Identifier: Apache-2.0
#include "cli/teleop/pilot.h"

#include <cmath>

#include "cli/failure.h"

namespace gaitd::cli::teleop {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;

constexpr milliseconds kRenewal{100};
constexpr milliseconds kHandOver{1000};  // a key that stutters must not take the robot back
constexpr int kMostInFlight = 5;         // beyond, what arrives at last would be too old
constexpr const char* kWalkMode = "walk-straight";

std::string text(const json& status, const char* name) {
  const json value = status.is_object() ? status.value(name, json()) : json();
  return value.is_string() ? value.get<std::string>() : "";
}

bool flag(const json& status, const char* name) {
  return status.is_object() && status.value(name, json()) == true;
}

// The log shall not show the noise of a computation.
double rounded(double value) { return std::round(1e3 * value) / 1e3; }

}  // namespace

bool Pilot::walking() const {
  const std::string state = text(status_, "state");
  return state == "walking" || state == "stopping";
}

std::string Pilot::cannot_drive() const {
  const std::string state = text(status_, "state");
  if (lost_) return "no connection to gaitd; trying again";
  if (status_.is_null()) return "no status of gaitd yet";
  if (flag(status_, "stale")) return "the control loop of gaitd hangs: see journalctl -u gaitd";
  if (state == "fault") return "a fault is latched: r resets it, then m arms";
  if (state == "disarmed") return "the robot is disarmed: m arms it, and it stands up";
  if (state == "readying") return "the robot is standing up";
  if (state == "testing") return "a joint is being tested";
  if (flag(status_, "paused")) return "a walk is paused: space ends it, gaitctl resume goes on";
  return "";
}

void Pilot::take_status(const json& status) {
  status_ = status;
  if (lost_) say(false, "connected to gaitd again");  // one that hangs can be connected to
  lost_ = false;
  if (message_ == missing_ && cannot_drive().empty()) say(false, "");
}

std::string Pilot::hint() const {
  if (std::string why = cannot_drive(); !why.empty()) return why;
  if (driving_) return "driving";
  if (blocked_) return "let go, then hold a key or the dead man's button again";
  if (walking()) return "walking; hold a key to drive";
  return text(status_, "mode") == "stand"
             ? std::string("hold a key to walk: the gait mode will be ") + kWalkMode
             : "hold a key to walk";
}

void Pilot::say(bool bad, const std::string& text) {
  bad_ = bad;
  message_ = text;
}

void Pilot::block(milliseconds quiet) {
  blocked_ = true;
  quiet_ = quiet;
  driving_ = false;
}

void Pilot::let_go() { block({}); }

Request Pilot::drive(const Speed& speed, bool renew) {
  ++in_flight_;
  return {"drive",
          {{"forward", rounded(speed.forward)},
           {"lateral", rounded(speed.lateral)},
           {"turn", rounded(speed.turn)},
           {"session", session_},
           {"renew", renew}}};
}

std::vector<Request> Pilot::act(const Speed& speed, bool held, Time now) {
  if (!held) {
    mode_asked_ = false;
    if (blocked_ && now - held_ >= quiet_) blocked_ = false;
    return finish();
  }
  held_ = now;
  if (blocked_) return {};
  if (const std::string why = cannot_drive(); !why.empty()) {
    const bool drove = driving_;
    block({});
    say(true, missing_ = why);
    return drove ? std::vector{end()} : std::vector<Request>{};
  }
  if (text(status_, "mode") == "stand" && !mode_set_) {
    if (mode_asked_) return {};
    mode_asked_ = true;
    return {{"mode", {{"mode", kWalkMode}}}};
  }
  if (in_flight_ >= kMostInFlight || now - sent_ < kRenewal) return {};
  sent_ = now;
  const bool renew = driving_;
  driving_ = true;
  return {drive(speed, renew)};
}

Request Pilot::end() {
  ++in_flight_;
  return {"drive", {{"session", session_}, {"end", true}}};
}

std::vector<Request> Pilot::finish() {
  if (!driving_) return {};
  driving_ = false;
  return {end()};
}

std::vector<Request> Pilot::press(Key key, bool estop_open) {
  switch (key) {
    case Key::kStop:
      let_go();
      return {{"stop"}};
    case Key::kArm:
      return {{"arm"}};
    case Key::kReset:
      // One that overtook the e-stop would be refused, one behind it would undo it unseen.
      if (estop_open) return {};
      return {{"reset"}};
    default:
      return {};
  }
}

void Pilot::refused(const std::string& method, const daemon::RpcError& error) {
  const std::string message = message_for("", method, error.message);
  if (method != "drive") {
    if (method == "mode") block({});
    return say(true, method + ": " + message);
  }
  if (!driving_) return;  // he has let go, or knows it already
  const std::string reason = text(error.data, "reason");
  if (reason.empty() || !cannot_drive().empty()) {
    block({});
    return say(true, message);
  }
  const bool late = reason == "not_renewed";
  block(late ? milliseconds(0) : kHandOver);
  say(true, late ? "the connection is slow: the velocity was not renewed in time, and the robot "
                   "stopped"
                 : "another program or command has taken the robot over; to take it back let go "
                   "for a second, then hold a key");
}

void Pilot::take_answer(const std::string& method, const daemon::RpcResult& result) {
  if (method == "drive") --in_flight_;
  if (const auto* error = std::get_if<daemon::RpcError>(&result)) return refused(method, *error);
  const std::string note = text(std::get<json>(result), "note");
  if (method == "drive") {
    mode_set_ = false;
    if (driving_) say(false, note);
  } else if (method == "mode") {
    mode_set_ = true;
    say(false, std::string("the gait mode is ") + kWalkMode + " now");
  } else {
    say(false, method + (note.empty() ? ": done" : ": " + note));
  }
}

void Pilot::lose_connection(const std::string& why) {
  block({});
  lost_ = true;
  in_flight_ = 0;
  mode_asked_ = mode_set_ = false;
  status_ = nullptr;
  say(true, why);
}

}  // namespace gaitd::cli::teleop
