// SPDX-License-Identifier: Apache-2.0
#include "cli/joint_commands.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>

#include "cli/ask.h"
#include "cli/completion_values.h"
#include "cli/failure.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "cli/table.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;

struct JointArguments {
  std::string joint;
  double amplitude = 0.05;  // rad
  double duration = 2.0;    // s
};

std::string number(const json& value) {
  if (!value.is_number()) return "-";
  char text[32];
  std::snprintf(text, sizeof(text), "%9.4f", value.get<double>());
  return text;
}

struct Refused {
  std::string method;
  daemon::RpcError error;
};

json call(RpcClient* client, const std::string& method, const json& params) {
  daemon::RpcResult result = client->call(method, params);
  if (auto* error = std::get_if<daemon::RpcError>(&result)) throw Refused{method, *error};
  return std::get<json>(std::move(result));
}

// What a command does, with the error of gaitd that ended it.
template <class Action>
int run(const Context& context, const std::string& command, const Action& action) {
  try {
    return action();
  } catch (const Refused& refused) {
    return fail(context, command, refused.method, refused.error);
  }
}

json find_joint(RpcClient* client, const std::string& name) {
  const json answer = call(client, "joint.list", nullptr);
  for (const json& joint : answer.value("joints", json::array())) {
    if (joint.value("name", "") == name) return joint;
  }
  return nullptr;
}

int list(const Context& context) {
  const auto client = connect(context, "joint list", daemon::Role::kObserve);
  if (!client) return kNoDaemon;
  const json answer = call(client.get(), "joint.list", nullptr);
  if (context.json) {
    std::cout << json_text(answer);
    return kDone;
  }
  std::vector<std::vector<std::string>> rows;
  for (const json& joint : answer.value("joints", json::array())) {
    rows.push_back({joint.value("name", ""), number(joint["position"]),
                    number(joint["position_min"]), number(joint["position_max"]),
                    number(joint["torque"])});
  }
  std::cout << table({"joint", "position", "min", "max rad", "torque N m"}, rows);
  return kDone;
}

// Watches the joint until the test is over: how far it went, and with which torque.
int test(const Context& context, const JointArguments& arguments) {
  using std::chrono::milliseconds;
  const std::string command = "joint test";
  const auto client = connect(context, command, daemon::Role::kAdminister);
  if (!client) return kNoDaemon;
  const json before = find_joint(client.get(), arguments.joint);
  call(client.get(), "joint.test",
       {{"joint", arguments.joint},
        {"amplitude", arguments.amplitude},
        {"duration", arguments.duration}});
  const double start = before.value("position", 0.0);
  double farthest = 0.0;
  double torque = 0.0;
  std::string state;
  std::optional<Waiting> waiting("joint test " + arguments.joint);
  do {
    std::this_thread::sleep_for(milliseconds(10));
    const json joint = find_joint(client.get(), arguments.joint);
    if (!joint.is_object() || !joint["position"].is_number()) break;
    const double moved = joint.value("position", start) - start;
    if (std::abs(moved) > std::abs(farthest)) farthest = moved;
    torque = std::max(torque, std::abs(joint.value("torque", 0.0)));
    state = call(client.get(), "status", nullptr).value("state", "");
  } while (state == "testing");
  waiting.reset();
  const double share = farthest / arguments.amplitude;
  const bool passed = state == "disarmed" && share > 0.5 && share < 1.5;
  const json result = {{"joint", arguments.joint}, {"amplitude", arguments.amplitude},
                       {"moved", farthest},        {"torque", torque},
                       {"state", state},           {"passed", passed}};
  if (context.json) {
    std::cout << json_text(result);
  } else {
    std::printf("%s: told to move by %.4f rad, moved by %.4f rad with up to %.1f N m: %s\n",
                arguments.joint.c_str(), arguments.amplitude, farthest, torque,
                passed ? "passed; did it move in its positive direction?"
                       : ("failed, state " + state).c_str());
  }
  return passed ? kDone : kFailed;
}

}  // namespace

void add_joint_commands(CLI::App* app, Context* context) {
  auto* joint = app->add_subcommand("joint", "Look at joints and try one, for the bring-up");
  joint->require_subcommand(1);
  auto* show = joint->add_subcommand("list", "Every joint: position, limits, torque");
  show->callback([context] {
    context->action = [context] {
      return run(*context, "joint list", [context] { return list(*context); });
    };
  });

  auto* command = joint->add_subcommand(
      "test", "Move one joint a little and back, the others off; the robot hangs, disarmed");
  auto arguments = std::make_shared<JointArguments>();
  const auto* name =
      command->add_option("NAME", arguments->joint, "Joint of the robot")->required();
  context->values[name] = [](const auto&) { return joint_names(); };
  command->add_option("--amplitude", arguments->amplitude, "How far, rad; negative: the other way")
      ->check(CLI::Range(-0.3, 0.3))
      ->capture_default_str();
  command->add_option("--duration", arguments->duration, "There and back, s")
      ->check(CLI::Range(0.5, 20.0))
      ->capture_default_str();
  command->callback([context, arguments] {
    context->action = [context, arguments] {
      return run(*context, "joint test", [&] { return test(*context, *arguments); });
    };
  });
}

}  // namespace gaitd::cli
