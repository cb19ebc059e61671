// SPDX-License-Identifier: Apache-2.0
#include "tests/storm/storm.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

#include "gaitd/sdk/bounds.h"
#include "tests/storm/refusals.h"

namespace gaitd::storm {
namespace {

using nlohmann::json;

constexpr int kFallen = 150;    // ticks of damped joints before the storm notices
constexpr int kRecovery = 400;  // and before it puts the robot back on its feet
constexpr int kAfter = 1500;    // ticks after the last request
constexpr std::size_t kMaxFailures = 20;
constexpr int kRefused = -32000;
constexpr int kBusy = -32002;

class Hash {
 public:
  template <class T>
  void add(const T* values, std::size_t count) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(values);
    for (std::size_t i = 0; i < count * sizeof(T); i += sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes + i, std::min(sizeof(word), count * sizeof(T) - i));
      value_ = (value_ ^ word) * 0x100000001b3ULL;
      value_ ^= value_ >> 29;
    }
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

double yaw_of(const double* q) {
  return std::atan2(2.0 * (q[3] * q[2] + q[0] * q[1]), 1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2]));
}

}  // namespace

Storm::Storm(const StormOptions& options) : options_(options), source_(options.seed, {}) {
  if (!options.replay) return;
  std::ifstream in(options.folder / "accepted.jsonl");
  for (std::string line; std::getline(in, line);) {
    const json entry = json::parse(line);
    if (entry.contains("last_tick")) last_tick_ = entry["last_tick"];
    if (entry.contains("line")) replayed_.push_back({entry["tick"], entry["line"]});
  }
}

bool Storm::after_tick(const GaitdJointCommands& commands, const GaitdTruth& truth) {
  record(commands, truth);
  look(commands, truth);
  ++tick_;
  if (options_.replay) {
    replay();
  } else if (flooded_) {
    wait_for_the_flood();
  } else if (last_tick_ < 0) {
    recover();
    if (tick_ >= next_burst_) burst();
    if (sent_ >= options_.count) last_tick_ = tick_ + kAfter;
  }
  if (tick_ != last_tick_) return true;
  finish();
  return false;
}

void Storm::record(const GaitdJointCommands& commands, const GaitdTruth& truth) {
  Hash hash;
  hash.add(commands.joints, commands.joint_count);
  hash.add(truth.pelvis_position, 3);
  hash.add(truth.pelvis_orientation, 4);
  hash.add(truth.joint_position, commands.joint_count);
  hash.add(truth.joint_velocity, commands.joint_count);
  hashes_.push_back(hash.value());
}

void Storm::look(const GaitdJointCommands& commands, const GaitdTruth& truth) {
  for (int side = 0; side < 2; ++side) {
    const GaitdFootTruth& foot = truth.feet[side];
    scene_.feet[side] = {foot.position[0], foot.position[1], yaw_of(foot.orientation)};
  }
  damped_ = commands.joints[0].mode == GAITD_JOINT_MODE_DAMPING ? damped_ + 1 : 0;
}

Storm::Connection& Storm::connection(std::size_t i) {
  Connection& c = connections_[i];
  if (!c.socket) {
    c.socket = std::make_unique<daemon::RawClient>(options_.socket);
    if (!c.socket->connected()) fail("cannot connect to " + options_.socket);
  }
  return c;
}

// The robot has fallen or was told to stop: it stays so for a while, which is a state to be refused
// in, then the simulation starts over.
void Storm::recover() {
  if (damped_ == kFallen) ++falls_;
  if (damped_ < kRecovery || damped_ % 200 != 0) return;
  send(connection(0), {source_.plain("reset"), source_.plain("arm")}, false);
  send(connection(0), {source_.plain("sim.reset")}, false);
  synchronise(connection(0));
}

