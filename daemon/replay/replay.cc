// SPDX-License-Identifier: Apache-2.0
#include "daemon/replay/replay.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <memory>

#include "daemon/control/command_json.h"
#include "daemon/control/denormals.h"
#include "daemon/control/signals.h"
#include "daemon/host/layers.h"
#include "daemon/replay/recorded_robot.h"
#include "daemon/replay/stages.h"

namespace gaitd::daemon {
namespace {

using nlohmann::json;

// What came from outside between two ticks, in order.
struct Inputs {
  std::vector<const Event*> commands;
  std::vector<json> swaps;
  std::vector<int> too_long;  // layers, in the tick before
  std::uint32_t faults = 0;
};

std::uint32_t fault_bit(const std::string& name) {
  for (std::size_t i = 0; i < kFaultNames.size(); ++i) {
    if (name == kFaultNames[i]) return 1u << i;
  }
  return 0;
}

std::map<std::int64_t, Inputs> collect(const LogReader& log) {
  std::map<std::int64_t, Inputs> inputs;
  std::map<std::uint64_t, bool> begun;
  for (const Event& event : log.events()) {
    if (event.kind == event_kind_name(EventKind::kInput)) {
      inputs[event.tick].commands.push_back(&event);
      continue;
    }
    const json text = json::parse(event.text, nullptr, false);
    if (!text.is_object()) continue;
    if (event.kind == event_kind_name(EventKind::kDecision)) {
      inputs[event.tick].faults |= fault_bit(text.value("fault", ""));
    } else if (event.kind == event_kind_name(EventKind::kSwap)) {
      if (text.value("wall_time", false)) {
        const auto layer = layer_from_name(text.value("layer", ""));
        if (layer) inputs[event.tick - 1].too_long.push_back(*layer);
      }
      bool& known = begun[text.value("request", std::uint64_t{0})];
      if (!known) inputs[event.tick].swaps.push_back(text);
      known = true;
    }
  }
  return inputs;
}

class Player {
 public:
  Player(const LogReader& log, RecordedRobot* robot)
      : log_(log), robot_(*robot), inputs_(collect(log)) {}

  bool play(const ReplayOptions& options, ReplayReport* report, std::string* error);

 private:
  bool begin_tick(std::int64_t tick, std::string* error);
  static bool end_early(std::int64_t tick, ReplayReport* report);
  bool execute(const Event& event, std::string* error);
  void compare(std::int64_t tick, ReplayReport* report);

