// SPDX-License-Identifier: Apache-2.0
#include "cli/calibrate/live_motions.h"

#include <unistd.h>

#include <chrono>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli/ask.h"
#include "cli/calibrate/motions.h"
#include "cli/failure.h"
#include "cli/private_directory.h"
#include "daemon/config/command_parse.h"
#include "daemon/config/paths.h"
#include "daemon/config/scenario.h"
#include "daemon/config/settings.h"
#include "daemon/log/log_reader.h"
#include "daemon/replay/robot_of_log.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;

constexpr const char* kCalibrate = "calibrate";
constexpr double kPatience = 60.0;    // s, for the robot to stand, or to be lowered
constexpr double kLastPosture = 3.0;  // s, that it is held
constexpr milliseconds kPoll(20);

json status(RpcClient* client) {
  const daemon::RpcResult result = client->call("status", nullptr);
  const json* value = std::get_if<json>(&result);
  return value != nullptr ? *value : json::object();
}

// The state that the command leads to; empty: none is waited for.
std::string state_after(const std::string& method) {
  if (method == "joint.test") return "disarmed";
  if (method == "arm" || method == "abort" || method == "stop") return "standing";
  return "";
}

// The short forms of scenarios (`arm: true`, `mode: walk-bent`) as params of a request.
json params_of(const daemon::ScenarioCommand& command) {
  if (command.params.is_boolean()) return nullptr;
  if (command.params.is_string()) return {{command.method, command.params}};
  if (command.params.is_array()) return {{"footsteps", command.params}};
  return command.params;
}

// s, of the robot: a simulation may be faster or slower than the clock.
double time_of(const json& status) {
  const auto time = status.find("time");
  return time != status.end() && time->is_number() ? time->get<double>() : 0.0;
}

// False: its time stands still.
bool wait_until(RpcClient* client, double time) {
  using Clock = std::chrono::steady_clock;
  double now = time_of(status(client));
  auto moved = Clock::now();
  while (now < time) {
    std::this_thread::sleep_for(kPoll);
    const double next = time_of(status(client));
    if (next > now) moved = Clock::now();
    if (Clock::now() - moved > std::chrono::duration<double>(kPatience)) return false;
    now = next;
  }
  return true;
}

// The log that gaitd writes now: full ones go on in another file.
void note_log(const json& status, std::vector<std::string>* logs) {
  const json log = status.value("log", json::object());
  if (!log.is_object() || log.value("file", "").empty()) return;
  const std::string file = log["file"];
  if (logs->empty() || logs->back() != file) logs->push_back(file);
}

bool wait_for(RpcClient* client, const std::string& state, std::string* got) {
  const std::chrono::duration<double> patience(kPatience);
  auto deadline = std::chrono::steady_clock::now() + patience;
  do {
    std::this_thread::sleep_for(kPoll);
    *got = status(client).value("state", "");
    if (*got == state) return true;
    // On its hoist it waits until somebody lowers it.
    if (*got == "readying") deadline = std::chrono::steady_clock::now() + patience;
  } while (*got != "fault" && std::chrono::steady_clock::now() < deadline);
  return false;
}

std::optional<daemon::Scenario> read(const std::string& file, std::string* error) {
  daemon::Issues issues;
  daemon::Settings settings;
  auto scenario = daemon::load_scenario(file, &settings, &issues);
  if (!scenario) *error = issues.error_text();
  return scenario;
}

// The motions that were asked for; by default those for the robot that writes `log`.
std::optional<daemon::Scenario> motions_for(const std::string& name, const std::string& log,
                                            std::string* error) {
  if (!name.empty()) {
    const auto file = daemon::Paths::detect().scenario(name);
    if (file) return read(file->string(), error);
    *error = name + ": no such scenario";
    return std::nullopt;
  }
  const auto reader = daemon::LogReader::open(log, error);
  if (!reader) return std::nullopt;
  const auto robot = daemon::robot_of_log(*reader, nullptr, error);
  if (!robot) return std::nullopt;
  const PrivateDirectory directory;
  const std::string file = directory.path() + "/calibration.yaml";
  std::ofstream(file) << calibrate::motions_yaml(robot->model, robot->model.name);
  return read(file, error);
}

// Somebody lowers the hoist, and says when that is done, if anyone can be asked.
void wait_for_ground() {
  if (isatty(STDIN_FILENO) == 0) return;
  std::cerr << "press Enter when it stands on its own: ";
  std::string line;
  std::getline(std::cin, line);
}

}  // namespace

int play_live(const Context& context, const std::string& name, std::vector<std::string>* logs) {
  const auto client = connect(context, kCalibrate, daemon::Role::kAdminister);
  if (!client) return kNoDaemon;
  const json before = status(client.get());
  const json written = before.value("log", json::object());
  if (!written.is_object() || !written.value("open", false)) {
    return fail(context, kFailed, kCalibrate,
                "gaitd writes no log, and what it shows there is what is measured; start it with "
                "`log`, see docs/configuration.md");
  }
  const std::string log = written.value("file", "");
  if (!std::ifstream(log)) {
    return fail(
        context, kFailed, kCalibrate,
        log +
            ": gaitd writes this log, and it cannot be read from here; run this where gaitd "
            "was started, and as a user who may read its logs");
  }
  if (before.value("state", "") != "disarmed") {
    return fail(context, kFailed, kCalibrate,
                "expected a disarmed robot on its hoist, got one that is " +
                    before.value("state", "") + "; `gaitctl disarm` first");
  }
  std::string error;
  const auto scenario = motions_for(name, log, &error);
  if (!scenario) return fail(context, kFailed, kCalibrate, error);
  note_log(before, logs);
  const std::string mode(daemon::mode_name(scenario->mode));
  const daemon::RpcResult chosen = client->call("mode", {{"mode", mode}});
  if (const auto* refused = std::get_if<daemon::RpcError>(&chosen)) {
    return fail(context, kCalibrate, "mode", *refused);
  }
  double due = time_of(before);
  double last = scenario->commands.empty() ? 0.0 : scenario->commands.front().at;
  for (const daemon::ScenarioCommand& command : scenario->commands) {
    due += command.at - last;
    last = command.at;
    if (!wait_until(client.get(), due)) {
      return fail(context, kFailed, kCalibrate, "gaitd does not go on; see `gaitctl status`");
    }
    const bool arms = command.method == "arm";
    if (arms) {
      std::cerr
          << "arming; lower the hoist until both feet carry the robot and the rope is slack\n";
    }
    const daemon::RpcResult result = client->call(command.method, params_of(command));
    if (const auto* refused = std::get_if<daemon::RpcError>(&result)) {
      return fail(context, kCalibrate, command.method, *refused);
    }
    const std::string wanted = state_after(command.method);
    std::string got;
    if (!wanted.empty() && !wait_for(client.get(), wanted, &got)) {
      std::string text = command.method;
      text += ": expected the robot to be ";
      text += wanted;
      text += " after it, got ";
      text += got;
      text += "; see `gaitctl status`";
      return fail(context, kFailed, kCalibrate, text);
    }
    if (arms) wait_for_ground();
    const json now = status(client.get());
    note_log(now, logs);
    due = std::max(due, time_of(now));
  }
  wait_until(client.get(), due + kLastPosture);
  std::this_thread::sleep_for(std::chrono::seconds(2));  // until it is in the log
  note_log(status(client.get()), logs);
  return kDone;
}

}  // namespace gaitd::cli
