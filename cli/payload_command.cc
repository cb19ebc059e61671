// SPDX-License-Identifier: Apache-2.0
#include "cli/payload_command.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli/ask.h"
#include "cli/failure.h"
#include "cli/link_options.h"
#include "cli/print.h"
#include "cli/status_view.h"
#include "cli/stop_signals.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kLongest{30};  // until the daemon gives up by itself
constexpr const char* kEstimate = "payload estimate";

// What became of the estimate that tick `since` began; null: not known in time, or interrupted.
json await_outcome(RpcClient* client, std::int64_t since) {
  for (const auto end = Clock::now() + kLongest; Clock::now() < end && !StopSignals::requested();) {
    const daemon::RpcResult result = client->call("status", nullptr, std::chrono::seconds(2));
    const json* status = std::get_if<json>(&result);
    if (status == nullptr || !status->is_object()) return nullptr;
    const json tick = status->value("tick", json());
    const json payload = status->value("payload", json());
    const bool begun = tick.is_number() && tick.get<std::int64_t>() > since;
    if (begun && payload.is_object() && payload.value("estimating", json()) == false) {
      return payload;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return nullptr;
}

int estimate(const Context& context, const json& params) {
  auto client = connect(context, kEstimate, daemon::Role::kCommand);
  if (!client) return kNoDaemon;
  const daemon::RpcResult result = client->call("payload.estimate", params);
  if (const auto* error = std::get_if<daemon::RpcError>(&result)) {
    return fail(context, kEstimate, "payload.estimate", *error);
  }
  const json outcome =
      await_outcome(client.get(), std::get<json>(result).value("tick", std::int64_t{0}));
  if (StopSignals::requested()) return kInterrupted;
  if (!outcome.is_object()) {
    return fail(context, kFailed, kEstimate,
                "gaitd did not say what it weighed; see gaitctl status");
  }
  const json word = outcome.value("outcome", json());
  if (word != "found" && word != "nothing") {
    return fail(context, kFailed, kEstimate, outcome.value("what", "not weighed"));
  }
  std::cout << (context.json ? json_text(outcome) : payload_text(outcome) + "\n") << std::flush;
  return kDone;
}

}  // namespace

void add_payload_command(CLI::App* app, Context* context) {
  auto* payload = app->add_subcommand("payload", "What the robot carries");
  payload->require_subcommand(1);
  const auto add = [&](const char* name, const char* description) {
    return payload->add_subcommand(name, description);
  };

  auto* weigh = add("estimate", "Weigh what a link carries, while the robot stands: four seconds");
  auto where = std::make_shared<json>(json::object());
  add_link(weigh, context, where, "Link that carries it; the chest if left out");
  weigh->callback([context, where] {
    context->action = [context, where] { return estimate(*context, *where); };
  });

  auto* set = add("set", "Say what a link carries");
  auto load = std::make_shared<json>(json::object());
  add_load(set, context, load);
  set->callback([context, load] {
    context->action = [context, load] {
      return ask(*context, "payload set", "payload.set", *load);
    };
  });

  auto* clear = add("clear", "Nothing is carried any more");
  auto which = std::make_shared<json>(json::object());
  add_link(clear, context, which, "Only by this link; by all of them if left out");
  clear->callback([context, which] {
    context->action = [context, which] {
      return ask(*context, "payload clear", "payload.clear", *which);
    };
  });
}

}  // namespace gaitd::cli
