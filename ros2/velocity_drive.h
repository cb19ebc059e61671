// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace gaitd::ros2 {

/// In the heading of the robot: m/s ahead, m/s to the left, rad/s to the left.
struct Velocity {
  double forward = 0.0;
  double lateral = 0.0;
  double turn = 0.0;

  bool zero() const { return forward == 0.0 && lateral == 0.0 && turn == 0.0; }
};

/// Turns the messages on /cmd_vel into `drive` requests: begins with the first velocity that is not
/// zero, renews it at most ten times a second while messages come, and ends the drive once when
/// they cease. Whoever takes the robot over, stops it or lets it fall ends that: then the velocity
/// has to go to zero, or cease, before it is begun anew. Knows neither clock nor connection.
class VelocityDrive {
 public:
  using Clock = std::chrono::steady_clock;
  using Time = Clock::time_point;
  /// Sends a request to gaitd; `done` gets an object with `result` or `error`, perhaps at once.
  using Done = std::function<void(const nlohmann::json& answer)>;
  using Send =
      std::function<void(const std::string& method, const nlohmann::json& params, Done done)>;

  struct Options {
    std::chrono::duration<double> timeout{0.5};
    bool auto_mode = false;    ///< walk-straight is set where the mode is stand
    std::int64_t session = 1;  ///< of drive: whose velocity it is
  };

  VelocityDrive(const Options& options, Send send) : options_(options), send_(std::move(send)) {}

  /// A message has come.
  void on_velocity(const Velocity& velocity, Time now);
  /// To be called some fifty times a second.
  void tick(Time now);
  /// What `status` says: the state of the robot and its gait mode.
  void set_robot(const std::string& state, const std::string& mode);
  /// The robot was stopped by this process: no velocity until the messages have ceased.
  void hold(const std::string& reason);

  bool driving() const { return driving_; }
  /// Why the last velocity has no effect, or less than it says; empty where all is well.
  const std::string& trouble() const { return trouble_; }
  std::uint64_t refused_messages() const { return refused_messages_; }  ///< with NaN in them

 private:
  static constexpr std::chrono::milliseconds kRenewal{100};
  static constexpr std::chrono::milliseconds kRetry{1000};  // where it could not be begun
  static constexpr std::chrono::seconds kAnswer{2};         // then a request is taken for lost

  bool fresh(Time now) const { return newest_at_ && now - *newest_at_ < options_.timeout; }
  bool on_feet() const;
  void let_go(Time now);
  void begin(Time now);
  void renew(Time now);
  nlohmann::json params(bool renewal) const;  // of `drive`
  void ask(const nlohmann::json& params, bool renewal, Time now);
  void on_answer(const nlohmann::json& answer, bool renewal);
  void set_mode(Time now);

  Options options_;
  Send send_;
  Velocity newest_;
  std::optional<Time> newest_at_;
  bool driving_ = false;
  bool held_ = false;             // until the velocity has been let go
  std::optional<Time> asked_at_;  // a request without an answer yet
  std::uint64_t number_ = 0;      // of the last request
  Time last_request_{};
  std::optional<Time> retry_at_;
  std::string state_, mode_;
  std::string trouble_;
  std::uint64_t refused_messages_ = 0;
};

}  // namespace gaitd::ros2
