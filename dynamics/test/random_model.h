// SPDX-License-Identifier: Apache-2.0
// Seeded random robots and states for the tests.
#ifndef GAITD_DYNAMICS_TEST_RANDOM_MODEL_H_
#define GAITD_DYNAMICS_TEST_RANDOM_MODEL_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <random>

#include "gaitd/abi/types.h"
#include "gaitd/dynamics/spatial.h"

namespace gaitd::dynamics {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}

  double uniform(double low, double high) { return low + (high - low) * next(); }
  int integer(int low, int high) {  // both included
    return low + static_cast<int>(next() * (high - low + 1));
  }
  Eigen::VectorXd vector(int size, double bound);
  Eigen::Vector3d direction();
  Eigen::Quaterniond rotation();

 private:
  // Spelt out, because the library's distributions may differ between libraries.
  double next() { return static_cast<double>(engine_()) / 4294967296.0; }

  std::mt19937 engine_;
};

struct RandomState {
  RandomState(int joint_count, Random* random);

  Eigen::Vector3d p_WP;
  Eigen::Quaterniond R_WP;
  Vector6d V_P;
  Eigen::VectorXd q, qd;

  Eigen::VectorXd v() const;  // the generalised velocity
};

// Random branching, joint types, axes, frames and masses; no rotor inertia.
GaitdModel make_random_model(int joint_count, Random* random);

// robots/atlas; throws if the file does not load.
GaitdModel load_atlas();

}  // namespace gaitd::dynamics

#endif  // GAITD_DYNAMICS_TEST_RANDOM_MODEL_H_
