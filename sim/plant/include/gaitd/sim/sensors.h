// SPDX-License-Identifier: Apache-2.0
// What the robot's sensors show: noisy, biased, quantised and late as the figures say.
//
// Everything is sampled at every plant step. The specific force is the velocity change of the IMU
// over the last control period (a strapdown unit integrates between its samples, and so no impact
// is missed), minus gravity, in the axes of the IMU at the sampling instant. A foot wrench is that
// of the contact forces on the foot alone: the inertia of the foot below the sensor is not in it.
#ifndef GAITD_SIM_SENSORS_H_
#define GAITD_SIM_SENSORS_H_

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/sim/config.h"
#include "gaitd/sim/contact.h"
#include "gaitd/sim/multibody.h"
#include "gaitd/sim/random.h"

namespace gaitd::sim {

// Contact wrench on each foot in its sensor frame, about the sensor origin.
struct FootWrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   // N
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  // N m
};

// Sums the forces of `contacts` on the foot `side`; `multibody` is in the state they act in.
FootWrench sum_foot_wrench(const GaitdModel& model, int side, const Multibody& multibody,
                           const std::vector<Contact>& contacts);

class Sensors {
 public:
  // `time_step`: of the plant; `steps_per_period`: plant steps in a control period.
  Sensors(const GaitdModel& model, const SensorFigures& figures, double time_step,
          int steps_per_period, uint64_t seed);

  // Starts over with the robot at rest in `state`: its whole past is this state.
  void reset(const State& state, const Multibody& multibody, const Eigen::VectorXd& torque,
             const FootWrench (&wrench)[GAITD_MAX_FEET]);

  // Samples everything at the end of a plant step. `torque`: n, N m.
  void sample(const State& state, const Multibody& multibody, const Eigen::VectorXd& torque,
              const FootWrench (&wrench)[GAITD_MAX_FEET]);

  // As the boards of the drives read them (n): the newest sample, without the way to the
  // controller.
  const Eigen::VectorXd& measured_position() const { return ring_[newest_].position; }  // rad
  const Eigen::VectorXd& measured_velocity() const { return ring_[newest_].velocity; }  // rad/s

  // The sensors as they stand at control tick `tick`, `time` seconds after the start.
  void read(int64_t tick, double time, GaitdSensors* sensors) const;

 private:
  struct Sample {
    Eigen::VectorXd position, velocity, torque;
    std::vector<Eigen::Vector3d> angular_rate, specific_force;
    FootWrench wrench[GAITD_MAX_FEET];
  };
  struct Imu {
    int body;
    Eigen::Vector3d p_B;
    Eigen::Matrix3d R_BI;
    Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();
    Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();
    std::vector<Eigen::Vector3d> velocity;  // m/s, W, of the last period's plant steps
  };

  void draw_biases();
  void sample_joints(const State& state, const Eigen::VectorXd& torque, Sample* sample);
  void sample_imus(const Multibody& multibody, Sample* sample);
  double encode(int joint, double position);
  Eigen::Vector3d noise(RandomStream* stream, double sigma) const;

  GaitdModel model_;
  SensorFigures figures_;
  double time_step_;
  int steps_per_period_;
  uint64_t seed_;
  size_t delay_steps_;
  double velocity_gain_;
  std::vector<Imu> imus_;
  FootWrench offset_[GAITD_MAX_FEET];
  Eigen::VectorXd encoded_;  // last encoder reading
  Eigen::VectorXd rate_filter_;
  std::vector<Sample> ring_;  // delay_steps_ + 1 samples
  size_t newest_ = 0;
  size_t velocity_slot_ = 0;
  RandomStream gyro_, accelerometer_, encoder_, foot_force_;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_SENSORS_H_
