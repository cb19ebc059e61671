// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "gaitd/abi/types.h"
#include "gaitd/dynamics/kinematics.h"
#include "gaitd/walking/com_height.h"
#include "gaitd/walking/gait_scale.h"
#include "gaitd/walking/leg_configuration.h"
#include "gaitd/walking/parameters.h"
#include "gaitd/walking/self_collision.h"
#include "gaitd/walking/sole_rest.h"
#include "gaitd/walking/swing_trajectory.h"

namespace gaitd::walking {

using ObjectiveParameters = sdk::Parameters<Objective>;

// Turns the state of the robot and the gait into what the whole-body controller is to achieve: all
// feedback laws live here, the controller is a pure inverse-dynamics optimisation.
class ObjectiveBuilder {
 public:
  // s, in which a foot is loaded after touchdown and unloaded before lift-off.
  static constexpr double kContactRamp = 0.05;
  // s, in which the rest of a sole is unloaded before it may roll over its toe.
  static constexpr double kToeRamp = 0.03;
  // m/s^2, most that a foot in contact is asked to slow down by: the ground stops it anyway.
  static constexpr double kTouchdownStop = 9.0;
  // s, of an overdue touchdown, in which the pelvis orientation loses its weight.
  static constexpr double kPelvisFade = 0.1;

  explicit ObjectiveBuilder(const GaitdModel& model);

  void set_objective_parameter(int index, double value) { parameters_.set(index, value); }
  void set_leg_parameter(int index, double value) { leg_parameters_.set(index, value); }
  void set_swing_parameter(int index, double value) { swing_parameters_.set(index, value); }

  // What the drives add around their references, by what the leg of the joint does. Joints of no
  // leg follow `kSupport`. N m/rad and N m s/rad, one per joint. Without it the drives of the legs
  // get shares of their effort limits, the others nothing.
  enum class Impedance { kSupport = 0, kSwing, kHeelStrike, kCount };
  using PerJoint = std::array<double, GAITD_MAX_JOINTS>;
  void set_impedance(Impedance state, const PerJoint& stiffness, const PerJoint& damping) {
    stiffness_[static_cast<int>(state)] = stiffness;
    damping_[static_cast<int>(state)] = damping;
    impedance_given_ = true;
  }

  // Takes the present posture as the start of every reference.
  void reset(const GaitdRobotState& robot, const GaitdGaitState& gait);

  // Where the parts of the body that take no steps are to be, from the next update() on; at first
  // as the robot holds them by itself.
  void set_references(const GaitdTaskReferences& references) { references_ = references; }

  // One tick of `dt` seconds. `lift_off` is where the swing foot left the ground (W).
  void update(double dt, const GaitdRobotState& robot, const GaitdGaitState& gait,
              const GaitdPose& lift_off, const GaitdStepAdjustment& adjustment,
              const GaitdToeOff& toe_off, GaitdObjectives& objectives);

  // m, between the capsules of arms and body that are nearest; see SelfCollision.
  double clearance() const { return self_collision_.clearance(); }
  const LegConfiguration::Reference& leg(int side) const { return legs_[side].reference(); }

