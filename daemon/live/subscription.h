// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "daemon/log/event.h"
#include "daemon/log/signal.h"
#include "daemon/server/stream.h"

namespace gaitd::daemon {

inline constexpr double kHighestRate = 200.0;          // Hz
inline constexpr double kValuesPerSecond = 300'000.0;  // of one subscription

/// What one client wants to see of the ticks.
struct Subscription {
  using Clock = std::chrono::steady_clock;

  std::uint64_t connection = 0;
  std::shared_ptr<Stream> stream;
  std::vector<std::size_t> signals;  // places in the table
  double rate = 30.0;                // Hz
  bool events = false;

  Clock::time_point due{};
  std::int64_t tick = -1;         // of its newest frame
  std::uint64_t lost = 0;         // frames since that one
  std::uint64_t lost_events = 0;  // since the newest event
};

/// What telemetry.subscribe asks for, or what is wrong with it, one mistake per line.
struct SubscriptionRequest {
  std::vector<std::size_t> signals;
  std::vector<std::string> unmatched;  // globs without a signal: another robot may have some
  double rate = 30.0;
  bool events = false;
  std::string error;
};
SubscriptionRequest read_subscription(const nlohmann::json& params, const SignalTable& table);

/// The answer to it: names, units and words of the signals in the order of the frames, and the
/// globs that match none.
nlohmann::json subscription_header(const SubscriptionRequest& request, const SignalTable& table);

/// The notification with one tick. `values` in table order; reals rounded to single precision,
/// what is no number is null. `lost`: frames before it that were left out.
std::string frame_line(const SignalTable& table, std::span<const std::size_t> signals,
                       std::span<const double> values, std::int64_t tick, double time,
                       std::uint64_t lost);

/// The notification with one event. `lost`: events before it that were left out.
std::string event_line(const Event& event, std::uint64_t lost);

}  // namespace gaitd::daemon
