// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "daemon/server/command_bridge.h"
#include "daemon/server/estop_answers.h"
#include "daemon/server/fair_queue.h"
#include "daemon/server/rpc.h"
#include "gaitd/sdk/bounds.h"

namespace gaitd::daemon {

/// The thread that parses and runs requests, apart from the one that reads the sockets: however
/// long a request takes, an e-stop is read meanwhile. Clients take turns, request by request.
class RequestWorker {
 public:
  /// Lines of one client that wait, and their bytes; a single line always has room.
  static constexpr std::size_t kShare = bounds::kLinesWaiting;
  static constexpr std::size_t kShareBytes = bounds::kRequestBytes;

  /// `room` is called on the worker's thread with a client for whom there is room again after
  /// has_room() said no. `bridge` (may be null) is polled every millisecond while commands wait; it
  /// and `flag` outlive the worker.
  RequestWorker(Methods methods, const RpcLimits& limits, CommandBridge* bridge, EstopFlag* flag,
                std::function<void(std::uint64_t client)> room);
  ~RequestWorker();  ///< stops
  RequestWorker(const RequestWorker&) = delete;
  RequestWorker& operator=(const RequestWorker&) = delete;

  /// The new thread inherits the caller's mask of signals.
  void start();
  /// Answers what waits with the stopping error and joins. Lines that were not begun are dropped.
  void stop();

  /// [one thread] False: the client's share is used up; `room` will tell.
  bool has_room(std::uint64_t client, std::size_t bytes);
  /// [the same thread] Queues a line for which there is room. `send` takes the answer on the
  /// worker's thread.
  void push(const Caller& caller, std::string_view line, Exchange::Send send);
  /// [any thread] Nothing more comes from this client.
  void retire(std::uint64_t client);

 private:
  struct Job {
    Caller caller;
    std::string line;
    Exchange::Send send;
    std::optional<Exchange> begun;
  };
  void run();
  bool next(std::pair<std::uint64_t, Job>* job, bool waiting);
  void work(std::uint64_t client, Job job);
  bool waiting() const { return estops_.waiting() || (bridge_ != nullptr && bridge_->waiting()); }
  void poll();

  Methods methods_;
  RpcLimits limits_;
  CommandBridge* bridge_;
  EstopAnswers estops_;
  std::function<void(std::uint64_t)> room_;
  std::mutex mutex_;
  std::condition_variable wake_;
  FairQueue<Job> queue_{kShare};
  std::map<std::uint64_t, std::size_t> bytes_;  // of the lines of each client that are not done
  std::set<std::uint64_t> full_;                // clients that has_room() turned away
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace gaitd::daemon