 private:
  void update_contacts(double dt, const GaitdRobotState& robot, const GaitdGaitState& gait,
                       const GaitdToeOff& toe_off, GaitdObjectives& out) const;
  void update_posture(const GaitdRobotState& robot, GaitdObjectives& out) const;
  void update_held_arms(double dt, const GaitdRobotState& robot);
  // Contacts and tasks of the hands that hold on.
  void add_hands(const GaitdRobotState& robot, GaitdObjectives& out) const;
  void update_momentum(double dt, const GaitdRobotState& robot, const GaitdGaitState& gait,
                       const GaitdStepAdjustment& adjustment, GaitdObjectives& out);
  void update_upper_body(double dt, const GaitdGaitState& gait, GaitdObjectives& out);
  void update_feet(const GaitdRobotState& robot, const GaitdGaitState& gait,
                   const GaitdToeOff& toe_off, GaitdObjectives& out);
  void update_rests(double dt, const GaitdRobotState& robot, const GaitdGaitState& gait,
                    const GaitdToeOff& toe_off);
  void add_stance_foot(int side, const GaitdRobotState& robot, GaitdObjectives& out) const;
  void add_toe(int side, const GaitdRobotState& robot, const GaitdGaitState& gait,
               const GaitdToeOff& toe_off, GaitdObjectives& out) const;
  void add_swing_foot(int side, const GaitdRobotState& robot, const GaitdGaitState& gait,
                      GaitdObjectives& out);
  // The way of the foot in swing, from where it left the ground.
  void plan_swing(const GaitdRobotState& robot, const GaitdGaitState& gait,
                  const GaitdPose& lift_off);
  // m, W, of the joints of hip and ankle pitch.
  Eigen::Vector3d hip(int side) const;
  Eigen::Vector3d ankle(int side) const;
  // m, W: for the foot in swing to come down on a leg of `longest` metres, `longest_down` on lower
  // ground.
  double highest_hip_of_swing(const GaitdRobotState& robot, const GaitdGaitState& gait,
                              double longest, double longest_down) const;
  // m, W: for the leg that trails in this transfer, or in the one after this swing.
  double highest_hip_of_transfer(const GaitdRobotState& robot, const GaitdGaitState& gait) const;
  void update_lowering(double dt, const GaitdRobotState& robot, const GaitdGaitState& gait);
  double ankle_room(int side, const GaitdRobotState& robot) const;
  void update_privileged(double dt, const GaitdRobotState& robot, const GaitdGaitState& gait,
                         GaitdObjectives& out);
  // Whether the joint is to be elsewhere than in the nominal posture, or on its way.
  bool asked_for(int joint) const;
  void update_impedance(const GaitdGaitState& gait, GaitdObjectives& out) const;
  GaitdTask& add_task(GaitdObjectives& out, int type, int index, std::uint32_t mask) const;
  void add_orientation_task(int body, const Eigen::Quaterniond& goal,
                            const Eigen::Vector3d& goal_rate, double stiffness,
                            double damping_ratio, double weight, GaitdObjectives& out) const;
  double pelvis_weight(double dt, const GaitdGaitState& gait, const Eigen::Quaterniond& goal);
  // The rest of the sole is unloaded: the foot may roll.
  bool on_toe(int side) const;
  // Share of the full load that the contacts of a foot may carry now, 0..1.
  double load_share(int side, const GaitdGaitState& gait) const;

  const GaitdModel model_;
  double weight_;  // N
  GaitScale scale_;
  double leg_length_;  // m, hip to ankle in the nominal posture
  dynamics::Kinematics kinematics_;
  Eigen::Quaterniond chest_in_pelvis_;
  std::array<bool, GAITD_MAX_JOINTS> posture_joint_{};  // neither leg nor spine

  ObjectiveParameters parameters_{kObjectiveParameters};
  LegParameters leg_parameters_{kLegParameters};
  SwingParameters swing_parameters_{kSwingParameters};

  SelfCollision self_collision_;
  std::array<LegConfiguration, GAITD_MAX_FEET> legs_;
  std::array<SoleRest, GAITD_MAX_FEET> rests_;
  SwingTrajectory swing_;
  int swing_step_ = -1;      // step index of the trajectory in swing_
  int swing_revision_ = -1;  // plan revision it was made for
  ReferenceFilter height_;
  int mode_ = GAITD_MODE_STAND;    // of the gait, that height_ was begun in
  ReferenceFilter lowering_;       // rad, bend of the leg that stands, for the other one to reach
  int lowered_side_ = GAITD_BOTH;  // the leg that stands
  Eigen::Vector3d ankle_in_sole_[GAITD_MAX_FEET];  // m, above a level sole
  ReferenceFilter yaw_;
  Eigen::Vector3d tilt_ = Eigen::Vector3d::Zero();  // rad, held while standing, level in a walk
  GaitdTaskReferences references_{};
  double pelvis_share_ = 1.0;  // of the weight of the pelvis orientation
  std::array<double, GAITD_MAX_FEET> time_in_contact_{};
  std::array<double, GAITD_MAX_FEET> time_in_toe_off_{};
  bool impedance_given_ = false;
  std::array<PerJoint, static_cast<int>(Impedance::kCount)> stiffness_{};
  std::array<PerJoint, static_cast<int>(Impedance::kCount)> damping_{};
  PerJoint held_arm_offset_{};  // rad, of the posture, of arms whose hands hold on
};

}  // namespace gaitd::walking
