// SPDX-License-Identifier: Apache-2.0
#include "ros2/velocity_drive.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gaitd::ros2 {
namespace {

using nlohmann::json;

constexpr double kMost = 3.0;  // m/s and rad/s, that `drive` takes; the robot walks slower

double within_range(double value) { return std::clamp(value, -kMost, kMost); }

std::string text_of(const json& answer, const char* part, const char* member) {
  const json object = answer.is_object() ? answer.value(part, json()) : json();
  const json text = object.is_object() ? object.value(member, json()) : json();
  return text.is_string() ? text.get<std::string>() : "";
}

}  // namespace

void VelocityDrive::on_velocity(const Velocity& velocity, Time now) {
  if (!std::isfinite(velocity.forward) || !std::isfinite(velocity.lateral) ||
      !std::isfinite(velocity.turn)) {
    ++refused_messages_;
    trouble_ = "a velocity was refused: it is no finite number";
    return;
  }
  newest_ = {within_range(velocity.forward), within_range(velocity.lateral),
             within_range(velocity.turn)};
  newest_at_ = now;
  tick(now);
}

void VelocityDrive::set_robot(const std::string& state, const std::string& mode) {
  state_ = state;
  mode_ = mode;
}

void VelocityDrive::hold(const std::string& reason) {
  driving_ = false;
  held_ = true;
  trouble_ = reason;
}

bool VelocityDrive::on_feet() const {
  return state_ == "standing" || state_ == "walking" || state_ == "stopping";
}

void VelocityDrive::tick(Time now) {
  if (asked_at_ && now - *asked_at_ > kAnswer) {
    asked_at_.reset();
    ++number_;
    hold("gaitd does not answer");
  }
  if (!fresh(now) || newest_.zero()) return let_go(now);
  if (held_) return;
  if (driving_) return renew(now);
  if (!retry_at_ || now >= *retry_at_) begin(now);
}

// Nobody asks for a velocity any more.
void VelocityDrive::let_go(Time now) {
  if (driving_) {
    if (asked_at_) return;  // behind the answer to the last one
    driving_ = false;
    ask({{"session", options_.session}, {"end", true}}, true, now);
  }
  if (!newest_at_ || !fresh(now)) trouble_.clear();
  held_ = false;
  retry_at_.reset();
}

void VelocityDrive::begin(Time now) {
  if (asked_at_) return;
  retry_at_ = now + kRetry;
  if (state_.empty()) {
    trouble_ = "gaitd has not told yet what the robot does";
    return;
  }
  if (!on_feet()) return hold("the robot is not on its feet under control: " + state_);
  if (mode_ == "stand" && options_.auto_mode) return set_mode(now);
  driving_ = true;
  ask(params(false), false, now);
}

void VelocityDrive::renew(Time now) {
  if (asked_at_ || now - last_request_ < kRenewal) return;
  ask(params(true), true, now);
}

void VelocityDrive::set_mode(Time now) {
  const std::uint64_t number = ++number_;
  asked_at_ = now;
  send_("mode", {{"mode", "walk-straight"}}, [this, number](const json& answer) {
    if (number != number_) return;
    asked_at_.reset();
    if (!answer.contains("result")) return hold(text_of(answer, "error", "message"));
    mode_ = "walk-straight";
    retry_at_.reset();
  });
}

json VelocityDrive::params(bool renewal) const {
  return {{"forward", newest_.forward},
          {"lateral", newest_.lateral},
          {"turn", newest_.turn},
          {"session", options_.session},
          {"renew", renewal}};
}

void VelocityDrive::ask(const json& params, bool renewal, Time now) {
  const std::uint64_t number = ++number_;
  last_request_ = asked_at_.emplace(now);
  send_("drive", params, [this, number, renewal](const json& answer) {
    if (number != number_) return;  // of a request that was given up
    asked_at_.reset();
    on_answer(answer, renewal);
  });
}

void VelocityDrive::on_answer(const json& answer, bool renewal) {
  if (answer.contains("result")) {
    if (driving_) trouble_ = text_of(answer, "result", "note");
    return;
  }
  const bool was_driving = std::exchange(driving_, false);
  if (!was_driving && renewal) return;  // the end: it stands anyway
  trouble_ = text_of(answer, "error", "message");
  if (trouble_.empty()) trouble_ = "gaitd refused without a reason";
  // What could not be begun is tried again; what was taken away is not taken back.
  held_ = renewal;
}

}  // namespace gaitd::ros2