void Storm::burst() {
  next_burst_ = tick_ + source_.integer(5, 30);
  for (int i = source_.integer(1, 3); i > 0 && !flooded_; --i) {
    Connection& c = connection(static_cast<std::size_t>(source_.integer(0, 3)));
    std::vector<Request> requests;
    for (int j = source_.integer(1, 3); j > 0 && !flooded_; --j) {
      requests.push_back(source_.next(scene_));
      flooded_ = requests.back().fills_a_tick;
    }
    const bool batchable =
        std::all_of(requests.begin(), requests.end(), [](const Request& r) { return r.id != 0; });
    send(c, requests, batchable && source_.chance(0.3));
    // One client after the other: their order is part of what is repeated.
    synchronise(c);
  }
  if (flooded_) return;
  if (source_.chance(0.02)) mishap();
  // Now and then more than the control thread takes at a time.
  if (!source_.chance(0.002)) return;
  std::vector<Request> flood;
  for (int j = 0; j < 90; ++j) flood.push_back(source_.without_effect());
  send(connection(0), flood, false);
  synchronise(connection(0));
  flooded_ = true;
}

// Commands behind a flood, or behind a long one, are taken in a later tick: in the replay, which
// has neither, they would be too early.
void Storm::wait_for_the_flood() {
  for (Connection& c : connections_) {
    if (c.socket) synchronise(c);
  }
  flooded_ = std::any_of(pending_.begin(), pending_.end(), [](const auto& entry) {
    const Request& request = entry.second.request;
    return request.kind == Request::Kind::kFlood || request.fills_a_tick;
  });
}

void Storm::send(Connection& c, const std::vector<Request>& requests, bool as_batch) {
  std::string text;
  for (const Request& r : requests) {
    text += as_batch ? "" : r.line + "\n";
    expect(c, r);
  }
  if (as_batch) text = CommandSource::batch(requests) + "\n";
  if (!c.socket->send(text)) fail("gaitd closed a connection");
}

void Storm::expect(Connection& c, const Request& request) {
  ++sent_;
  if (request.id != 0) {
    pending_[request.id] = {request, tick_};
  } else if (!request.notification) {
    c.nameless.push_back(request);
  }
}

// What a client does when it is ill. It has a connection of its own: answers to it get lost.
void Storm::mishap() {
  Connection ill{std::make_unique<daemon::RawClient>(options_.socket), {}};
  switch (source_.integer(0, 3)) {
    case 0:  // half a line, and gone
      ill.socket->send(R"({"jsonrpc":"2.0","id":1,"method":"estop")");
      synchronise(connection(0));
      break;
    case 1:  // half a line, then silence
      if (half_line_) break;
      ill.socket->send(R"({"jsonrpc":"2.0","id":1,)");
      half_line_ = std::move(ill.socket);
      break;
    case 2:  // a request that is refused whatever the state, and gone before the answer
      ill.socket->send(
          R"({"jsonrpc":"2.0","id":"ill","method":"walk","params":{"steps":1,"length":1.9}})"
          "\n");
      synchronise(ill);
      break;
    default: {  // too long a line
      Request request;
      request.method = "too long";
      request.code = -32600;
      request.names = "longer than";
      request.line = std::string(bounds::kRequestBytes + 1, ' ');
      send(ill, {request}, false);
      const json answer = ill.socket->answer();
      if (answer.is_object()) take_answer(ill, answer);
      if (!ill.socket->ended()) fail("a line that was too long did not end its connection");
      break;
    }
  }
}

void Storm::replay() {
  Connection& c = connection(0);
  bool any = false;
  for (; next_replayed_ < replayed_.size(); ++next_replayed_, any = true) {
    const Accepted& one = replayed_[next_replayed_];
    if (one.tick != tick_) break;
    Request request;
    request.kind = Request::Kind::kCommand;
    request.method = "replayed";
    request.id = json::parse(one.line)["id"];
    request.line = one.line;
    send(c, {request}, false);
  }
  if (any || tick_ == last_tick_) synchronise(c);
}

// Until the server has taken every line before: it works through them in order. What it asks for
// now and then is the status: it is answered although the control thread waits here.
void Storm::synchronise(Connection& c) {
  const bool status = tick_ % 4 == 0;
  c.socket->send(std::string(R"({"jsonrpc":"2.0","id":"sync","method":")") +
                 (status ? "status" : "version") + "\"}\n");
  for (;;) {
    const json answer = c.socket->answer();
    if (answer.is_null()) return fail("no answer within 5 s, or the connection was closed");
    if (answer.is_object() && answer.value("id", json()) == "sync") {
      if (!answer.contains("result")) return fail("no status: " + answer.dump());
      if (status) ++states_[answer["result"].value("state", "?")];
      return;
    }
    take_answer(c, answer);
  }
}

