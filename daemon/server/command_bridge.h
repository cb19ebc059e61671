// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/lockfree/spsc_queue.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <variant>

#include "daemon/command/command.h"
#include "daemon/server/rpc.h"

namespace gaitd::daemon {

/// Carries commands from the server thread to the control thread and the answers back, through one
/// wait-free ring each way. Large (about 2 MB): make it on the heap.
class CommandBridge {
 public:
  static constexpr std::size_t kCapacity = 64;
  using Clock = std::chrono::steady_clock;

  explicit CommandBridge(Clock::duration timeout = std::chrono::seconds(5));

  // ---- Control thread: wait-free, no allocation; the pages of both rings are touched before.

  /// Takes the next command; false if there is none.
  bool try_pop(Command& command) { return commands_.pop(command); }
  /// Answers a command that was taken. False if the ring is full (nobody takes the answers): the
  /// answer is dropped and the client is told that none came.
  bool push(const CommandReply& reply) { return replies_.push(reply); }

  // ---- Server thread.

  /// Sends `command` under a request number of the bridge. `respond` gets {"accepted": true,
  /// "tick": n}, or an error: refused with the control thread's reason, busy, no answer in time.
  void submit(Command command, Respond respond);
  /// Hands over the answers that have come and times out those that have not.
  void poll(Clock::time_point now);
  bool waiting() const { return !pending_.empty(); }
  /// Answers everything that waits with the stopping error.
  void abandon();

 private:
  struct Pending {
    Respond respond;
    Clock::time_point deadline;
  };

  boost::lockfree::spsc_queue<Command, boost::lockfree::capacity<kCapacity>> commands_;
  boost::lockfree::spsc_queue<CommandReply, boost::lockfree::capacity<4 * kCapacity>> replies_;
  std::map<std::uint64_t, Pending> pending_;
  std::uint64_t next_request_ = 1;
  Clock::duration timeout_;
};

/// JSON params of a method → Command, or what is wrong with them.
using CommandParser = std::function<std::variant<Command, RpcError>(const std::string& method,
                                                                    const nlohmann::json& params)>;

/// Adds the methods that are commands: arm, disarm, estop, reset, mode, walk, footsteps, pause,
/// resume, stop, abort, sim.push, sim.reset. `bridge` must outlive the server.
void add_command_methods(Methods* methods, CommandBridge* bridge, CommandParser parser);

}  // namespace gaitd::daemon
