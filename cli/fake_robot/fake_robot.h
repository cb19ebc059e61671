// SPDX-License-Identifier: Apache-2.0
// The other side of the CAN buses: motors, sensors and e-stop of a simulated robot.
#pragma once

#include <array>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "can_bus.h"
#include "cli/fake_robot/fault_plan.h"
#include "gaitd/sim/plant.h"
#include "wiring.h"

namespace gaitd::cli {

struct FakeRobotOptions {
  double period = 0.001;       // s, of the plant for each cycle of commands
  double motor_timeout = 0.1;  // s, that the registers say
  double stall_time = 0.1;     // s of wall time without a command, then a motor switches off
  double patience = 1.0;       // s of wall time, then commands that miss are not waited for
  std::vector<Fault> faults;
};

// A cycle is over when every motor got its command; then the plant advances one period and every
// motor answers with the state after it. While all motors are off the robot hangs on its hoist: as
// it started, at rest.
class FakeRobot {
 public:
  FakeRobot(const GaitdModel& model, can::Wiring wiring, std::unique_ptr<sim::Plant> plant,
            FakeRobotOptions options);
  ~FakeRobot();

  // False: `error` says which bus cannot be opened, or which fault has no such target.
  bool start(std::string* error);
  // Handles what has come in, waiting for `seconds` at most.
  void serve(double seconds);
  // What happened, for tests: cycles, torque frames, events, the state of each motor.
  nlohmann::json report() const;

 private:
  struct MotorState {
    bool enabled = false;
    bool commanded = false;  // in this cycle
    bool silent = false;
    bool duplicate = false;
    bool shortened = false;
    int lose = 0;  // every so many commands, 0: none
    int64_t commands = 0;
    uint8_t error = 0;
    double range = 0;         // PMAX that the register says
    double timeout = 0;       // s, likewise
    double last_command = 0;  // s, wall
    bool damping = false;
    GaitdJointCommand command{};
  };
  struct SenderState {
    bool silent = false;
    bool shortened = false;
    bool stuck = false;  // its counter
    int64_t counter = 0;
  };
  struct BusState {
    std::unique_ptr<can::CanBus> bus;
    std::vector<can::Frame> frames;
    bool heard = true;    // it took part in one of the last cycles
    double up_again = 0;  // s, wall
    bool off = false;     // bus-off: nothing goes in or out
  };

  bool apply(const Fault& fault, std::string* error);
  void take(int bus, const can::Frame& frame);
  void take_command(int motor, const can::Frame& frame);
  void answer_register(int motor, uint16_t address);
  bool cycle_complete() const;
  void begin_cycle();
  void end_cycle();
  void forget_commands(int asked_bus);
  void advance_plant();
  void answer();
  void answer_sensors(const GaitdSensors& sensors);
  void answer_sample(SenderState* state, const can::Sender& sender, const double (&first)[3],
                     double first_unit, const double (&second)[3], double second_unit);
  void watch_stalls();
  void set_interface(int bus, bool up);
  void set_bus_off(int bus, bool off);
  double plant_time() const;
  void event(const std::string& what);

  const GaitdModel model_;
  const can::Wiring wiring_;
  std::unique_ptr<sim::Plant> plant_;
  const FakeRobotOptions options_;
  std::vector<Fault> pending_;
  std::vector<BusState> buses_;
  std::vector<MotorState> motors_;
  std::vector<SenderState> imus_, feet_;
  SenderState estop_;
  bool estop_pressed_ = false;
  double estop_release_ = 0;
  int64_t cycle_ = 0;          // complete ones
  int64_t moving_cycles_ = 0;  // since the first motor went on
  double now_ = 0;             // s, wall, of this serve()
  double cycle_start_ = 0;     // s, wall; 0: no command yet
  int64_t first_torque_cycle_ = -1, last_torque_cycle_ = -1, fault_cycle_ = -1;
  bool moved_ = false;                   // in the last cycle
  std::array<double, 3> last_pelvis_{};  // when it moved, m
  double lowest_pelvis_ = 1e9;
  std::vector<std::string> events_;
};

}  // namespace gaitd::cli
