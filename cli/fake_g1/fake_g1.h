// SPDX-License-Identifier: Apache-2.0
// The robot's side of Unitree's DDS interface: a simulated G1 with its built-in services.
#pragma once

#include <array>
#include <deque>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "cli/fake_g1/fault_plan.h"
#include "dds_node.h"
#include "gaitd/sim/plant.h"
#include "joints.h"

namespace gaitd::cli::g1 {

// What the robot does with its motors when commands cease. Nobody published what the real one does.
enum class Silence { kDamp, kLimp, kHold };

struct Options {
  std::string interface = "lo";
  int domain = 1;
  bool lockstep = false;
  double period = 0.001;  // s of the plant
  double rate = 1000;     // Hz of the states, in real time
  double patience = 1;    // s of wall time that a lock step waits for the command
  int machine = 5;        // mode_machine
  double silence = 0.1;   // s without a command, then `reaction`
  Silence reaction = Silence::kDamp;
  double delay = 0;       // s between a command and its effect, whole periods
  double gain = 1;        // of every torque that a motor is told
  double rate_noise = 0;  // rad/s, sigma, of dq
  double force_bias = 0;  // m/s^2, of the accelerometer along each axis
  std::string mode;       // built-in walking that commands until it is released; "": none
  std::string feet;       // topic of added foot force sensors; "": none
  std::vector<Fault> faults;
};

// Until it is driven for the first time it hangs on its hoist: as it started, at rest.
class FakeG1 {
 public:
  FakeG1(const GaitdModel& model, std::unique_ptr<sim::Plant> plant, Options options);
  ~FakeG1();

  // One period, or in lock step as many as were answered within 0.05 s.
  void serve();
  // What happened, for tests.
  nlohmann::json report() const;

 private:
  struct Motor {
    uint32_t error = 0;
    int winding = 45;  // °C
    bool off = false;
    bool nan = false;
  };
  struct Refusals {
    int64_t crc = 0, machine = 0, frame = 0, other_topic = 0;
  };

  void advance();
  void send_state();
  void send_feet(const GaitdSensors& sensors);
  void send_slow();
  void fill(const GaitdSensors& sensors);
  bool take_commands();  // true: the one that answers this cycle was among them
  bool accept(const unitree::LowCmd& command, bool user);
  void send_foreign();
  void answer_services();
  int answer(int64_t api, const std::string& parameter, bool sport, std::string* data);
  void apply_due_faults();
  void apply(const Fault& fault);
  void end_due_faults();
  GaitdJointCommands plant_commands();
  bool silent_for(double seconds) const;
  double now() const;  // s of the robot's clock
  void event(const std::string& what);

  const GaitdModel model_;
  std::unique_ptr<sim::Plant> plant_;
  Options options_;
  std::array<int, GAITD_MAX_JOINTS> wire_{};
  unitree::DdsNode node_;
  dds_entity_t states_, slow_states_, torso_, battery_,
      feet_ = 0, commands_, user_commands_, foreign_, twin_ = 0, requests_[2], answers_[2],
      waitset_;

  unitree::LowState state_;  // padding all zero
  unitree::LowCmd received_, command_, foreign_message_;
  std::deque<std::pair<int64_t, unitree::LowCmd>> on_the_way_;  // cycle of its effect
  std::array<Motor, unitree::kMotors> motors_;
  std::vector<Fault> pending_;

  uint64_t cycle_ = 1;  // of the state that is shown
  uint64_t filled_cycle_ = 0;
  GaitdSensors sensors_{};   // of that cycle
  int64_t moving_ = 0;       // cycles since it was first driven
  int64_t heard_cycle_ = 0;  // of the last accepted command
  bool commanded_ = false, hung_ = true, user_ = false, reacting_ = false, diverged_ = false;
  double start_ = 0, next_ = 0, cycle_since_ = 0;  // s, wall
  int64_t published_ = 0;
  uint64_t random_;
  // Ends of what stands for a while, s of the robot's clock; 0: for ever or not at all.
  double silent_until_ = 0, keys_until_ = 0, writer_until_ = 0, deaf_until_ = 0;
  bool silent_ = false, stuck_ = false, crc_wrong_ = false, torso_silent_ = false,
       feet_silent_ = false, writer_ = false, deaf_ = false;
  int crc_every_ = 0, lose_every_ = 0;
  uint16_t keys_ = 0;
  int machine_, frame_ = 0, charge_ = 80;
  uint32_t tick_shift_ = 0, stuck_tick_ = 0;

  int64_t accepted_ = 0, unanswered_ = 0, heard_ = 0;
  Refusals refused_;
  int64_t fault_cycle_ = -1, damped_cycle_ = -1, last_driven_cycle_ = -1;
  double lowest_pelvis_ = 1e9;
  std::array<double, 3> pelvis_{};
  std::vector<std::string> events_;
};

}  // namespace gaitd::cli::g1
