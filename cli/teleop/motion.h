// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace gaitd::cli::teleop {

/// Where the operator wants to go, each from -1 to 1 of the full speed: ahead, to the left, turning
/// to the left.
struct Motion {
  double forward = 0.0;
  double lateral = 0.0;
  double turn = 0.0;

  bool still() const { return forward == 0.0 && lateral == 0.0 && turn == 0.0; }
};

/// The same in m/s, m/s and rad/s, in the frame of the robot.
struct Speed {
  double forward = 0.0;
  double lateral = 0.0;
  double turn = 0.0;
};

/// How fast full speed is; + and - change it.
class SpeedScale {
 public:
  void faster();
  void slower();
  int percent() const { return percent_; }  ///< of 0.3 m/s ahead, 0.15 aside and 0.3 rad/s
  Speed of(const Motion& motion) const;

 private:
  int percent_ = 100;
};

/// Takes the corners off: keys come and go at once. Standing still is not smoothed, letting go has
/// to stop the robot.
class Ramp {
 public:
  const Motion& toward(const Motion& wanted, double seconds);  ///< since the call before

 private:
  Motion now_;
};

}  // namespace gaitd::cli::teleop
