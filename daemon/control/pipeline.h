// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "daemon/command/command.h"
#include "daemon/control/compensation.h"
#include "daemon/control/layer_chain.h"
#include "daemon/control/safety.h"
#include "daemon/control/sensor_monitor.h"
#include "daemon/control/tick_data.h"
#include "daemon/parameters/live_parameters.h"
#include "gaitd/walking/external_wrench.h"
#include "gaitd/walking/gait_machine.h"
#include "gaitd/walking/handholds.h"
#include "gaitd/walking/motions.h"
#include "gaitd/walking/objectives.h"
#include "gaitd/walking/payload.h"

namespace gaitd::daemon {

// One tick, from sensors to joint commands, in the fixed order of the stages. Runs on the one
// real-time thread: nothing here allocates, locks, blocks or reads a clock (but for the report).
class Pipeline {
 public:
  // `start`: where the middle of the feet stands at the beginning (W). Takes the values of the
  // daemon's own parameters; the layers have got theirs when they were loaded.
  Pipeline(const GaitdModel& model, const Calibration& calibration, LayerChain::Layers layers,
           const GaitdStart& start, LiveParameters* parameters, double period);

  // Between ticks.
  CommandReply execute(const Command& command);
  SwapRight swap_right() const;
  // The order becomes the pipeline's; what comes of it is in the reports.
  void begin_swap(const SwapOrder& order);
  // What happened to swaps since the last tick, in order, each once.
  bool take_swap_report(SwapReport* report);
  // Back to the first tick, armed or not: for the reset of a simulation. Parameters stay.
  void reset(bool arm);

  // data().readings must hold the sensors of tick `tick`; data().commands holds the answer after.
  void run(std::int64_t tick);

  TickData& data() { return data_; }
  const TickData& data() const { return data_; }
  Safety& safety() { return safety_; }
  const Safety& safety() const { return safety_; }
  const SensorMonitor& monitor() const { return monitor_; }
  walking::GaitMachine& gait() { return gait_; }
  walking::ObjectiveBuilder& objectives() { return objectives_; }
  LayerChain& layers() { return layers_; }
  const LayerChain& layers() const { return layers_; }
  const LiveParameters& parameters() const { return *parameters_; }

 private:
  CommandReply set_parameter(const Command& command);
  bool apply(int owner, int index, double value);
  walking::Refusal too_weak_to_walk() const;
  CommandReply move(const Command& command);
  void begin_control();
  // nullptr, or why not.
  const char* tare();
  void observe_external(double dt);
  void update_payload(double dt);
  bool stands() const;
  walking::Refusal payload(const PayloadCommand& command);
  void update_handholds(double dt);
  CommandReply handhold(const Command& command);
  bool control(double dt);

  const GaitdModel model_;
  const GaitdStart start_;
  const double period_;
  LiveParameters* const parameters_;
  LayerChain layers_;
  walking::GaitMachine gait_;
  walking::ExternalWrench external_;
  walking::Payload payload_;
  walking::Handholds handholds_;
  walking::ObjectiveBuilder objectives_;
  walking::Motions motions_;
  Safety safety_;
  SensorMonitor monitor_;
  Compensation compensation_;
  TickData data_;
};

}  // namespace gaitd::daemon
