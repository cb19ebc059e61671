// SPDX-License-Identifier: Apache-2.0
// The part of the control loop that acts on a simulated robot: pushes, loads, back to the start.
#include <cstdio>
#include <string>

#include "daemon/control/command_text.h"
#include "daemon/control/control_loop.h"

namespace gaitd::daemon {

// Of the scenario: one that is not made would pass for one that was withstood.
void ControlLoop::push_robot(const GaitdDisturbance& push) {
  const char* why = backend_.push(push);
  if (why == nullptr) return tell_push(push);
  end(RunEnd::kPush,
      std::string("the push on ") + model_.bodies[push.body].name + " was not made: " + why);
}

// For whoever looks at the log: what came from the simulation's side.
void ControlLoop::tell_push(const GaitdDisturbance& push) {
  char text[kMaxEventText];
  telemetry_->push_event(EventKind::kNote, tick_, static_cast<double>(tick_) * options_.period,
                         push_text(push, model_.bodies[push.body].name, text, sizeof(text)));
}

void ControlLoop::tell_load(const char* what, const GaitdLoad& load) {
  char text[kMaxEventText];
  telemetry_->push_event(EventKind::kNote, tick_, static_cast<double>(tick_) * options_.period,
                         load_text(what, load, model_.bodies[load.body].name, text, sizeof(text)));
}

CommandReply ControlLoop::simulate(const Command& command) {
  CommandReply reply;
  reply.request = command.request;
  reply.tick = tick_;
  if (command.type == CommandType::kPush || command.type == CommandType::kSimLoad) {
    const bool push = command.type == CommandType::kPush;
    const char* why = push ? backend_.push(command.push) : backend_.load(command.load);
    reply.accepted = why == nullptr;
    if (why != nullptr) {
      std::snprintf(reply.message.data(), reply.message.size(), "sim %s: %s",
                    push ? "push" : "load", why);
    } else if (push) {
      tell_push(command.push);
    } else {
      tell_load("load", command.load);
    }
  } else if (!backend_.reset()) {
    std::snprintf(reply.message.data(), reply.message.size(), "%s",
                  (std::string("sim reset: ") + kNoSimulation).c_str());
  } else {
    pipeline_->reset(options_.arm);
    sight_.restart();
    reply.accepted = true;
  }
  return reply;
}

}  // namespace gaitd::daemon
