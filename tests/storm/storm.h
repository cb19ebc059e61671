// SPDX-License-Identifier: Apache-2.0
// A storm of commands on a gaitd in lockstep, each at a tick that is known: it runs between two
// ticks, sends over real connections, and lets the next tick begin when the server has handed
// everything on.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "daemon/server/test/raw_client.h"
#include "gaitd/abi/types.h"
#include "tests/storm/command_source.h"

namespace gaitd::storm {

struct StormOptions {
  std::filesystem::path folder;  // for ticks, accepted commands, report
  std::string socket;
  unsigned seed = 1;
  int count = 10000;    // of requests
  bool replay = false;  // instead of random requests, those that were accepted, at the same ticks
};

class Storm {
 public:
  explicit Storm(const StormOptions& options);

  // After a tick and the step of the plant that follows it. False when the storm is over.
  bool after_tick(const GaitdJointCommands& commands, const GaitdTruth& truth);

 private:
  struct Connection {
    std::unique_ptr<daemon::RawClient> socket;
    std::deque<Request> nameless;  // answered in order, with the id null
  };
  struct Accepted {
    std::int64_t tick = 0;
    std::string line;
  };
  struct Sent {
    Request request;
    std::int64_t tick = 0;
  };

  Connection& connection(std::size_t i);
  void burst();
  void send(Connection& c, const std::vector<Request>& requests, bool as_batch);
  void expect(Connection& c, const Request& request);
  void wait_for_the_flood();
  void mishap();
  void recover();
  void replay();
  void synchronise(Connection& c);
  void take_answer(Connection& c, const nlohmann::json& answer);
  void check(const Request& request, const nlohmann::json& answer);
  void record(const GaitdJointCommands& commands, const GaitdTruth& truth);
  void look(const GaitdJointCommands& commands, const GaitdTruth& truth);
  void finish();
  void fail(const std::string& what);

  const StormOptions options_;
  CommandSource source_;
  std::array<Connection, 4> connections_;
  Scene scene_;
  std::int64_t tick_ = 0;
  std::int64_t next_burst_ = 500;
  std::int64_t last_tick_ = -1;  // decided when everything was sent
  int damped_ = 0;               // ticks that the joints have been so
  int sent_ = 0;
  int falls_ = 0;
  bool flooded_ = false;                          // some of the last flood are not answered yet
  std::unique_ptr<daemon::RawClient> half_line_;  // held to the end
  std::vector<std::uint64_t> hashes_;             // of each tick
  std::map<std::int64_t, Sent> pending_;
  std::map<std::int64_t, Accepted> accepted_;  // by id: in the order they were sent
  std::size_t next_replayed_ = 0;
  std::vector<Accepted> replayed_;
  std::map<std::string, std::map<std::string, int>> outcomes_;  // method, outcome, how many
  std::map<std::string, int> states_;                           // as `status` says
  std::vector<std::string> failures_;
};

}  // namespace gaitd::storm
