// SPDX-License-Identifier: Apache-2.0
#include "daemon/server/command_bridge.h"

#include <cstring>
#include <utility>
#include <vector>

namespace gaitd::daemon {
namespace {

std::string text_of(const CommandReply& reply) {
  const char* text = reply.message.data();
  return {text, strnlen(text, reply.message.size())};
}

// `data.reason` of a refusal; null if it has none.
const char* reason_name(walking::RefusalReason reason) {
  switch (reason) {
    case walking::RefusalReason::kNotRenewed:
      return "not_renewed";
    case walking::RefusalReason::kTakenOver:
      return "taken_over";
    case walking::RefusalReason::kEnded:
      return "ended";
    default:
      return nullptr;
  }
}

}  // namespace

CommandBridge::CommandBridge(Clock::duration timeout) : timeout_(timeout) {
  // Through every slot once, so that the control thread never meets a page for the first time.
  Command command{};
  CommandReply reply{};
  for (std::size_t i = 0; i <= 4 * kCapacity; ++i) {
    commands_.push(command);
    commands_.pop(command);
    replies_.push(reply);
    replies_.pop(reply);
  }
}

void CommandBridge::submit(Command command, const Caller& caller, Respond respond) {
  if (!queue_.has_room(caller.connection)) {
    respond(RpcError{rpc_code::kBusy, "busy: " + std::to_string(kShare) +
                                          " commands of this connection wait for the control "
                                          "thread already; send fewer at a time"});
    return;
  }
  command.estops = caller.estops;
  queue_.push(caller.connection, {std::make_unique<Command>(command), std::move(respond)});
  feed(Clock::now());
}

// Into the ring, as many as the control thread may find there at once.
void CommandBridge::feed(Clock::time_point now) {
  while (commands_.write_available() > kCapacity - kPerTick) {
    auto next = queue_.pop();
    if (!next) return;
    Waiting& waiting = next->second;
    waiting.command->request = next_request_;
    commands_.push(*waiting.command);
    pending_[next_request_++] = {std::move(waiting.respond), now + timeout_};
  }
}

std::uint64_t CommandBridge::open(Respond respond) {
  open_[next_request_] = std::move(respond);
  return next_request_++;
}

void CommandBridge::answer(std::uint64_t request, RpcResult result) {
  const std::scoped_lock lock(answers_mutex_);
  answers_.emplace_back(request, std::move(result));
}

void CommandBridge::release_answers() {
  std::vector<std::pair<std::uint64_t, RpcResult>> answers;
  {
    const std::scoped_lock lock(answers_mutex_);
    answers.swap(answers_);
  }
  for (auto& [request, result] : answers) {
    const auto entry = open_.extract(request);
    if (!entry.empty()) entry.mapped()(std::move(result));
  }
}

void CommandBridge::poll(Clock::time_point now) {
  // A responder may submit again: take the entry out first.
  CommandReply reply;
  while (replies_.pop(reply)) {
    auto entry = pending_.extract(reply.request);
    if (entry.empty()) continue;  // timed out before
    if (reply.accepted) {
      held_.push_back({std::move(entry.mapped().respond), reply, now + kShowTime});
      continue;
    }
    std::string message = text_of(reply);
    if (message.empty()) message = "refused without a reason";
    nlohmann::json data = {{"tick", reply.tick}};
    if (const char* reason = reason_name(reply.reason)) data["reason"] = reason;
    entry.mapped().respond(RpcError{rpc_code::kRefused, message, std::move(data)});
  }
  release_held(now);
  release_answers();
  feed(now);
  std::vector<Respond> late;
  while (!pending_.empty() && pending_.begin()->second.deadline <= now) {
    late.push_back(std::move(pending_.begin()->second.respond));
    pending_.erase(pending_.begin());
  }
  // It takes nothing any more: those that wait for their turn need not wait for theirs.
  if (!late.empty() && commands_.write_available() <= kCapacity - kPerTick) {
    for (Waiting& one : queue_.clear()) late.push_back(std::move(one.respond));
  }
  for (const Respond& respond : late) {
    const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(timeout_).count();
    respond(RpcError{rpc_code::kNoAnswer,
                     "the control thread did not answer within " + std::to_string(ms) +
                         " ms; the command may still take effect, check `gaitctl status`"});
  }
}

void CommandBridge::release_held(Clock::time_point now) {
  while (!held_.empty()) {
    const Held& first = held_.front();
    if (newest_tick_ && newest_tick_() < first.reply.tick && now < first.deadline) return;
    const Held held = std::move(held_.front());
    held_.pop_front();
    const std::string note = text_of(held.reply);
    nlohmann::json result = {{"accepted", true},
                             {"tick", held.reply.tick},
                             {"note", note.empty() ? nlohmann::json() : nlohmann::json(note)}};
    if (held.reply.changed_value) {
      result["old"] = held.reply.old_value;
      result["value"] = held.reply.new_value;
    }
    held.respond(std::move(result));
  }
}

void CommandBridge::abandon() {
  newest_tick_ = nullptr;
  release_held(Clock::now());
  release_answers();
  for (auto& [request, respond] : std::exchange(open_, {})) {
    respond(RpcError{rpc_code::kStopping, "gaitd is stopping; the swap may not have been done"});
  }
  for (const Waiting& one : queue_.clear()) {
    one.respond(
        RpcError{rpc_code::kStopping, "gaitd is stopping; the command was not carried out"});
  }
  auto pending = std::exchange(pending_, {});
  for (auto& [request, entry] : pending) {
    entry.respond(RpcError{rpc_code::kStopping,
                           "gaitd is stopping; the command may not have been "
                           "carried out"});
  }
}

void add_command_methods(Methods* methods, CommandBridge* bridge, CommandParser parser) {
  for (const char* name : {"arm",
                           "disarm",
                           "reset",
                           "mode",
                           "walk",
                           "drive",
                           "footsteps",
                           "goto",
                           "pause",
                           "resume",
                           "stop",
                           "abort",
                           "pose",
                           "tare",
                           "payload.set",
                           "payload.clear",
                           "payload.estimate",
                           "handhold.take",
                           "handhold.release",
                           "sim.push",
                           "sim.load",
                           "sim.reset",
                           "joint.test"}) {
    methods->add_async(
        name, [bridge, parser, method = std::string(name)](const nlohmann::json& params,
                                                           const Caller& caller, Respond respond) {
          auto parsed = parser(method, params);
          if (auto* error = std::get_if<RpcError>(&parsed)) return respond(std::move(*error));
          bridge->submit(std::get<Command>(parsed), caller, std::move(respond));
        });
  }
}

}  // namespace gaitd::daemon
