// SPDX-License-Identifier: Apache-2.0
#include "ros2/bridge.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <utility>

#include "geometry_msgs.h"
#include "ros2/names.h"
#include "std_msgs.h"

namespace gaitd::ros2 {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kDriveTick{20};
constexpr std::chrono::seconds kDiagnostics{1};
constexpr std::chrono::seconds kTroubleShown{5};
constexpr std::chrono::milliseconds kEstopAgain{300};  // between two tries
constexpr std::chrono::seconds kEstopPatience{10};     // of all of them
constexpr std::chrono::seconds kEstopAnswer{1};        // until the first connection is given up
constexpr const char* kNoAnswer = "gaitd does not answer";

// Two that drive at a time are told apart by it.
std::int64_t new_session() {
  const std::int64_t now = Clock::now().time_since_epoch().count();
  return ((now << 16) ^ getpid()) & ((std::int64_t{1} << 53) - 1);
}

std::string member(const json& object, const char* key) {
  const json value = object.is_object() ? object.value(key, json()) : json();
  return value.is_string() ? value.get<std::string>() : "";
}

}  // namespace

Bridge::Bridge(boost::asio::io_context* io, const BridgeOptions& options, Participant* participant)
    : options_(options),
      topics_(*participant, {.name_space = options.name_space,
                             .best_effort = options.best_effort,
                             .clock = options.sim_time}),
      connector_(io, options.socket),
      source_(
          io, &connector_,
          {.on_robot = [this] { on_robot(); },
           .on_status = [this](const json& status, double silent) { on_status(status, silent); },
           .on_event = [](const daemon::Event&) {},
           .on_frame = [this](const cli::LiveFrame& frame) { on_frame(frame); }},
          {.signals = RobotMessages::signals(),
           .rate = options.rate,
           .role = daemon::Role::kObserve}),
      drive_relay_(std::make_shared<cli::RpcRelay>(daemon::Role::kCommand, &connector_)),
      estop_relay_(std::make_shared<cli::RpcRelay>(daemon::Role::kObserve, &connector_, true)),
      drive_({.timeout = std::chrono::duration<double>(options.timeout),
              .auto_mode = options.auto_mode,
              .session = new_session()},
             [this](const std::string& method, const json& params, VelocityDrive::Done done) {
               drive_relay_->call(method, params, std::move(done));
             }),
      drive_timer_(*io),
      diagnostics_timer_(*io),
      estop_timer_(*io) {
  subscribe(io, *participant);
}

void Bridge::subscribe(boost::asio::io_context* io, const Participant& participant) {
  const auto add = [&](const char* topic, const dds_topic_descriptor_t& type, Profile profile,
                       Subscriber::OnMessage on_message) {
    subscribers_.push_back(std::make_unique<Subscriber>(participant, io,
                                                        topic_on_wire(options_.name_space, topic),
                                                        type, profile, std::move(on_message)));
    return subscribers_.back().get();
  };
  if (options_.drive) {
    velocities_ = add("cmd_vel",
                      options_.stamped ? geometry_msgs_msg_dds__TwistStamped__desc
                                       : geometry_msgs_msg_dds__Twist__desc,
                      Profile::kNewest, [this](const void* message) { on_twist(message); });
  }
  if (!options_.estop) return;
  // The reliable one asks again for what was lost; the other one hears publishers that are not.
  for (const Profile profile : {Profile::kDefault, Profile::kNewest}) {
    add("e_stop", std_msgs_msg_dds__Bool__desc, profile, [this](const void* message) {
      if (static_cast<const std_msgs_msg_dds__Bool_*>(message)->data) on_estop();
    });
  }
}

void Bridge::start() {
  source_.start();
  if (options_.drive) drive_tick();
  diagnose();
}

void Bridge::stop() {
  subscribers_.clear();
  drive_timer_.cancel();
  diagnostics_timer_.cancel();
  estop_timer_.cancel();
  source_.stop();
  drive_relay_->end();
  estop_relay_->end();
}

Stamp Bridge::stamp() const { return options_.sim_time ? to_stamp(tick_time_) : now(); }

void Bridge::on_robot() {
  if (!source_.connected()) {
    if (drive_.driving()) drive_.hold("gaitd has gone");
    drive_.set_robot("", "");
    robot_ = nullptr;
    status_ = nullptr;
    silent_ = 0.0;
    spdlog::warn("not connected: {}", source_.reason());
    return;
  }
  robot_error_.clear();
  estop_error_.clear();
  robot_ = RobotMessages::create(source_.robot(), source_.signals(), &robot_error_);
  if (!robot_) {
    spdlog::error("{}", robot_error_);
    return;
  }
  spdlog::info("connected to gaitd {}: robot {}, backend {}", source_.version(),
               member(source_.robot(), "name"), member(source_.robot(), "backend"));
  topics_.publish_robot(robot_.get(), stamp());
  if (options_.estop) estop_relay_->connect_ahead();
  if (options_.drive) drive_relay_->connect_ahead();
}

