// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/control_loop.h"

#include <time.h>

#include <cstdio>
#include <utility>

#include "daemon/control/command_text.h"
#include "daemon/control/denormals.h"
#include "daemon/control/signals.h"
#include "daemon/control/state_text.h"
#include "daemon/control/stopwatch.h"
#include "daemon/control/tick_guard.h"
#include "gaitd/sdk/bounds.h"

namespace gaitd::daemon {
namespace {

constexpr double kTellOverruns = 1.0;  // s between two events about overruns
constexpr double kUnreadTime = 1.0;    // s without a backend after which a scenario is over

std::int64_t now_ns() {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return std::int64_t{1000000000} * t.tv_sec + t.tv_nsec;
}

// What a command costs a tick: each footstep is looked at.
int footsteps_of(const Command& command) {
  if (command.type == CommandType::kWalk) return command.walk.steps;
  if (command.type == CommandType::kDrive) return walking::kFootstepsOfDrive;
  return command.type == CommandType::kFootsteps ? command.footstep_count : 0;
}

RunEnd end_of(ScenarioPlayer::End end) {
  switch (end) {
    case ScenarioPlayer::End::kSettled:
      return RunEnd::kSettled;
    case ScenarioPlayer::End::kDuration:
      return RunEnd::kDuration;
    case ScenarioPlayer::End::kFault:
      return RunEnd::kFault;
    default:
      return RunEnd::kStopped;
  }
}

}  // namespace

ControlLoop::ControlLoop(const LoopOptions& options, const Parts& parts)
    : options_(options),
      model_(*parts.model),
      pipeline_(parts.pipeline),
      backend_(parts.backend, *parts.model),
      telemetry_(parts.telemetry),
      watch_(parts.watch),
      estop_(parts.estop),
      bridge_(parts.bridge),
      scenario_(parts.scenario),
      swaps_(parts.swaps),
      goto_(parts.plans),
      refine_(parts.refinements),
      sight_(parts.plans, parts.sight),
      command_(std::make_unique<Command>()),
      pace_(options.period, options.overrun, options.overrun_run) {
  if (swaps_ != nullptr) swaps_->publish(pipeline_->swap_right());
}

LoopReport ControlLoop::run() {
  const FlushDenormals flush;
  const Stopwatch watch;
  pace_.start(now_ns());
  if (options_.arm) pipeline_->safety().arm();
  const bool lockstep = options_.clock == GAITD_CLOCK_LOCKSTEP;
  if (scenario_ != nullptr && scenario_->pushes() && !backend_.has_pushes()) {
    end(RunEnd::kPush,
        "the scenario pushes the robot, which this backend cannot do; run it on a "
        "simulation: --backend simbody");
  }
  while (!ended_ && !stop_.load(std::memory_order_relaxed)) {
    if (lockstep) telemetry_->wait_for_space(64, &stop_);
    pulse_.beat();
    take_estop();
    if (swaps_ != nullptr) tell_swaps();  // the parameters that count are those of what runs
    take_commands();
    take_sights();
    take_plan();
    take_refinement();
    take_swaps();
    if (ended_) break;
    const Outcome outcome = tick();
    if (outcome == Outcome::kTicked) {
      ++tick_;
      ++report_.ticks;
      time_unread_ = 0.0;
      read_failed_ = false;
      if (std::exchange(write_failed_, false)) raise(kFaultBackend, "backend");
      if (scenario_ != nullptr) {
        const auto played = scenario_->update(options_.period, pipeline_->data(), goto_.active());
        if (played != ScenarioPlayer::End::kRunning) {
          end(end_of(played));
          break;
        }
      }
      if (lockstep && !backend_.advance()) {
        backend_failed("advance failed");
        end(RunEnd::kBackend, "the backend failed to advance the simulation");
      }
    } else if (outcome == Outcome::kNotReady) {
      ++report_.late_backend;
      go_without_readings();
    } else {
      if (!std::exchange(read_failed_, true)) backend_failed(backend_.read_problem());
      go_without_readings();
      // A simulation that cannot be read will not mend; a robot may.
      if (lockstep || (scenario_ != nullptr && time_unread_ > kUnreadTime)) {
        end(RunEnd::kBackend, "the backend failed to read the sensors");
      }
    }
    if (!lockstep && !ended_) wait_for_next_period();
  }
  report_.wall_seconds = 1e-6 * watch.microseconds();
  return report_;
}

int ControlLoop::inside() const noexcept {
  return backend_.inside() ? GAITD_LAYER_BACKEND : pipeline_->layers().running();
}

void ControlLoop::end(RunEnd how, const std::string& problem) {
  ended_ = true;
  report_.end = how;
  if (problem.empty()) return;
  report_.problem = problem + " (tick " + std::to_string(tick_) + ")";
}

ControlLoop::Outcome ControlLoop::tick() {
  const TickGuard guard;
  const Stopwatch watch;
  TickData& data = pipeline_->data();
  const GaitdStatus status = backend_.read(&data.readings);
  if (status == GAITD_NOT_READY) return Outcome::kNotReady;
  if (status != GAITD_OK) return Outcome::kBackendFailed;
  data.health = backend_.health();
  pipeline_->run(tick_);
  const bool written = backend_.write(data.commands);
  data.times.total_us = watch.microseconds();
  watch_->add(tick_, data.times, pipeline_->layers().budgets());
  data.has_truth = backend_.truth(&data.truth);
  sight_.look(model_, data, tick_);
  record();
  report_changes();
  if (!written) write_failed_ = true;
  return Outcome::kTicked;
}

// A robot that tells nothing new is not controlled any more; what it was told last must not be its
// last command. A simulation stands still meanwhile.
void ControlLoop::go_without_readings() {
  time_unread_ += options_.period;
  if (pipeline_->layers().rules().simulation) return;
  const Safety& safety = pipeline_->safety();
  const bool used =
      safety.state() != SafetyState::kDisarmed && safety.state() != SafetyState::kFault;
  if (used && silent()) backend_failed("no new readings");
  if (safety.state() != SafetyState::kFault) return;
  // Apart from the commands of the ticks, which the next one begins from.
  silence_.size = sizeof(silence_);
  silence_.joint_count = model_.joint_count;
  silence_.tick = tick_;
  safety.damp(silence_);
  if (!backend_.write(silence_)) write_failed_ = true;
}

bool ControlLoop::silent() const {
  return !pipeline_->layers().rules().simulation &&
         time_unread_ > pipeline_->safety().parameters()[SafetyParameter::kSensorTimeout];
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
      push_robot(*push);
    }
  }
  if (bridge_ == nullptr) return;
  int footsteps = 0;
  for (std::size_t i = 0; i < CommandBridge::kPerTick && footsteps < bounds::kFootstepsPerTick &&
                          bridge_->try_pop(*command_);
       ++i) {
    execute(*command_, true);
    footsteps += footsteps_of(*command_);
  }
}

