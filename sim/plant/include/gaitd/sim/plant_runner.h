// SPDX-License-Identifier: Apache-2.0
// Runs a plant for a controller: between its ticks (lockstep) or in a thread of its own (realtime).
#ifndef GAITD_SIM_PLANT_RUNNER_H_
#define GAITD_SIM_PLANT_RUNNER_H_

#include <semaphore.h>

#include <atomic>
#include <memory>
#include <thread>

#include "gaitd/abi/backend.h"
#include "gaitd/sim/latest_value.h"
#include "gaitd/sim/plant.h"
#include "gaitd/sim/spsc_ring.h"

namespace gaitd::sim {

// In realtime every written command is queued and the plant advances exactly one period for each,
// so plant time counts control ticks and a late plant loses no command. read(), write(), truth(),
// disturb() and carry() are for the control thread: wait-free, no allocation in realtime. The
// others are for any one thread while the control thread is in none of those.
class PlantRunner {
 public:
  // `clock`: GAITD_CLOCK_REALTIME or GAITD_CLOCK_LOCKSTEP. `host` may be null; it hears about a
  // plant thread that gives up.
  PlantRunner(std::unique_ptr<Plant> plant, const std::vector<SensorFault>& faults, int32_t clock,
              const GaitdHost* host);
  ~PlantRunner();
  PlantRunner(const PlantRunner&) = delete;
  PlantRunner& operator=(const PlantRunner&) = delete;

  void start();
  void stop();

  // Back to the start state, as after construction; what was queued is forgotten.
  void reset();

  // GAITD_NOT_READY: nothing newer than the last read. GAITD_ERROR: the simulation diverged.
  GaitdStatus read(GaitdSensors* sensors);
  // GAITD_INVALID_ARGUMENT: see check_commands(); nothing is queued. GAITD_NOT_READY: the plant is
  // kQueue periods late.
  GaitdStatus write(const GaitdJointCommands& commands);
  // GAITD_NOT_SUPPORTED: realtime.
  GaitdStatus advance();
  // As of the last read in realtime, of now in lockstep.
  GaitdStatus truth(GaitdTruth* truth);
  GaitdStatus disturb(const GaitdDisturbance& disturbance);
  GaitdStatus carry(const GaitdLoad& load);

 private:
  static constexpr size_t kQueue = 256;
  static constexpr size_t kPushes = 64;
  static constexpr size_t kLoads = 16;

  struct Output {
    GaitdSensors sensors;
    GaitdTruth truth;
  };

  bool lockstep() const { return clock_ == GAITD_CLOCK_LOCKSTEP; }
  void publish();
  bool take();
  void run();
  void run_one_period();

  std::unique_ptr<Plant> plant_;
  SensorFaults faults_;
  int32_t clock_;
  const GaitdHost* host_;
  int joint_count_;
  int body_count_;
  bool can_carry_;
  GaitdJointCommands last_command_{};  // lockstep
  bool unread_ = false;                // control thread: front() was not read yet
  std::atomic<bool> diverged_{false};
  LatestValue<Output> output_;

  SpscRing<GaitdJointCommands, kQueue> commands_;
  SpscRing<GaitdDisturbance, kPushes> pushes_;
  SpscRing<GaitdLoad, kLoads> loads_;
  GaitdJointCommands command_{};  // plant thread
  sem_t wake_;                    // one post for each command, and one to stop
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_PLANT_RUNNER_H_
