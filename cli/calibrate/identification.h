// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "cli/calibrate/recording.h"
#include "daemon/config/calibration.h"
#include "gaitd/abi/types.h"

namespace gaitd::calibrate {

// How wrong the robot may be, one standard deviation each, before anything was measured.
struct Prior {
  double zero = 0.0175;         // rad, encoders: 1 degree
  double compliance = 0.35;     // of the compliance that is known
  double unknown = 0.14;        // rad, of a joint of which nothing is known, by moment_scale()
  double accelerometer = 0.35;  // m/s^2: bias and mounting of the IMU, of a cheap one
  double chest_com = 0.01;      // m, each axis
  double ground = 2e-3;         // rad and m: how level and even the ground is
};

// Joints that were estimated together, and how well.
struct Zeros {
  std::vector<int> joints;
  Eigen::VectorXd value;       // rad, what the encoder shows at zero of the model
  Eigen::MatrixXd covariance;  // rad^2
};

// A sum of zeros that the recording tells nothing new about: it stays what it was.
struct Unobservable {
  double sigma = 0.0;                // rad, of a sum with coefficients of unit length
  std::vector<double> coefficients;  // as Zeros::joints
};

struct Identified {
  Zeros zeros;
  std::vector<double> compliance;  // rad/(N m), as zeros.joints
  std::vector<double> compliance_sigma;
  Eigen::Vector3d accelerometer = Eigen::Vector3d::Zero();  // m/s^2, what the IMU reads too much
  Eigen::Vector3d chest_com = Eigen::Vector3d::Zero();      // m, chest frame, beside the model
  std::vector<Unobservable> unobservable;
  double misfit = 0.0;  // of the residuals over what they should be; 1: as expected
  int postures = 0;
};

// The zeros of the joints of the legs and between pelvis and chest, and how far the legs bend:
// those that agree best, in the sense of least squares, with what a robot knows that stands still
// on two flat feet in many postures:
//  - the feet stay where they are, so the legs are a closed chain;
//  - the ground is level, and the IMU shows gravity;
//  - the contact forces have no moment about the centre of mass.
// `known` says what is known of the zeros, stiffnesses and feet; sums of zeros that are not
// observable stay as it says. `recording` has at least six postures.
Identified identify(const GaitdModel& model, const daemon::Calibration& known,
                    const Recording& recording, const Prior& prior);

}  // namespace gaitd::calibrate
