// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/control_loop.h"

#include <time.h>

#include <cmath>
#include <cstdio>
#include <utility>

#include "daemon/control/command_text.h"
#include "daemon/control/denormals.h"
#include "daemon/control/signals.h"
#include "daemon/control/stopwatch.h"
#include "daemon/control/tick_guard.h"
#include "gaitd/sdk/layer_names.h"

namespace gaitd::daemon {
namespace {

constexpr double kTellOverruns = 1.0;  // s between two events about overruns

std::int64_t now_ns() {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return std::int64_t{1000000000} * t.tv_sec + t.tv_nsec;
}

}  // namespace

ControlLoop::ControlLoop(const LoopOptions& options, const GaitdModel& model, Pipeline* pipeline,
                         const GaitdBackendInstance& backend, Telemetry* telemetry,
                         CommandBridge* bridge, ScenarioPlayer* scenario, SwapPort* swaps,
                         TickWatch* watch, EstopFlag* estop)
    : options_(options),
      model_(model),
      pipeline_(pipeline),
      backend_(backend),
      telemetry_(telemetry),
      bridge_(bridge),
      scenario_(scenario),
      swaps_(swaps),
      watch_(watch),
      estop_(estop),
      command_(std::make_unique<Command>()) {
  if (swaps_ != nullptr) swaps_->publish(pipeline_->swap_right());
}

LoopReport ControlLoop::run() {
  const FlushDenormals flush;
  const Stopwatch watch;
  next_wake_ns_ = now_ns();
  if (options_.arm) pipeline_->safety().arm();
  const bool lockstep = options_.clock == GAITD_CLOCK_LOCKSTEP;
  while (!stop_.load(std::memory_order_relaxed)) {
    if (lockstep) telemetry_->wait_for_space(64, &stop_);
    pulse_.beat();
    take_estop();
    take_commands();
    take_swaps();
    const Outcome outcome = tick();
    if (outcome == Outcome::kTicked) {
      ++tick_;
      ++report_.ticks;
      if (std::exchange(write_failed_, false)) raise(kFaultBackend, "backend");
      if (scenario_ != nullptr) {
        report_.end = scenario_->update(options_.period, pipeline_->data());
        if (report_.end != ScenarioPlayer::End::kRunning) break;
      }
      if (lockstep && backend_.vtable->advance(backend_.self) != GAITD_OK) {
        pipeline_->safety().raise(kFaultBackend);
        break;
      }
    } else if (outcome == Outcome::kNotReady) {
      ++report_.late_backend;
    } else if (lockstep) {
      break;  // a simulation that cannot be read will not mend
    }
    if (!lockstep) wait_for_next_period();
  }
  report_.wall_seconds = 1e-6 * watch.microseconds();
  return report_;
}

ControlLoop::Outcome ControlLoop::tick() {
  const TickGuard guard;
  const Stopwatch watch;
  TickData& data = pipeline_->data();
  const GaitdStatus read = backend_.vtable->read(backend_.self, &data.readings);
  if (read == GAITD_NOT_READY) return Outcome::kNotReady;
  if (read != GAITD_OK) {
    if ((pipeline_->safety().faults() & kFaultBackend) == 0) {
      raise(kFaultBackend, "backend");
      telemetry_->push_event(EventKind::kFault, tick_, tick_ * options_.period,
                             R"({"fault":"backend","what":"read failed"})");
    }
    return Outcome::kBackendFailed;
  }
  GaitdHealth health{};
  const auto get_health = backend_.vtable->health;
  const bool known = get_health != nullptr && get_health(backend_.self, &health) == GAITD_OK;
  data.health = known ? health.conditions : 0;
  pipeline_->run(tick_);
  const bool written = backend_.vtable->write(backend_.self, &data.commands) == GAITD_OK;
  data.times.total_us = watch.microseconds();
  watch_->add(tick_, data.times, pipeline_->layers().budgets());
  data.has_truth = backend_.vtable->truth != nullptr &&
                   backend_.vtable->truth(backend_.self, &data.truth) == GAITD_OK;
  record();
  report_changes();
  if (!written) write_failed_ = true;
  return Outcome::kTicked;
}

// Before everything else that is asked of the robot.
void ControlLoop::take_estop() {
  if (!estop_->take(tick_) || (pipeline_->safety().faults() & kFaultEstop) != 0) return;
  *command_ = Command{};
  command_->type = CommandType::kEstop;
  execute(*command_, false);
}

void ControlLoop::take_commands() {
  // Commands of a scenario wait until the robot stands.
  if (scenario_ != nullptr && pipeline_->safety().state() != SafetyState::kReadying) {
    const double time = static_cast<double>(tick_) * options_.period;
    while (const Command* command = scenario_->next_command(time)) execute(*command, false);
    while (const GaitdDisturbance* push = scenario_->next_disturbance(pipeline_->data())) {
      backend_.vtable->disturb(backend_.self, push);
    }
  }
  if (bridge_ == nullptr) return;
  for (std::size_t i = 0; i < CommandBridge::kPerTick && bridge_->try_pop(*command_); ++i) {
    execute(*command_, true);
  }
}

void ControlLoop::execute(const Command& command, bool from_client) {
  const bool simulation =
      command.type == CommandType::kPush || command.type == CommandType::kSimReset;
  const bool clears = command.type == CommandType::kReset || command.type == CommandType::kSimReset;
  const bool outdated = from_client && clears && command.estops < estop_->asked();
  CommandReply reply = outdated                             ? refuse_outdated(command)
                       : simulation                         ? simulate(command)
                       : command.type == CommandType::kSwap ? request_swap(command)
                                                            : pipeline_->execute(command);
  reply.tick = tick_;
  const double time = static_cast<double>(tick_) * options_.period;
  char text[kMaxEventText];
  int owner = -1;
  int place = -1;
  if (command.type == CommandType::kSetParameter) {
    const LiveParameters::Row& row = pipeline_->parameters().row(command.parameter_index);
    owner = row.owner;
    place = row.index;
    const std::string& key = row.key;
    telemetry_->push_event(reply.accepted ? EventKind::kParameter : EventKind::kCommand, tick_,
                           time, parameter_text(key.c_str(), command, reply, text, sizeof(text)));
  } else {
    telemetry_->push_event(EventKind::kCommand, tick_, time,
                           command_text(command, reply, text, sizeof(text)));
  }
  if (!outdated) telemetry_->push_input(tick_, time, command, owner, place);
  if (from_client) bridge_->push(reply);
}

// A reset that was on its way when somebody stopped the robot does not know of that stop.
CommandReply ControlLoop::refuse_outdated(const Command& command) {
  CommandReply reply;
  reply.request = command.request;
  std::snprintf(reply.message.data(), reply.message.size(),
                "an e-stop was asked for after this command; look why, then send it again");
  return reply;
}

// A fault that does not come from the data of a tick: an input of the next one.
void ControlLoop::raise(Fault fault, const char* name) {
  pipeline_->safety().raise(fault);
  char text[64];
  const int length = std::snprintf(text, sizeof(text), R"({"fault":"%s"})", name);
  telemetry_->push_event(EventKind::kDecision, tick_, static_cast<double>(tick_) * options_.period,
                         std::string_view(text, length));
}

CommandReply ControlLoop::simulate(const Command& command) {
  CommandReply reply;
  reply.request = command.request;
  reply.tick = tick_;
  auto refuse = [&reply](const char* why) {
    std::snprintf(reply.message.data(), reply.message.size(), "%s", why);
  };
  if (command.type == CommandType::kPush) {
    const auto disturb = backend_.vtable->disturb;
    if (disturb == nullptr) {
      refuse("sim push: this backend is no simulation; start gaitd with --backend simbody");
    } else if (disturb(backend_.self, &command.push) != GAITD_OK) {
      refuse("sim push: the simulation refused the force; look at link, figures and duration");
    } else {
      reply.accepted = true;
    }
  } else if (backend_.vtable->reset == nullptr ||
             backend_.vtable->reset(backend_.self) != GAITD_OK) {
    refuse("sim reset: this backend is no simulation; start gaitd with --backend simbody");
  } else {
    pipeline_->reset();
    reply.accepted = true;
  }
  return reply;
}

CommandReply ControlLoop::request_swap(const Command& command) {
  CommandReply reply;
  reply.request = command.request;
  reply.accepted = swaps_ != nullptr &&
                   swaps_->request({command.swap_layer, tick_,
                                    static_cast<double>(tick_) * options_.period, command.swap_to});
  if (!reply.accepted) {
    std::snprintf(reply.message.data(), reply.message.size(), "too many swaps at once");
  } else if (options_.clock == GAITD_CLOCK_LOCKSTEP) {
    ++swaps_awaited_;
  }
  return reply;
}

// Layers that were loaded begin their swap at this tick; what became of others is told. In lockstep
// simulated time stands still while a layer of the scenario is loaded, so that its tick is known.
void ControlLoop::take_swaps() {
  if (swaps_ == nullptr) return;
  swaps_->publish(pipeline_->swap_right());
  tell_swaps();
  SwapOrder order;
  do {
    while (swaps_->next_order(order)) {
      if (order.from_scenario && swaps_awaited_ > 0) --swaps_awaited_;
      if (order.layer >= 0) pipeline_->begin_swap(order);
      tell_swaps();  // after each: the journal of a layer holds what one makes
    }
    if (swaps_awaited_ == 0) break;
    const timespec pause{0, 200'000};
    nanosleep(&pause, nullptr);
  } while (!stop_.load(std::memory_order_relaxed));
  tell_swaps();
}

void ControlLoop::tell_swaps() {
  SwapReport report;
  while (pipeline_->take_swap_report(&report)) {
    report.tick = tick_;
    swaps_->report(report);
  }
}

void ControlLoop::record() {
  TickSlot* slot = telemetry_->begin_tick();
  const TickData& data = pipeline_->data();
  slot->tick = data.time.tick;
  slot->time = data.time.time;
  record_signals(model_, data, slot->values);
  *slot->sensors = data.readings;
  telemetry_->commit();
}

void ControlLoop::report_changes() {
  const TickData& d = pipeline_->data();
  if (d.safety == last_state_ && d.faults == last_faults_) return;
  last_state_ = d.safety;
  last_faults_ = d.faults;
  char text[kMaxEventText];
  int length = std::snprintf(text, sizeof(text), R"({"state":"%s","faults":[)",
                             kSafetyStateNames[static_cast<int>(d.safety)]);
  const char* comma = "";
  for (std::size_t i = 0; i < kFaultNames.size(); ++i) {
    if ((d.faults >> i & 1u) == 0) continue;
    length +=
        std::snprintf(text + length, sizeof(text) - length, "%s\"%s\"", comma, kFaultNames[i]);
    comma = ",";
  }
  length += std::snprintf(text + length, sizeof(text) - length, "]");
  const LayerChain::Failure& failure = pipeline_->layers().failure();
  if ((d.faults & (kFaultEstimator | kFaultLayer | kFaultSolver)) != 0 && failure.layer >= 0) {
    length += std::snprintf(text + length, sizeof(text) - length, R"(,"layer":"%s","what":"%s")",
                            sdk::kLayerNames[failure.layer].data(), failure.what);
  }
  if ((d.faults & kFaultCapture) != 0) {
    const CaptureCheck& capture = pipeline_->safety().capture();
    length += std::snprintf(text + length, sizeof(text) - length,
                            R"(,"what":"ICP %.2f m off the feet, beyond %.2f m")",
                            capture.distance(), capture.limit());
  }
  if ((d.faults & kFaultSensors) != 0) {
    const SensorMonitor::Suspect& suspect = pipeline_->monitor().suspect();
    length += std::snprintf(text + length, sizeof(text) - length,
                            R"(,"sensor":"%s","what":"%s for %.0f ms")", suspect.sensor,
                            name_of(suspect.suspicion), 1e3 * suspect.age);
  }
  length += std::snprintf(text + length, sizeof(text) - length, "}");
  telemetry_->push_event(d.safety == SafetyState::kFault ? EventKind::kFault : EventKind::kState,
                         d.time.tick, d.time.time, std::string_view(text, length));
}

void ControlLoop::tell_overrun() {
  const int late = watch_->overrun();
  const double time = static_cast<double>(tick_) * options_.period;
  if (time < next_told_) return;
  next_told_ = time + kTellOverruns;
  char text[96];
  const int length = std::snprintf(text, sizeof(text), R"({"overruns":%lld,"late":"%s"})",
                                   static_cast<long long>(report_.overruns), late_name(late));
  telemetry_->push_event(EventKind::kNote, tick_, time, std::string_view(text, length));
}

void ControlLoop::wait_for_next_period() {
  const std::int64_t period = std::llround(1e9 * options_.period);
  const std::int64_t before = now_ns();
  next_wake_ns_ += period;
  const bool overrun = before > next_wake_ns_;
  if (overrun) {
    ++report_.overruns;
    tell_overrun();
    const bool catch_up = options_.overrun == OverrunPolicy::kCatchUp &&
                          1e-9 * static_cast<double>(before - next_wake_ns_) < options_.overrun_run;
    if (!catch_up) next_wake_ns_ += (before - next_wake_ns_) / period * period + period;
  }
  time_overrun_ = overrun ? time_overrun_ + options_.period : 0.0;
  if (options_.overrun == OverrunPolicy::kStop && time_overrun_ > options_.overrun_run) {
    raise(kFaultOverrun, "overrun");
  }
  const timespec wake{static_cast<time_t>(next_wake_ns_ / 1000000000),
                      static_cast<long>(next_wake_ns_ % 1000000000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, nullptr) != 0) {
    if (stop_.load(std::memory_order_relaxed)) return;
  }
  pipeline_->data().times.jitter_us = 1e-3 * static_cast<double>(now_ns() - next_wake_ns_);
}

}  // namespace gaitd::daemon
