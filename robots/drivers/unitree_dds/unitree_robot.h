// SPDX-License-Identifier: Apache-2.0
// A Unitree humanoid as gaitd sees it: commands into the exchange with the link, states out of it.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "exchange.h"
#include "gaitd/abi/backend.h"
#include "link_process.h"
#include "settings.h"

namespace gaitd::unitree {

struct RobotOptions {
  double period = 0.001;     // s
  bool lockstep = false;     // advance() waits for the state after the command
  std::string link_program;  // executable
};

// read(), write() and health() neither block nor allocate; health() may be called by any thread,
// the others by one at a time.
class UnitreeRobot {
 public:
  using Log = LinkProcess::Log;

  UnitreeRobot(const Settings& settings, const GaitdModel& model, const RobotOptions& options,
               Log log);
  ~UnitreeRobot() { stop(); }
  UnitreeRobot(const UnitreeRobot&) = delete;
  UnitreeRobot& operator=(const UnitreeRobot&) = delete;

  // Takes control of the robot, which is damped from then on. False: the reasons are in `errors`.
  bool start(std::vector<std::string>* errors);
  GaitdStatus read(GaitdSensors* sensors);
  GaitdStatus write(const GaitdJointCommands& commands);
  GaitdStatus advance();
  void health(GaitdHealth* health) const;
  // The robot is damped when this returns, for damp_time more, whatever becomes of gaitd.
  void stop();

  pid_t link() const { return link_.pid(); }

 private:
  double age(int64_t stamp_ns, int64_t now_ns) const;
  GaitdSignalInfo info(uint32_t sequence, int64_t stamp_ns, int64_t now_ns) const;
  void fill_imu(const ImuReading& reading, int64_t now_ns, GaitdImuSensor* imu) const;
  void find_conditions();

  Settings settings_;
  GaitdModel model_;
  RobotOptions options_;
  Log log_;
  bool has_foot_sensors_;
  LinkProcess link_;
  State state_{};
  int64_t tick_ = 0;    // counts write()
  int64_t behind_ = 0;  // lockstep: periods since the newest state
  bool started_ = false;
  uint32_t estops_ = 0;
  std::atomic<uint32_t> conditions_{GAITD_HEALTH_BUS};  // until it is started
};

}  // namespace gaitd::unitree