void Bridge::on_status(const json& status, double silent) {
  silent_ = silent;
  status_ = status;
  if (status.is_object()) drive_.set_robot(member(status, "state"), member(status, "mode"));
}

void Bridge::on_frame(const cli::LiveFrame& frame) {
  tick_time_ = frame.time;
  const Stamp at = stamp();
  topics_.publish_clock(at);
  if (robot_ && robot_->read(frame.values, at)) topics_.publish_tick(*robot_);
}

void Bridge::on_twist(const void* message) {
  const auto& twist = options_.stamped
                          ? static_cast<const geometry_msgs_msg_dds__TwistStamped_*>(message)->twist
                          : *static_cast<const geometry_msgs_msg_dds__Twist_*>(message);
  drive_.on_velocity({twist.linear.x, twist.linear.y, twist.angular.z}, Clock::now());
  look_at_drive();
}

void Bridge::on_estop() {
  drive_.hold("the robot was stopped by /e_stop");
  if (estop_until_ && Clock::now() < *estop_until_) return;
  estop_heard_ = Clock::now();
  estop_until_ = estop_heard_ + kEstopPatience;
  estop_answer_ = kEstopAnswer;
  estop_told_ = false;
  spdlog::warn("e-stop: asked for on {}/e_stop", options_.name_space);
  ask_estop();
}

// Until gaitd has taken it: whoever publishes once does not ask again.
void Bridge::ask_estop() {
  estop_relay_->call("estop", nullptr, [this](const json& answer) {
    estop_heard_ = Clock::now();
    estop_error_ = member(answer.value("error", json()), "message");
    if (!estop_error_.empty()) {
      if (!std::exchange(estop_told_, true)) {
        spdlog::critical("e-stop: the robot may not have stopped: {}", estop_error_);
      }
      return;
    }
    spdlog::warn("e-stop: gaitd has taken it");
    estop_until_.reset();
    estop_timer_.cancel();
  });
  estop_timer_.expires_after(kEstopAgain);
  estop_timer_.async_wait([this](boost::system::error_code error) {
    if (!error && estop_until_) look_at_estop(Clock::now());
  });
}

// Where nobody answers, what was asked is answered here, and asked again on another connection.
void Bridge::look_at_estop(Clock::time_point now) {
  const bool over = now >= *estop_until_;
  if (over || now - estop_heard_ > estop_answer_) {
    estop_relay_->reconnect(kNoAnswer);
    estop_answer_ *= 2;  // a long way has its answers too
  }
  if (!over) return ask_estop();
  estop_until_.reset();
  spdlog::critical("e-stop: given up, the robot may not have stopped; use its own e-stop");
}

void Bridge::drive_tick() {
  drive_.tick(Clock::now());
  look_at_drive();
  drive_timer_.expires_after(kDriveTick);
  drive_timer_.async_wait([this](boost::system::error_code error) {
    if (!error) drive_tick();
  });
}

// Says each trouble once while it lasts.
void Bridge::look_at_drive() {
  const std::string& trouble = drive_.trouble();
  if (trouble.empty()) {
    if (trouble_at_ && Clock::now() - *trouble_at_ > kTroubleShown) trouble_.clear();
    return;
  }
  trouble_at_ = Clock::now();
  if (trouble == trouble_) return;
  trouble_ = trouble;
  spdlog::warn("cmd_vel: {}", trouble);
}

Diagnosis Bridge::diagnose_connection() const {
  Diagnosis result{.level = Level::kOk, .name = "gaitd: connection", .message = "", .values = {}};
  result.values.emplace_back("gaitd", source_.version());
  if (!source_.connected()) {
    result.level = Level::kError;
    result.message = source_.reason();
  } else if (!robot_) {
    result.level = Level::kError;
    result.message = robot_error_;
  } else if (!estop_error_.empty()) {
    result.level = Level::kError;
    result.message = "an e-stop did not reach gaitd: " + estop_error_;
  } else {
    result.message = "connected";
  }
  return result;
}

Diagnosis Bridge::diagnose_drive() const {
  Diagnosis result{.level = Level::kOk, .name = "gaitd: cmd_vel", .message = "", .values = {}};
  result.message = drive_.driving() ? "driving" : "no velocity";
  result.values.emplace_back("publishers", std::to_string(velocities_->publishers()));
  result.values.emplace_back("refused messages", std::to_string(drive_.refused_messages()));
  if (trouble_at_ && Clock::now() - *trouble_at_ < kTroubleShown) {
    result.level = Level::kWarn;
    result.message = trouble_;
  }
  return result;
}

void Bridge::diagnose() {
  std::vector<Diagnosis> parts = {diagnose_connection(), diagnose_robot(status_, silent_),
                                  diagnose_timing(status_)};
  if (velocities_ != nullptr) parts.push_back(diagnose_drive());
  topics_.publish_diagnostics(
      diagnostics_.fill(std::move(parts), member(source_.robot(), "name"), stamp()));
  diagnostics_timer_.expires_after(kDiagnostics);
  diagnostics_timer_.async_wait([this](boost::system::error_code error) {
    if (!error) diagnose();
  });
}

}  // namespace gaitd::ros2
