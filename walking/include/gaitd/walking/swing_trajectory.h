// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "gaitd/abi/types.h"
#include "gaitd/sdk/views.h"
#include "gaitd/walking/parameters.h"

namespace gaitd::walking {

using SwingParameters = sdk::Parameters<Swing>;

// What is the robot's of a swing.
struct SwingShape {
  double landing_speed = 0.3;  // m/s, downwards at its end
  double late_velocity = 0.3;  // m/s, downwards when the touchdown is due
  double late_speed = 1.0;     // m/s, downwards at most while the touchdown is overdue
  double edge_height = 0.12;   // m, a step up or down that is an edge in full; less, in proportion
  double toe = 0.0;            // m, from the origin of the sole to its front
};
SwingShape swing_shape(const GaitdModel& model, const SwingParameters& parameters);

// Quintic polynomial in time through position, velocity and acceleration at both ends.
class Quintic {
 public:
  void fit(double x0, double v0, double a0, double x1, double v1, double a1, double duration);
  double position(double t) const;
  double velocity(double t) const;
  double acceleration(double t) const;

 private:
  double c_[6] = {};
};

// Path of the sole of the swing foot in W, with continuous acceleration: from lift-off over an apex
// above the higher of both footholds down to the foothold, which it meets with a downward velocity.
// Onto an edge the foot first rises, its toe drawn back a little, however it turns meanwhile, and
// is level before it is above it; down an edge it is above beyond its foothold before it comes
// down, and goes back to it at the bottom. After the planned end it keeps going down, faster and
// faster, until the ground is met.
class SwingTrajectory {
 public:
  struct Sample {
    Eigen::Vector3d position, velocity, acceleration;        // m, m/s, m/s^2, W
    Eigen::Quaterniond orientation;                          // sole in W
    Eigen::Vector3d angular_velocity, angular_acceleration;  // rad/s, rad/s^2, W
  };

  // A new swing, `duration` seconds long, from `from` with `twist` (of the sole origin, W axes,
  // angular first). `ground` is the height of the foothold that is left (m, W).
  void begin(const GaitdPose& from, const sdk::Vector6d& twist, double ground,
             const GaitdFootstep& to, double duration, const SwingShape& shape);
  // The foothold or the timing changed at time t of the swing: goes on from the present reference,
  // continuous in acceleration, and ends at `to` at `duration`.
  void replan(double t, const GaitdFootstep& to, double duration, const SwingShape& shape);
  Sample evaluate(double t) const;

 private:
  double edge(const GaitdFootstep& to, const SwingShape& shape) const;
  void plan(double t, const Sample& now, const GaitdFootstep& to, double duration,
            const SwingShape& shape);

  double start_ = 0.0;     // s, of the polynomials below
  double apex_ = 0.0;      // s, where z changes polynomial
  double duration_ = 0.0;  // s, end of the swing
  double leave_ = 0.0;     // s, before which the foot does not advance
  double arrive_ = 0.0;    // s, after which it is above its foothold
  double level_ = 0.0;     // s, after which it has the orientation of its foothold
  double apex_height_ = 0.0;
  double late_velocity_ = 0.0;
  double led_ = 0.0;        // m, ahead in the sole, of the point that the way leads
  double late_gain_ = 0.0;  // m/s, on top of late_velocity_ at most
  // From above: back from an edge, on to the arrival, then to the foothold.
  std::array<Quintic, 2> drawn_, ahead_, back_;
  Quintic z_up_, z_down_;
  Quintic turn_[3];  // rotation vector from from_orientation_, W, rad
  Eigen::Quaterniond from_orientation_ = Eigen::Quaterniond::Identity();
  GaitdFootstep goal_{};  // what the polynomials lead to
  double ground_ = 0.0;   // m, height of the foothold that was left
  Sample lift_off_{};     // where the swing began
};

}  // namespace gaitd::walking