  const LogReader& log_;
  RecordedRobot& robot_;
  std::map<std::int64_t, Inputs> inputs_;
  std::vector<double> recorded_;
  std::vector<double> replayed_;
  std::vector<int> compared_;               // signals
  std::map<int, std::size_t> differences_;  // signal → place in the report
};

bool Player::execute(const Event& event, std::string* error) {
  const auto command = std::make_unique<Command>();
  int owner = -1;
  int place = -1;
  if (!read_input(json::parse(event.text, nullptr, false), command.get(), &owner, &place)) {
    *error = "tick " + std::to_string(event.tick) + ": a command in the log cannot be read";
    return false;
  }
  if (command->type == CommandType::kSimReset) {
    robot_.pipeline().reset(robot_.arms_itself());
  } else if (command->type == CommandType::kSetParameter) {
    command->parameter_index = robot_.parameters().find_row(owner, place);
    if (command->parameter_index >= 0) robot_.pipeline().execute(*command);
  } else if (command->type != CommandType::kPush && command->type != CommandType::kSimLoad &&
             command->type != CommandType::kSwap) {
    robot_.pipeline().execute(*command);
  }
  return true;
}

bool Player::begin_tick(std::int64_t tick, std::string* error) {
  const auto drop_reports = [this] {
    SwapReport report;
    while (robot_.pipeline().take_swap_report(&report)) delete report.retired;
  };
  drop_reports();
  const auto found = inputs_.find(tick);
  if (found != inputs_.end()) {
    const Inputs& inputs = found->second;
    if (inputs.faults != 0) robot_.pipeline().safety().raise(inputs.faults);
    for (const Event* event : inputs.commands) {
      if (!execute(*event, error)) return false;
    }
    for (const json& swap : inputs.swaps) {
      SwapOrder order;
      if (!robot_.load_swap(swap, &order, error)) return false;
      if (order.layer >= 0) robot_.pipeline().begin_swap(order);
      drop_reports();  // after each: the journal of a layer holds what one makes
    }
    for (const int layer : inputs.too_long) robot_.pipeline().layers().take_too_long(layer);
  }
  return true;
}

void Player::compare(std::int64_t tick, ReplayReport* report) {
  for (const int i : compared_) {
    if (std::bit_cast<std::uint64_t>(recorded_[i]) == std::bit_cast<std::uint64_t>(replayed_[i])) {
      continue;
    }
    const auto [known, is_new] = differences_.try_emplace(i, report->differences.size());
    if (is_new) {
      const std::string& name = log_.signals()[i].name;
      report->differences.push_back({.signal = name,
                                     .stage = std::string(stage_of(name).name),
                                     .tick = tick,
                                     .recorded = recorded_[i],
                                     .replayed = replayed_[i]});
    }
    double& largest = report->differences[known->second].largest;
    largest = std::max(largest, std::abs(recorded_[i] - replayed_[i]));
  }
}

// What comes after cannot be computed without what is missing.
bool Player::end_early(std::int64_t tick, ReplayReport* report) {
  report->notes.push_back("replayed up to tick " + std::to_string(tick) +
                          ", which is missing in the log or has no sensors there");
  return true;
}

bool Player::play(const ReplayOptions& options, ReplayReport* report, std::string* error) {
  const SignalTable& table = log_.signals();
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!stage_of(table[i].name).name.empty()) compared_.push_back(static_cast<int>(i));
  }
  report->signals = compared_.size();
  recorded_.resize(table.size());
  replayed_.resize(table.size());
  Pipeline& pipeline = robot_.pipeline();
  TickData& data = pipeline.data();
  const int health = find_signal(table, "safety/health");
  const bool has_truth = log_.metadata_value("truth") == "true";
  LogReader::TickCursor ticks = log_.ticks();
  LogReader::SensorsCursor sensors = log_.sensors();
  const FlushDenormals flush;  // as on the control thread
  for (std::int64_t tick = 0; ticks.next(recorded_); ++tick) {
    const bool first_part = tick > 0 || recorded_[1] == 0.0;  // the signal "tick"
    const bool next = recorded_[1] == static_cast<double>(tick);
    if (first_part && !next && log_.damage().any()) return end_early(tick, report);
    if (!first_part || !next) {
      *error = first_part ? "ticks are missing in the log from tick " + std::to_string(tick) +
                                " on (dropped): a replay ends there"
                          : "the log does not begin with tick 0: replay the first of its parts";
      return false;
    }
    if (!begin_tick(tick, error)) return false;
    // After the commands: the reset of a simulation clears what it finds, as on the control thread.
    if (!sensors.next(&data.readings) || sensors.row() != static_cast<std::uint64_t>(tick)) {
      return end_early(tick, report);
    }
    data.has_truth = has_truth;
    if (health >= 0) data.health = static_cast<std::uint32_t>(recorded_[health]);
    if (options.before_tick) options.before_tick(robot_.model(), tick, pipeline);
    pipeline.run(tick);
    record_signals(robot_.model(), data, replayed_);
    compare(tick, report);
    if (options.after_tick) options.after_tick(data);
    ++report->ticks;
  }
  return true;
}

}  // namespace

std::optional<ReplayReport> replay(const LogReader& log, const ReplayOptions& options,
                                   std::string* error) {
  const auto failed = [&](const std::string& why) {
    *error = log.path() + ": " + why;
    return std::nullopt;
  };
  if (log.signals().size() < 2 || log.signals()[1].name != "tick") {
    return failed("it has no signal 'tick' at its place: written by another version of gaitd?");
  }
  if (log.event_dropouts() > 0) return failed("commands were lost in the log: no exact replay");
  ReplayReport report;
  std::string why;
  try {
    const auto robot = RecordedRobot::load(log, options, &report.notes, &why);
    if (robot == nullptr) return failed(why);
    if (!Player(log, robot.get()).play(options, &report, &why)) return failed(why);
  } catch (const json::exception& exception) {
    return failed(std::string("metadata or an event of another form than gaitd writes: ") +
                  exception.what());
  }
  std::stable_sort(report.differences.begin(), report.differences.end(),
                   [](const SignalDifference& a, const SignalDifference& b) {
                     if (a.tick != b.tick) return a.tick < b.tick;
                     return stage_of(a.signal).place < stage_of(b.signal).place;
                   });
  return report;
}

}  // namespace gaitd::daemon
