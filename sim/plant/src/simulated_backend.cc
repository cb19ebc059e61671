// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/simulated_backend.h"

#include <utility>
#include <vector>

#include "gaitd/sim/config.h"
#include "gaitd/sim/plant.h"
#include "gaitd/sim/plant_runner.h"

namespace gaitd::sim {

SimulatedBackend::SimulatedBackend(const GaitdHost& host, PhysicsFactory make)
    : host_(host), make_(std::move(make)) {}

SimulatedBackend::~SimulatedBackend() = default;

std::string SimulatedBackend::init(const GaitdModel& model, const std::string& config,
                                   double period, int clock) {
  std::vector<std::string> errors;
  const Config parsed = parse_config(config, model, period, &errors);
  std::string text;
  for (const std::string& line : errors) text += (text.empty() ? "" : "\n") + line;
  if (!text.empty()) return text;
  runner_ = std::make_unique<PlantRunner>(std::make_unique<Plant>(model, parsed, period, make_),
                                          parsed.sensor_faults, clock, &host_);
  return "";
}

GaitdStatus SimulatedBackend::start() {
  runner_->start();
  return GAITD_OK;
}

GaitdStatus SimulatedBackend::read(GaitdSensors& sensors) { return runner_->read(&sensors); }

GaitdStatus SimulatedBackend::write(const GaitdJointCommands& commands) {
  return runner_->write(commands);
}

GaitdStatus SimulatedBackend::advance() { return runner_->advance(); }

GaitdStatus SimulatedBackend::truth(GaitdTruth& truth) { return runner_->truth(&truth); }

GaitdStatus SimulatedBackend::disturb(const GaitdDisturbance& disturbance) {
  return runner_->disturb(disturbance);
}

GaitdStatus SimulatedBackend::carry(const GaitdLoad& load) { return runner_->carry(load); }

GaitdStatus SimulatedBackend::reset() {
  runner_->reset();
  return GAITD_OK;
}

void SimulatedBackend::stop() { runner_->stop(); }

}  // namespace gaitd::sim
