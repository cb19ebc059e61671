// SPDX-License-Identifier: Apache-2.0
// What the robot's sensors show: noisy, biased, quantised and late as the figures say.
//
// Everything is measured at every plant step and comes to the controller once per control period,
// the joints in one frame, each IMU and each foot in one of its own.
#ifndef GAITD_SIM_SENSORS_H_
#define GAITD_SIM_SENSORS_H_

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/sim/drive_readings.h"
#include "gaitd/sim/foot_sensors.h"
#include "gaitd/sim/imu_sensor.h"
#include "gaitd/sim/joint_sensors.h"
#include "gaitd/sim/physics.h"
#include "gaitd/sim/sensor_figures.h"
#include "gaitd/sim/transport.h"

namespace gaitd::sim {

class Sensors {
 public:
  // `time_step`: of the plant; `steps_per_period`: plant steps in a control period.
  Sensors(const GaitdModel& model, const SensorFigures& figures, double time_step,
          int steps_per_period, const SensorSeed& seed);

  // Starts over with the robot at rest in `state`: its whole past is this state. `wrench`: of the
  // contacts alone.
  void reset(const State& state, Bodies bodies, const DriveReadings& drives,
             const FootWrench (&wrench)[GAITD_MAX_FEET]);

  // Samples everything at the end of a plant step.
  void sample(const State& state, Bodies bodies, const DriveReadings& drives,
              const FootWrench (&wrench)[GAITD_MAX_FEET]);

  // The sensors as they stand at control tick `tick`, `time` seconds after the start.
  void read(int64_t tick, double time, GaitdSensors* sensors) const;

  // n, rad and rad/s: the newest sample of the encoders, as the board of a drive has it at once.
  const Eigen::VectorXd& measured_position() const { return joints_.newest().position; }
  const Eigen::VectorXd& measured_velocity() const { return joints_.newest().velocity; }

 private:
  template <class Reading>
  struct Channel {
    Channel(const Transport& way, const Reading& empty)
        : transport(way), line(way.longest_delay(), empty) {}
    void start() {
      transport.reset();
      line.show(transport.step());
    }
    void advance(int64_t tick) {
      if (transport.advance(tick)) line.show(transport.step());
    }
    Transport transport;
    DelayLine<Reading> line;
  };

  void measure(const State& state, Bodies bodies, const DriveReadings& drives,
               const FootWrench (&wrench)[GAITD_MAX_FEET]);

  int joint_count_;
  int foot_count_;
  int steps_per_period_;
  JointSensors joints_;
  FootSensors feet_;
  std::vector<ImuSensor> imus_;
  Channel<JointReadings> joint_channel_;
  std::vector<Channel<FootWrench>> foot_channels_;
  std::vector<Channel<ImuReading>> imu_channels_;
  int64_t step_ = 0;  // plant steps since the start
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_SENSORS_H_
