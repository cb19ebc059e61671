// SPDX-License-Identifier: Apache-2.0
#include "cli/fake_g1/fake_g1.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "crc.h"
#include "packing.h"

namespace gaitd::cli::g1 {
namespace {

constexpr uint64_t kSeed = 0x9E3779B97F4A7C15u;  // of the noise
constexpr double kServe = 0.05;     // s that a lock step looks for an answer before it looks around
constexpr double kRepeat = 0.02;    // s until a state that nobody answered is sent again
constexpr double kCatchUp = 0.02;   // s that a late machine makes up for; more is left out
constexpr double kSafeDamping = 3;  // N m s/rad, of a robot that damps by itself

double wall() {
  using Clock = std::chrono::steady_clock;
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

}  // namespace

FakeG1::FakeG1(const GaitdModel& model, std::unique_ptr<sim::Plant> plant, Options options)
    : model_(model),
      plant_(std::move(plant)),
      options_(std::move(options)),
      node_(options_.domain, options_.interface),
      pending_(options_.faults),
      random_(kSeed),
      machine_(options_.machine) {
  using namespace unitree;  // NOLINT(google-build-using-namespace): of this function
  for (int i = 0; i < model_.joint_count; ++i) wire_[i] = wire_index(model_.joints[i].name);
  std::memset(&state_, 0, sizeof(state_));
  for (LowCmd* message : {&received_, &command_, &foreign_message_}) {
    std::memset(message, 0, sizeof(*message));
  }
  states_ = node_.writer(kLowState, unitree_hg_msg_dds__LowState__desc);
  slow_states_ = node_.writer("rt/lf/lowstate", unitree_hg_msg_dds__LowState__desc);
  torso_ = node_.writer(kTorsoImu, unitree_hg_msg_dds__IMUState__desc);
  battery_ = node_.writer(kBattery, unitree_hg_msg_dds__BmsState__desc);
  if (!options_.feet.empty()) {
    feet_ = node_.writer(options_.feet.c_str(), gaitd_msg_dds__FootWrenches__desc);
  }
  commands_ = node_.reader(kLowCmd, unitree_hg_msg_dds__LowCmd__desc, 1, true);
  user_commands_ = node_.reader(kUserLowCmd, unitree_hg_msg_dds__LowCmd__desc, 1, true);
  foreign_ = node_.writer(kLowCmd, unitree_hg_msg_dds__LowCmd__desc);
  const char* services[2] = {"motion_switcher", "sport"};
  waitset_ = node_.waitset();
  for (int i = 0; i < 2; ++i) {
    const std::string base = std::string("rt/api/") + services[i];
    requests_[i] =
        node_.reader((base + "/request").c_str(), unitree_api_msg_dds__Request__desc, 10);
    answers_[i] = node_.writer((base + "/response").c_str(), unitree_api_msg_dds__Response__desc);
    node_.attach(waitset_, requests_[i]);
  }
  node_.attach(waitset_, commands_);
  node_.attach(waitset_, user_commands_);
  for (const Fault& fault : pending_) {
    if (fault.time == 0) apply(fault);
  }
  std::erase_if(pending_, [](const Fault& fault) { return fault.time == 0; });
  start_ = next_ = cycle_since_ = wall();
}

FakeG1::~FakeG1() = default;

void FakeG1::event(const std::string& what) {
  char time[32];
  std::snprintf(time, sizeof(time), "%.3f ", static_cast<double>(moving_) * options_.period);
  events_.push_back(time + what);
}

double FakeG1::now() const { return static_cast<double>(cycle_) * options_.period; }

bool FakeG1::silent_for(double seconds) const {
  return static_cast<double>(static_cast<int64_t>(cycle_) - heard_cycle_) * options_.period >
         seconds;
}

// As the robot's firmware is known to: a wrong CRC, mode_machine or frame, and nothing moves.
bool FakeG1::accept(const unitree::LowCmd& command, bool user) {
  if (user != user_) {
    ++refused_.other_topic;
    return false;
  }
  if (command.crc != unitree::message_crc(command)) {
    ++refused_.crc;
    return false;
  }
  if (command.mode_machine != machine_) {
    ++refused_.machine;
    return false;
  }
  if (command.mode_pr != frame_) {
    ++refused_.frame;
    return false;
  }
  return true;
}

bool FakeG1::take_commands() {
  bool answered = false;
  for (const bool user : {false, true}) {
    while (unitree::take_sample(user ? user_commands_ : commands_, &received_)) {
      ++heard_;
      if (deaf_ || (lose_every_ > 0 && heard_ % lose_every_ == 0)) continue;
      // One that repeats an earlier answer is of a cycle that is over; whom no state reaches can
      // name none. What is refused is an answer as well.
      const bool answers = unitree::cycle_of(received_) == cycle_ || silent_;
      answered = answered || answers;
      if (!accept(received_, user) || (options_.lockstep && !answers)) continue;
      ++accepted_;
      heard_cycle_ = static_cast<int64_t>(cycle_);
      if (std::exchange(reacting_, false)) event("commands come again");
      const auto delay = static_cast<int64_t>(options_.delay / options_.period + 0.5);
      on_the_way_.emplace_back(static_cast<int64_t>(cycle_) + delay, received_);
    }
  }
  while (!on_the_way_.empty() && on_the_way_.front().first <= static_cast<int64_t>(cycle_)) {
    command_ = on_the_way_.front().second;
    commanded_ = true;
    on_the_way_.pop_front();
  }
  return answered;
}

// What the motors do with the last command.
GaitdJointCommands FakeG1::plant_commands() {
  GaitdJointCommands commands{};
  commands.size = sizeof(commands);
  commands.joint_count = model_.joint_count;
  const bool limp = reacting_ && options_.reaction == Silence::kLimp;
  const bool damp = reacting_ && options_.reaction == Silence::kDamp;
  for (int i = 0; i < model_.joint_count; ++i) {
    const unitree::MotorCmd& motor = command_.motor_cmd[wire_[i]];
    const Motor& condition = motors_[wire_[i]];
    GaitdJointCommand& c = commands.joints[i];
    c.mode = GAITD_JOINT_MODE_OFF;
    if (motor.mode == 0 || condition.off || condition.error != 0 || limp) continue;
    c.mode = GAITD_JOINT_MODE_TORQUE;
    c.damping = damp ? kSafeDamping : options_.gain * motor.kd;
    if (damp) continue;
    c.torque = options_.gain * motor.tau;
    c.position = motor.q;
    c.velocity = motor.dq;
    c.stiffness = options_.gain * motor.kp;
  }
  return commands;
}

void FakeG1::advance() {
  bool driven = false, on = false;
  for (const unitree::MotorCmd& motor : command_.motor_cmd) {
    on = on || motor.mode != 0;
    driven = driven || (motor.mode != 0 && (motor.kp != 0 || motor.tau != 0));
  }
  if (commanded_ && driven && !reacting_) last_driven_cycle_ = static_cast<int64_t>(cycle_);
  if (commanded_ && !driven && on && fault_cycle_ >= 0 && damped_cycle_ < 0) {
    damped_cycle_ = static_cast<int64_t>(cycle_);
  }
  if (hung_ && driven) {
    hung_ = false;
    random_ = kSeed;  // however long the driver took to come
    event("driven");
  }
  if (!hung_) {
    if (!reacting_ && silent_for(options_.silence)) {
      reacting_ = true;
      event("commands ceased");
    }
    if (!plant_->advance(plant_commands()) && !std::exchange(diverged_, true)) {
      event("the simulation diverged");
    }
    ++moving_;
    GaitdTruth truth{};
    plant_->read(&truth);
    std::copy_n(truth.pelvis_position, 3, pelvis_.begin());
    lowest_pelvis_ = std::min(lowest_pelvis_, pelvis_[2]);
  }
  ++cycle_;
  apply_due_faults();
  end_due_faults();
}

void FakeG1::serve() {
  answer_services();
  if (options_.lockstep) {
    const double end = wall() + kServe;
    double sent = 0;
    while (wall() < end) {
      if (sent == 0 || wall() > sent + kRepeat) {
        send_state();
        sent = wall();
      }
      dds_waitset_wait(waitset_, nullptr, 0, DDS_MSECS(10));
      answer_services();
      const bool late = wall() > cycle_since_ + options_.patience;
      if (!take_commands() && !late) continue;
      if (late) ++unanswered_;
      advance();
      cycle_since_ = wall();
      sent = 0;
      if (cycle_ % 50 == 0) send_slow();
      send_foreign();
    }
    return;
  }
  next_ += 1 / options_.rate;
  if (wall() > next_ + kCatchUp) {
    const double left_out = wall() - next_;
    next_ += left_out;
    start_ += left_out;
  }
  std::this_thread::sleep_for(std::chrono::duration<double>(next_ - wall()));
  take_commands();
  while (now() <= next_ - start_) advance();
  send_state();
  if (++published_ % 50 == 0) send_slow();
  if (published_ % 20 == 0) send_foreign();
}

nlohmann::json FakeG1::report() const {
  nlohmann::json report;
  report["cycles"] = cycle_;
  report["plant_time"] = static_cast<double>(moving_) * options_.period;
  report["accepted"] = accepted_;
  report["unanswered"] = unanswered_;
  report["refused"] = {{"crc", refused_.crc},
                       {"machine", refused_.machine},
                       {"frame", refused_.frame},
                       {"other_topic", refused_.other_topic}};
  report["fault_cycle"] = fault_cycle_;
  report["damped_cycle"] = damped_cycle_;
  report["last_driven_cycle"] = last_driven_cycle_;
  report["lowest_pelvis"] = lowest_pelvis_;
  report["pelvis"] = pelvis_;
  report["mode"] = options_.mode;
  report["user"] = user_;
  report["events"] = events_;
  int driven = 0, damped = 0;
  for (const unitree::MotorCmd& motor : command_.motor_cmd) {
    const bool drives = motor.kp != 0 || motor.tau != 0;
    driven += motor.mode != 0 && drives ? 1 : 0;
    damped += motor.mode != 0 && !drives ? 1 : 0;
  }
  report["motors"] = {{"driven", driven}, {"damped", damped}};
  return report;
}

}  // namespace gaitd::cli::g1
