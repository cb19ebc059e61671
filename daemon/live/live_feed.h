// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

#include "daemon/live/subscription.h"
#include "daemon/log/event.h"
#include "daemon/server/rpc.h"
#include "daemon/telemetry/telemetry.h"

namespace gaitd::daemon {

/// `telemetry.subscribe`: the newest tick for whoever watches, so many times a second, and the
/// events. A thread of its own copies the tick that status queries see; the control thread knows
/// nothing of it, and neither a disk nor a slow reader holds it up. See docs/protocol.md.
class LiveFeed {
 public:
  static constexpr std::size_t kUnread = 256u << 10;      ///< bytes, then frames are left out
  static constexpr std::size_t kUnreadEvents = 1u << 20;  ///< bytes, then events are too
  static constexpr std::size_t kEventsWaiting = 4096;     ///< for the thread

  /// `telemetry` outlives the feed, or its stop().
  explicit LiveFeed(const Telemetry* telemetry) : telemetry_(telemetry) {}
  ~LiveFeed() { stop(); }
  LiveFeed(const LiveFeed&) = delete;
  LiveFeed& operator=(const LiveFeed&) = delete;

  /// telemetry.subscribe and telemetry.unsubscribe.
  void add_methods(Methods* methods);
  /// [any thread] An event on its way to the log.
  void publish(const Event& event);

  void start();
  /// Joins and forgets all subscriptions; there are none afterwards. Before the server goes.
  void stop();

 private:
  RpcResult subscribe(const nlohmann::json& params, const Caller& caller);
  nlohmann::json unsubscribe(const Caller& caller);
  void run();
  void send_events();
  bool send_frames(std::vector<double>* values);

  const Telemetry* telemetry_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stopping_ = false;
  std::vector<Subscription> subscriptions_;
  std::vector<Event> events_;
  std::uint64_t events_lost_ = 0;
  std::thread thread_;
};

}  // namespace gaitd::daemon