void Storm::take_answer(Connection& c, const json& answer) {
  if (answer.is_array()) {
    for (const json& one : answer) take_answer(c, one);
    return;
  }
  const json id = answer.value("id", json());
  if (id.is_null()) {
    if (c.nameless.empty()) return fail("an answer to nothing: " + answer.dump());
    check(c.nameless.front(), answer);
    return c.nameless.pop_front();
  }
  if (!id.is_number_integer()) return;
  const auto found = pending_.find(id.get<std::int64_t>());
  if (found == pending_.end()) return fail("an answer to nothing: " + answer.dump());
  const auto [request, tick] = found->second;
  check(request, answer);
  if (request.kind == Request::Kind::kCommand && answer.contains("result")) {
    accepted_[request.id] = {tick, request.line};
  }
  pending_.erase(found);
}

void Storm::check(const Request& request, const json& answer) {
  const std::string about = request.line.substr(0, 300) + " -> " + answer.dump().substr(0, 500);
  if (answer.contains("result")) {
    ++outcomes_[request.method]["accepted"];
    if (request.kind == Request::Kind::kInvalid) fail("accepted: " + about);
    return;
  }
  const json error = answer.value("error", json::object());
  const int code = error.value("code", 0);
  const std::string message = error.value("message", "");
  ++outcomes_[request.method][std::to_string(code)];
  if (options_.replay) return fail("accepted before, refused now: " + about);
  if (!names_its_reason(code, message)) fail("a refusal unlike any in refusals.h: " + about);
  const bool by_state = code == kRefused || code == kBusy;
  if (request.kind == Request::Kind::kQuery) fail("a query was refused: " + about);
  const bool command =
      request.kind == Request::Kind::kCommand || request.kind == Request::Kind::kFlood;
  if (command && !by_state) fail("refused by mistake: " + about);
  if (request.kind == Request::Kind::kInvalid) {
    const bool as_expected = code == request.code || (request.code == kRefused && code == kBusy);
    if (!as_expected) fail("expected error " + std::to_string(request.code) + ": " + about);
    if (message.find(request.names) == std::string::npos) {
      fail("the refusal does not name '" + request.names + "': " + about);
    }
  }
}

void Storm::finish() {
  // The control thread has given its part of the last answers; the server passes them on soon.
  for (int i = 0; i < 1000 && !pending_.empty(); ++i) {
    for (Connection& c : connections_) {
      if (c.socket) synchronise(c);
    }
    usleep(1000);
  }
  if (!pending_.empty()) {
    fail(std::to_string(pending_.size()) +
         " requests without an answer, the first: " + pending_.begin()->second.request.line);
  }
  if (options_.replay && next_replayed_ < replayed_.size()) fail("not everything was replayed");
  if (!options_.replay && states_["walking"] < 10) fail("the robot has hardly walked");
  const char* name = options_.replay ? "replay" : "storm";
  std::ofstream ticks(options_.folder / (std::string(name) + ".ticks"), std::ios::binary);
  ticks.write(reinterpret_cast<const char*>(hashes_.data()),
              static_cast<std::streamsize>(hashes_.size() * sizeof(hashes_[0])));
  if (!options_.replay) {
    std::ofstream out(options_.folder / "accepted.jsonl");
    for (const auto& [id, one] : accepted_) {
      out << json{{"tick", one.tick}, {"line", one.line}}.dump() << "\n";
    }
    out << json{{"last_tick", last_tick_}}.dump() << "\n";
  }
  const json report = {{"requests", sent_},           {"ticks", tick_},    {"falls", falls_},
                       {"outcomes", outcomes_},       {"states", states_}, {"failures", failures_},
                       {"accepted", accepted_.size()}};
  std::ofstream(options_.folder / (std::string(name) + ".json")) << report.dump(1) << "\n";
}

void Storm::fail(const std::string& what) {
  if (failures_.size() < kMaxFailures) {
    failures_.push_back("tick " + std::to_string(tick_) + ": " + what);
  }
}

}  // namespace gaitd::storm
