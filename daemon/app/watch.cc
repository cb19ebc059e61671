// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/watch.h"

#include <spdlog/spdlog.h>

#include <string>
#include <thread>
#include <utility>

#include "daemon/control/tick_data.h"

namespace gaitd::daemon {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kPeriod = std::chrono::milliseconds(50);
constexpr auto kTellOverruns = std::chrono::seconds(10);

}  // namespace

Watch::Watch(Sources sources, ServiceManager* manager)
    : from_(std::move(sources)),
      manager_(manager),
      guard_(std::chrono::duration<double>(kPeriod).count(), from_.lockstep),
      faults_signal_(find_signal(from_.telemetry.table(), "safety/faults")),
      state_signal_(find_signal(from_.telemetry.table(), "safety/state")),
      log_(from_.telemetry.log_status()),
      next_told_(Clock::now()) {}

void Watch::run(const std::atomic<bool>& running) {
  while (running) {
    std::this_thread::sleep_for(kPeriod);
    tell_overruns();
    tell_of_log();
    tell_of_faults();
    look_for_hang();
  }
}

void Watch::look_for_hang() {
  const int inside = from_.loop.inside();
  const auto verdict = guard_.look(from_.loop.pulse().rounds(), inside >= 0, from_.stop_requested);
  if (verdict == HangGuard::Verdict::kRuns) return;
  const std::string where = from_.plugin(inside);
  if (verdict == HangGuard::Verdict::kGiveUp) {
    spdlog::critical("{} does not return; gaitd ends without it", where);
    from_.give_up();
  }
  spdlog::error("the control loop hangs: {} has not returned for {:.0f} s", where,
                HangGuard::kTell);
}

void Watch::tell_overruns() {
  const Clock::time_point now = Clock::now();
  if (now < next_told_) return;
  const TickWatch::Report report = from_.ticks.report();
  if (report.overruns == overruns_told_) return;
  spdlog::warn("{} overruns; late in tick {}: {}, {:.0f} us of {:.0f}",
               report.overruns - overruns_told_, report.late.tick, late_name(report.late.what),
               report.late.time, report.late.budget);
  overruns_told_ = report.overruns;
  next_told_ = now + kTellOverruns;
}

void Watch::tell_of_log() {
  const Telemetry::LogStatus before = std::exchange(log_, from_.telemetry.log_status());
  if (before.open && !log_.open) {
    spdlog::error("{}; the log stops here until there is room, the robot goes on", log_.error);
  } else if (log_.part != before.part && before.open) {
    spdlog::info("log: full, goes on in {}", log_.file);
  } else if (log_.part != before.part) {
    spdlog::info("log: goes on in {}; {} ticks are lost", log_.file, log_.lost);
  }
}

void Watch::tell_of_faults() {
  if (faults_signal_ < 0 || state_signal_ < 0 || !from_.telemetry.latest(values_)) return;
  const auto faults = static_cast<std::uint32_t>(values_[faults_signal_]);
  std::string names;
  for (std::size_t i = 0; i < kFaultNames.size(); ++i) {
    if ((faults >> i & 1u) != 0) names += std::string(" ") + kFaultNames[i];
  }
  manager_->tell(kSafetyStateNames[static_cast<std::size_t>(values_[state_signal_])] + names);
  if (faults == faults_) return;
  if (faults != 0) {
    spdlog::error("fault:{}; the joints are damped until `gaitctl reset`", names);
  } else {
    spdlog::info("faults cleared");
  }
  faults_ = faults;
}

}  // namespace gaitd::daemon
