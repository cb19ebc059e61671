// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/lockfree/spsc_queue.hpp>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "daemon/command/command.h"
#include "daemon/server/fair_queue.h"
#include "daemon/server/rpc.h"
#include "gaitd/sdk/bounds.h"

namespace gaitd::daemon {

/// Carries commands from the thread of the requests to the control thread and the answers back,
/// through one wait-free ring each way. Clients take turns: each has a share of commands that wait,
/// and only whoever uses up its own is told "busy". Large (about 2 MB): make it on the heap.
class CommandBridge {
 public:
  static constexpr std::size_t kCapacity = 64;
  /// Commands of one client that wait.
  static constexpr std::size_t kShare = bounds::kCommandsWaiting;
  /// What the control thread finds in its ring at most: so many commands cost a tick little.
  static constexpr std::size_t kPerTick = bounds::kCommandsPerTick;
  using Clock = std::chrono::steady_clock;
  static constexpr Clock::duration kShowTime = std::chrono::milliseconds(200);

  explicit CommandBridge(Clock::duration timeout = std::chrono::seconds(5));

  // ---- Control thread: wait-free, no allocation; the pages of both rings are touched before.

  /// Takes the next command; false if there is none.
  bool try_pop(Command& command) { return commands_.pop(command); }
  /// Answers a command that was taken. False if the ring is full (nobody takes the answers): the
  /// answer is dropped and the client is told that none came.
  bool push(const CommandReply& reply) { return replies_.push(reply); }

  // ---- Thread of the requests.

  /// Holds each acceptance back until `newest_tick` has reached the tick that took the command, so
  /// that a status asked for after the answer shows the effect; at most kShowTime, for when no
  /// ticks come.
  void show_effect_first(std::function<std::int64_t()> newest_tick) {
    newest_tick_ = std::move(newest_tick);
  }
  /// Sends `command` under a request number of the bridge. `respond` gets {"accepted": true,
  /// "tick": n, "note": text or null}, for a parameter "old" and "value" too, or an error: refused
  /// with the control thread's reason, busy, no answer in time.
  void submit(Command command, const Caller& caller, Respond respond);
  /// A request that another thread answers, in its own time: the number to answer it with.
  std::uint64_t open(Respond respond);
  /// Hands over the answers that have come and times out those that have not.
  void poll(Clock::time_point now);
  bool waiting() const {
    return !queue_.empty() || !pending_.empty() || !held_.empty() || !open_.empty();
  }
  /// Answers everything that waits with the stopping error.
  void abandon();

  // ---- Any thread but the control thread.

  /// The answer to an open() request; to one that is not open (any more): nothing happens.
  void answer(std::uint64_t request, RpcResult result);

 private:
  struct Pending {
    Respond respond;
    Clock::time_point deadline;
  };

  // An acceptance whose effect does not show yet.
  struct Held {
    Respond respond;
    CommandReply reply;
    Clock::time_point deadline;
  };

  // A command that waits for its turn.
  struct Waiting {
    std::unique_ptr<Command> command;
    Respond respond;
  };

  void feed(Clock::time_point now);
  void release_held(Clock::time_point now);
  void release_answers();

  FairQueue<Waiting> queue_{kShare, false};
  boost::lockfree::spsc_queue<Command, boost::lockfree::capacity<kCapacity>> commands_;
  boost::lockfree::spsc_queue<CommandReply, boost::lockfree::capacity<4 * kCapacity>> replies_;
  std::map<std::uint64_t, Pending> pending_;
  std::deque<Held> held_;
  std::map<std::uint64_t, Respond> open_;
  std::mutex answers_mutex_;
  std::vector<std::pair<std::uint64_t, RpcResult>> answers_;
  std::function<std::int64_t()> newest_tick_;
  std::uint64_t next_request_ = 1;
  Clock::duration timeout_;
};

/// JSON params of a method → Command, or what is wrong with them.
using CommandParser = std::function<std::variant<Command, RpcError>(const std::string& method,
                                                                    const nlohmann::json& params)>;

/// Adds the methods that are commands: arm, disarm, reset, mode, walk, footsteps, pause,
/// resume, stop, abort, pose, sim.push, sim.reset, joint.test. `bridge` must outlive the server.
void add_command_methods(Methods* methods, CommandBridge* bridge, CommandParser parser);

}  // namespace gaitd::daemon
