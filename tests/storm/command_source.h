// SPDX-License-Identifier: Apache-2.0
// Random requests to gaitd, good and bad, from one seed.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

namespace gaitd::storm {

// One line to send and what has to come back.
struct Request {
  enum class Kind {
    kQuery,    // answered with a result, changes nothing
    kCommand,  // accepted, or refused in the state the robot is in
    kFlood,    // accepted or refused as too many, changes nothing: not repeated in the replay
    kInvalid,  // refused with `code`, whatever the state
  };
  Kind kind = Kind::kInvalid;
  std::string method;   // or what is wrong with it, for the statistics
  std::string line;     // without newline
  std::int64_t id = 0;  // 0: the request has none that can be read, or is a notification
  bool notification = false;
  bool fills_a_tick = false;  // gaitd may take what comes behind it a tick later
  int code = 0;
  std::string names;  // what the message has to contain
};

// What commands that a robot may survive are drawn from.
struct Scene {
  std::array<std::array<double, 3>, 2> feet{};  // x, y, yaw of the left and the right sole (m, rad)
};

// How much of what there is to be, in parts of all requests.
struct Mixture {
  double commands = 0.04;
  double queries = 0.08;  // the rest is invalid
};

class CommandSource {
 public:
  CommandSource(unsigned seed, const Mixture& mixture) : random_(seed), mixture_(mixture) {}

  Request next(const Scene& scene);
  // Several requests with an id each as one line; they are answered as one.
  static std::string batch(const std::vector<Request>& requests);
  // A command that changes nothing, whenever it is taken.
  Request without_effect();
  // A command of which it is certain what it is called and that it needs no params.
  Request plain(const std::string& method);
  // A line with bytes changed at random: it may be anything afterwards.
  std::string damaged(std::string line);

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  bool chance(double share) { return uniform(0, 1) < share; }
  template <class Range>
  auto pick(const Range& range) {
    return *(std::begin(range) + integer(0, static_cast<int>(std::size(range)) - 1));
  }

 private:
  using json = nlohmann::json;
  struct Call {
    std::string method;
    json params;
  };

  Request request(Request::Kind kind, const Call& call);
  Call good_call(const Scene& scene);
  json good_walk();
  json good_drive();
  json good_footsteps(const Scene& scene);
  json good_push();
  Request refused_by_the_gait(const Scene& scene);
  Request wrong_params(const Scene& scene);
  Request wrong_region(Call call);
  Request wrong_parameter();
  Request no_request(const Scene& scene);
  Request no_json(const Scene& scene);

  std::mt19937 random_;
  Mixture mixture_;
  std::int64_t next_id_ = 1;
};

}  // namespace gaitd::storm
