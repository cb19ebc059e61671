// SPDX-License-Identifier: Apache-2.0
// A robot on CAN buses: one batch of commands and one of replies per bus and cycle.
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bus_claim.h"
#include "can_bus.h"
#include "estop_monitor.h"
#include "gaitd/abi/backend.h"
#include "moment.h"
#include "sensor_sample.h"
#include "wiring.h"

namespace gaitd::can {

struct RobotOptions {
  double period = 0.001;          // s
  bool lockstep = false;          // advance() waits for the replies of a cycle
  double lockstep_timeout = 0.5;  // s of wall time that it waits at most
  Clocks* clocks = &Clocks::system();
};

// A motor is switched on by the first torque command and off by stop(), by an error of its own and
// by its bus going down; until it is switched on, damping commands keep it off. It goes on only by
// a torque command again, which the daemon sends only after an operator armed it.
//
// read(), write() and health() neither block nor allocate; health() may be called by any thread,
// the others by one at a time.
class CanRobot {
 public:
  using Log = std::function<void(int level, const std::string& line)>;

  CanRobot(Wiring wiring, const GaitdModel& model, const RobotOptions& options, Log log);
  ~CanRobot() { stop(); }
  CanRobot(const CanRobot&) = delete;
  CanRobot& operator=(const CanRobot&) = delete;

  // Opens the buses, compares the motors with the wiring, switches them off and reads their first
  // state. False: everything that is wrong is in `errors`.
  bool start(std::vector<std::string>* errors);
  GaitdStatus read(GaitdSensors* sensors);
  GaitdStatus write(const GaitdJointCommands& commands);
  GaitdStatus advance();
  void health(GaitdHealth* health) const;
  // Switches the motors off on every bus that is open, before anything else, and gives up after
  // 0.1 s with those whose bus takes no frames; then reports the counters and closes the buses.
  void stop();

 private:
  struct MotorState {
    bool enabled = false;
    bool awaiting = false;  // of this cycle
    bool valid = false;
    uint8_t error = 0;    // of the last reply
    uint8_t told = 0;     // a fault that came by itself, until the motor is told to forget it
    bool clears = false;  // in the frame of this cycle it is told to
    int cycles_enabled = 0;
    uint32_t owed = 0;  // replies of earlier cycles that may still come
    uint32_t sequence = 0;
    Moment moment;                                  // of the last reply
    double position = 0, velocity = 0, torque = 0;  // of the joint
  };
  struct Counters {
    std::atomic<uint32_t> late{0}, missing{0}, duplicate{0}, stale{0};
  };
  struct BusState {
    BusClaim claim;
    std::unique_ptr<CanBus> bus;
    bool down = false;
    bool fell = false;  // went down since the last look at the conditions
    bool passive = false;
    bool cycle_over = false;  // lockstep: nothing more comes in this cycle
    int ends_owed = 0;        // lockstep: ends of earlier cycles that are still to come
    int unsent_in_row = 0;
    std::array<int16_t, 2048> routes{};   // by identifier: what sends it, see Route
    std::array<int16_t, 256> shared{};    // by motor id: who replies with the identifier 0
    std::array<int16_t, 256> extended{};  // by motor id: who replies with 29 bits
    std::vector<Frame> frames;            // to send
    std::vector<int> motors;              // whose they are
  };

  bool open(std::vector<std::string>* errors);
  void check_motors(std::vector<std::string>* errors);
  std::string check_motor(const Motor& motor);
  void switch_off();
  bool read_register(const Motor& motor, uint16_t address, RegisterValue* value);
  void wait_and_receive(double seconds);
  void receive();
  void receive(int bus);
  void take(int bus, const Received& received);
  void take_reply(int motor, const Received& received);
  void take_sensor(SensorSample* sample, int part, double unit, const Received& received,
                   Counters* counters);
  Frame frame_for(int motor, const GaitdJointCommand& command);
  Frame command_frame(const Motor& motor, const GaitdJointCommand& command) const;
  void send(int bus);
  void switch_off_bus(int bus);
  // Switched on, and it says that it is off.
  bool told_but_off(int motor) const;
  bool faulty(int motor) const;
  uint8_t fault_of(int motor) const;  // MotorError, or 0
  bool complete() const;
  void find_conditions(int64_t now_ns);
  EstopLife estop_life(int64_t now_ns) const;
  double age(const Moment& moment, int64_t now_ns) const;
  GaitdSignalInfo info(bool valid, uint32_t sequence, const Moment& moment, int64_t now_ns) const;

  Wiring wiring_;
  RobotOptions options_;
  Log log_;
  std::vector<std::string> names_;  // of the joints
  Clocks& clocks_;
  std::vector<BusState> buses_;
  std::vector<MotorState> motors_;
  std::vector<SensorSample> imus_, feet_;
  EstopMonitor estop_;
  std::vector<std::string> senders_;      // who sends: motors, IMUs, feet, e-stop
  std::unique_ptr<Counters[]> counters_;  // of each of them
  int64_t cycle_ = 0;                     // counts write()
  std::atomic<uint32_t> conditions_{0}, lost_{0}, unsent_{0};
  std::atomic<int> bad_motor_{-1}, bad_bus_{-1};
  std::atomic<uint8_t> bad_error_{0};
  std::atomic<EstopLife> estop_life_{EstopLife::kNeverHeard};
};

}  // namespace gaitd::can
