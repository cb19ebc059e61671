// SPDX-License-Identifier: Apache-2.0
#include "control.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "clock.h"

namespace gaitd::unitree {
namespace {

constexpr double kCallTime = 5;     // s, as the maker's examples wait
constexpr double kPatience = 5;     // s beyond `listen` for others to fall silent
constexpr int64_t kRelease = 15e9;  // ns for all attempts
constexpr dds_duration_t kPause = DDS_MSECS(10);
constexpr dds_duration_t kBetween = DDS_MSECS(500);

}  // namespace

ControlHandover::ControlHandover(const Settings& settings, DdsNode* node,
                                 std::function<int()> foreign, std::function<void()> damp,
                                 const std::atomic<bool>& stop)
    : settings_(settings), foreign_(std::move(foreign)), damp_(std::move(damp)), stop_(stop) {
  if (settings.control == Control::kRelease) {
    switcher_ = std::make_unique<Service>(node, "motion_switcher");
  } else if (settings.control == Control::kUser) {
    sport_ = std::make_unique<Service>(node, "sport");
  }
}

const char* ControlHandover::topic(Control control) {
  return control == Control::kUser ? kUserLowCmd : kLowCmd;
}

// Whether a program that was stopped still says that it is there tells nothing: only that nobody
// sends does.
std::string ControlHandover::wait_for_silence() {
  const auto quiet = static_cast<int64_t>(1e9 * settings_.listen);
  const int64_t end = monotonic_ns() + quiet + static_cast<int64_t>(1e9 * kPatience);
  int64_t since = monotonic_ns();
  while (!stop_) {
    const int64_t now = monotonic_ns();
    if (foreign_() > 0) since = now;
    if (now - since >= quiet) return "";
    if (now >= end) {
      return std::string("somebody else commands the robot on ") + topic(settings_.control) +
             ": stop the built-in walking (hold L2 and press R2 in damping mode until the LED is "
             "yellow, or unitree_dds.control: release), and every other program";
    }
    dds_sleepfor(kPause);
  }
  return "stopped";
}

std::string ControlHandover::release() {
  const int64_t end = monotonic_ns() + kRelease;
  for (;;) {
    const Service::Answer mode = switcher_->call(api::kCheckMode, "{}", kCallTime);
    if (mode.code != 0) return "motion_switcher, CheckMode: " + service_error(mode.code);
    const nlohmann::json data = nlohmann::json::parse(mode.data, nullptr, false);
    const std::string name = data.is_object() && data.contains("name") && data["name"].is_string()
                                 ? data["name"].get<std::string>()
                                 : "";
    if (name.empty()) return "";
    former_ = name;
    const Service::Answer released = switcher_->call(api::kReleaseMode, "{}", kCallTime);
    constexpr int kBusy = 7002;
    if (released.code != 0 && released.code != kBusy) {
      return "motion_switcher, ReleaseMode: " + service_error(released.code);
    }
    if (stop_ || monotonic_ns() > end) {
      return "motion_switcher: mode '" + name + "' is still there after ReleaseMode";
    }
    dds_sleepfor(kBetween);
  }
}

std::string ControlHandover::take() {
  if (settings_.control == Control::kRelease) {
    const std::string error = release();
    if (!error.empty()) return error;
  }
  std::string error = wait_for_silence();
  if (!error.empty() || settings_.control != Control::kUser) return error;
  damp_();  // it has to know what to do before it is asked to listen
  const Service::Answer answer = sport_->call(api::kToUser, "{}", kCallTime);
  user_ = answer.code == 0;
  return user_ ? ""
               : "sport, SwitchToUserCtrl: " + service_error(answer.code) +
                     "; it starts from damping mode alone (L2+B)";
}

std::string ControlHandover::give_back() {
  if (std::exchange(user_, false)) {
    const int mode = settings_.give_back ? api::kInternalLast : api::kInternalPassive;
    const Service::Answer answer =
        sport_->call(api::kToInternal, nlohmann::json({{"data", mode}}).dump(), kCallTime);
    return answer.code == 0 ? "" : "sport, SwitchToInternalCtrl: " + service_error(answer.code);
  }
  if (!settings_.give_back || former_.empty()) return "";
  const Service::Answer answer =
      switcher_->call(api::kSelectMode, nlohmann::json({{"name", former_}}).dump(), kCallTime);
  return answer.code == 0 ? "" : "motion_switcher, SelectMode: " + service_error(answer.code);
}

}  // namespace gaitd::unitree
