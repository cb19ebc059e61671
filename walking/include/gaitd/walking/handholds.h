// SPDX-License-Identifier: Apache-2.0
// Hands that hold on to something: a wall, a rail, a table.
#ifndef GAITD_WALKING_HANDHOLDS_H_
#define GAITD_WALKING_HANDHOLDS_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "gaitd/abi/control.h"
#include "gaitd/dynamics/kinematics.h"
#include "gaitd/walking/commands.h"
#include "gaitd/walking/joint_chain.h"
#include "gaitd/walking/refusal.h"

namespace gaitd::walking {

// The contact point of a handhold, as the controller gets it.
GaitdContactPoint hand_contact(const GaitdModel& model, int hand, const GaitdHandhold& handhold);

// The hands that hold on or are about to, and what may be asked of them. A hand that is sent
// somewhere never knows exactly where the surface is, so it presses softly against the normal that
// it was told until something stops it. Only then is its force counted on, up to what was allowed.
// A hand that finds nothing or is torn off lets go, one whose arm fails, and the hands of a robot
// that has to step all the same: it moves away from what they hold on to.
class Handholds {
 public:
  // From kNothing on: why a hand lets go.
  enum class Change { kNone, kHeld, kNothing, kLost, kSteps, kFailed, kReleased };

  // Throws like Kinematics.
  explicit Handholds(const GaitdModel& model);

  void reset();
  // From where the hand is now. Refused: a surface or a force that this arm cannot hold on to as
  // it is.
  Refusal take(const HandholdCommand& command, const GaitdRobotState& robot);
  // N, along the normal: what the hand of the last take() is counted on for, at most as it asked.
  double allowed() const { return allowed_; }
  // GAITD_BOTH: whichever holds on.
  Refusal release(int hand);
  // One tick of `dt` seconds: sets robot.handholds. controlled: the robot stands or walks by
  // itself. last: of the controller, a tick ago. failed: a bit for each joint of the model that
  // does not do what it is told.
  void update(double dt, bool controlled, const GaitdGaitState& gait, const GaitdWbcInfo& last,
              GaitdRobotState& robot, std::uint64_t failed = 0);
  // Whether a joint of the arm is one of them.
  bool fails(int hand, std::uint64_t failed) const;

  bool busy(int hand) const { return hands_[hand].state != GAITD_HANDHOLD_NONE; }
  bool busy() const { return busy(GAITD_LEFT) || busy(GAITD_RIGHT); }
  Change change(int hand) const { return hands_[hand].change; }  // in the last tick

 private:
  struct Hand {
    int state = GAITD_HANDHOLD_NONE;
    Eigen::Vector3d start = Eigen::Vector3d::Zero();   // m, W
    Eigen::Vector3d anchor = Eigen::Vector3d::Zero();  // m, W: where it is to be
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
    double friction = 0.0;
    double allowed = 0.0;  // N
    double least = 0.0;    // N, now
    double most = 0.0;     // N, now
    double time = 0.0;     // s, stopped, or in the state
    Change change = Change::kNone;
    bool told = false;  // why it lets go
  };

  static void begin_to_let_go(Hand& hand);
  void seek(double dt, const Eigen::Vector3d& position, Hand& hand) const;
  void hold(double dt, const Eigen::Vector3d& position, Hand& hand) const;
  void let_go(double dt, const Eigen::Vector3d& position, Hand& hand) const;
  // m, with which the joints of the arm, but those at a stop, move the hand along `normal` (W).
  double lever(int side, const Eigen::Vector3d& normal, const GaitdRobotState& robot) const;
  // N, along `normal` (W), that no joint of the arm needs more than a share of its effort for.
  double bearable(int side, const Eigen::Vector3d& normal, const GaitdRobotState& robot) const;

  const GaitdModel model_;
  const double press_;  // N, that a hand presses with at least
  dynamics::Kinematics kinematics_;
  std::array<JointChain, GAITD_MAX_HANDS> arms_;
  std::array<Hand, GAITD_MAX_HANDS> hands_;
  double allowed_ = 0.0;
};

}  // namespace gaitd::walking

#endif  // GAITD_WALKING_HANDHOLDS_H_
