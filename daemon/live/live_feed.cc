// SPDX-License-Identifier: Apache-2.0
#include "daemon/live/live_feed.h"

#include <pthread.h>
#include <signal.h>

#include <algorithm>
#include <string>
#include <utility>

namespace gaitd::daemon {
namespace {

using nlohmann::json;
using Clock = Subscription::Clock;
using std::chrono::duration;
using std::chrono::duration_cast;
using std::chrono::milliseconds;

constexpr auto kLeastSleep = milliseconds(1);
constexpr auto kLongestSleep = milliseconds(20);

}  // namespace

void LiveFeed::add_methods(Methods* methods) {
  methods->add_async("telemetry.subscribe",
                     [this](const json& params, const Caller& caller, const Respond& respond) {
                       respond(subscribe(params, caller));
                     });
  methods->add_query("telemetry.unsubscribe",
                     [this](const Caller& caller) { return unsubscribe(caller); });
}

RpcResult LiveFeed::subscribe(const json& params, const Caller& caller) {
  const SignalTable& table = telemetry_->table();
  SubscriptionRequest request = read_subscription(params, table);
  if (!request.error.empty()) return RpcError{rpc_code::kInvalidParams, request.error};
  json header = subscription_header(request, table);
  const std::scoped_lock lock(mutex_);
  if (stopping_ || caller.stream == nullptr) {
    return RpcError{rpc_code::kStopping, "telemetry.subscribe: gaitd is stopping"};
  }
  std::erase_if(subscriptions_,
                [&](const auto& one) { return one.connection == caller.connection; });
  subscriptions_.push_back({.connection = caller.connection,
                            .stream = caller.stream,
                            .signals = std::move(request.signals),
                            .rate = request.rate,
                            .events = request.events});
  wake_.notify_one();
  return header;
}

json LiveFeed::unsubscribe(const Caller& caller) {
  const std::scoped_lock lock(mutex_);
  const auto ended = std::erase_if(
      subscriptions_, [&](const auto& one) { return one.connection == caller.connection; });
  return json{{"ended", ended > 0}};
}

void LiveFeed::publish(const Event& event) {
  const std::scoped_lock lock(mutex_);
  if (std::ranges::none_of(subscriptions_, [](const auto& one) { return one.events; })) return;
  if (events_.size() < kEventsWaiting) {
    events_.push_back(event);
  } else {
    ++events_lost_;
  }
}

void LiveFeed::start() {
  // Signals are for the main thread.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this] { run(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  pthread_setname_np(thread_.native_handle(), "gaitd-live");
}

void LiveFeed::stop() {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
    wake_.notify_one();
  }
  if (thread_.joinable()) thread_.join();
  const std::scoped_lock lock(mutex_);
  subscriptions_.clear();
}

void LiveFeed::run() {
  std::vector<double> values;
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    std::erase_if(subscriptions_, [](const auto& one) { return !one.stream->open(); });
    if (subscriptions_.empty()) {
      events_.clear();
      wake_.wait(lock);
      continue;
    }
    send_events();
    const bool fresh = send_frames(&values);
    Clock::time_point next = Clock::now() + kLongestSleep;
    for (const Subscription& one : subscriptions_) next = std::min(next, one.due);
    // A subscription that is due but has no new tick is looked after as often as ticks may come.
    next = std::max(next, Clock::now() + (fresh ? kLeastSleep : 2 * kLeastSleep));
    wake_.wait_until(lock, next);
  }
}

void LiveFeed::send_events() {
  const std::uint64_t lost = std::exchange(events_lost_, 0);
  for (Subscription& one : subscriptions_) {
    if (!one.events) continue;
    one.lost_events += lost;
    for (const Event& event : events_) {
      if (one.stream->unread() > kUnreadEvents) {
        ++one.lost_events;
      } else {
        one.stream->send(event_line(event, std::exchange(one.lost_events, 0)));
      }
    }
  }
  events_.clear();
}

// False if no subscription has got a frame.
bool LiveFeed::send_frames(std::vector<double>* values) {
  const Clock::time_point now = Clock::now();
  const bool any = std::ranges::any_of(subscriptions_, [&](const auto& one) {
    return one.due <= now && one.tick != telemetry_->newest_tick();
  });
  std::int64_t tick = 0;
  if (!any || !telemetry_->latest(*values, &tick)) return false;
  const SignalTable& table = telemetry_->table();
  const int time = find_signal(table, "time");
  for (Subscription& one : subscriptions_) {
    if (one.due > now || one.tick == tick) continue;
    const auto period = duration_cast<Clock::duration>(duration<double>(1.0 / one.rate));
    one.due = std::max(one.due + period, now);
    one.tick = tick;
    if (one.stream->unread() > kUnread) {
      ++one.lost;
      continue;
    }
    const double at = time < 0 ? 0.0 : (*values)[static_cast<std::size_t>(time)];
    one.stream->send(frame_line(table, one.signals, *values, tick, at, std::exchange(one.lost, 0)));
  }
  return true;
}

}  // namespace gaitd::daemon
