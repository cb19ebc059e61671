// SPDX-License-Identifier: Apache-2.0
// A backend on any physics engine. In one file of the plugin:
//
//   struct MyEngine : gaitd::sim::SimulatedBackend {
//     explicit MyEngine(const GaitdHost& host) : SimulatedBackend(host, make_my_physics) {}
//   };
//   GAITD_EXPORT_BACKEND(MyEngine, "my_engine", "1.0.0", 50.0, GAITD_CAPABILITY_SIMULATION)
#ifndef GAITD_SIM_SIMULATED_BACKEND_H_
#define GAITD_SIM_SIMULATED_BACKEND_H_

#include <memory>
#include <string>

#include "gaitd/abi/backend.h"
#include "gaitd/sdk/backend.h"
#include "gaitd/sim/physics.h"

namespace gaitd::sim {

class PlantRunner;

class SimulatedBackend {
 public:
  SimulatedBackend(const GaitdHost& host, PhysicsFactory make);
  ~SimulatedBackend();

  // See gaitd/sdk/backend.h. `config`: the JSON text that parse_config() reads.
  std::string init(const GaitdModel& model, const std::string& config, double period, int clock);
  GaitdStatus start();
  GaitdStatus read(GaitdSensors& sensors);
  GaitdStatus write(const GaitdJointCommands& commands);
  GaitdStatus advance();
  GaitdStatus truth(GaitdTruth& truth);
  GaitdStatus disturb(const GaitdDisturbance& disturbance);
  GaitdStatus carry(const GaitdLoad& load);
  GaitdStatus reset();
  void stop();

 private:
  GaitdHost host_;
  PhysicsFactory make_;
  std::unique_ptr<PlantRunner> runner_;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_SIMULATED_BACKEND_H_