void ControlLoop::execute(const Command& command, bool from_client) {
  if (command.type == CommandType::kGoto) return begin_goto(command, from_client);
  const bool simulation = command.type == CommandType::kPush ||
                          command.type == CommandType::kSimLoad ||
                          command.type == CommandType::kSimReset;
  const bool clears = command.type == CommandType::kReset || command.type == CommandType::kSimReset;
  const bool switches_on =
      command.type == CommandType::kArm || command.type == CommandType::kJointTest;
  const char* untimely = nullptr;
  if (from_client && (clears || switches_on) && command.estops < estop_->asked()) {
    untimely = "an e-stop was asked for after this command; look why, then send it again";
  } else if (switches_on && silent()) {
    untimely = "the robot tells nothing new; look at its power and its buses";
  }
  CommandReply reply = untimely != nullptr                  ? refuse_untimely(command, untimely)
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
  if (reply.accepted) give_up_goto(command);
  // A replay knows neither the backend that refused a reset nor a plugin that is gone.
  const bool unknown = !reply.accepted && (command.type == CommandType::kSimReset ||
                                           command.type == CommandType::kSetParameter);
  if (untimely == nullptr && !unknown) telemetry_->push_input(tick_, time, command, owner, place);
  if (from_client) bridge_->push(reply);
}

// One that does not know what has happened since, such as a reset that was on its way when somebody
// stopped the robot.
CommandReply ControlLoop::refuse_untimely(const Command& command, const char* why) {
  CommandReply reply;
  reply.request = command.request;
  std::snprintf(reply.message.data(), reply.message.size(), "%s", why);
  return reply;
}

void ControlLoop::backend_failed(const char* what) {
  raise(kFaultBackend, "backend");
  char text[96];
  const int length = std::snprintf(text, sizeof(text), R"({"fault":"backend","what":"%s"})", what);
  telemetry_->push_event(EventKind::kFault, tick_, static_cast<double>(tick_) * options_.period,
                         std::string_view(text, length));
}

// A fault that does not come from the data of a tick: an input of the next one.
void ControlLoop::raise(Fault fault, const char* name) {
  pipeline_->safety().raise(fault);
  char text[64];
  const int length = std::snprintf(text, sizeof(text), R"({"fault":"%s"})", name);
  telemetry_->push_event(EventKind::kDecision, tick_, static_cast<double>(tick_) * options_.period,
                         std::string_view(text, length));
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
  const Pace::Next next = pace_.after_tick(now_ns());
  if (next.overrun) {
    ++report_.overruns;
    tell_overrun();
  }
  const Safety& safety = pipeline_->safety();
  if (next.fault && safety.state() != SafetyState::kDisarmed &&
      (safety.faults() & kFaultOverrun) == 0) {
    raise(kFaultOverrun, "overrun");
  }
  const timespec wake{static_cast<time_t>(next.due / 1000000000),
                      static_cast<long>(next.due % 1000000000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, nullptr) != 0) {
    if (stop_.load(std::memory_order_relaxed)) return;
  }
  pipeline_->data().times.jitter_us = 1e-3 * static_cast<double>(now_ns() - next.due);
}

}  // namespace gaitd::daemon
