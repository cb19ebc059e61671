// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "foot_feedback.h"
#include "gaitd/abi/plugin.h"
#include "gaitd/dynamics/dynamics.h"
#include "gaitd/qp/dense_solver.h"
#include "gaitd/sdk/parameter.h"
#include "null_space_projector.h"
#include "separation_rows.h"

namespace gaitd::plugins {

// Parameters that every variant has.
inline constexpr GaitdParameter kTorqueScaleParameter = sdk::porting(sdk::real_parameter(
    "torque_scale", "", 0.4, 1, 1,
    "share of the effort limits in use; low: long steps sag, high: none is left"));
inline constexpr GaitdParameter kJointAccelerationParameter = sdk::expert(
    sdk::real_parameter("joint_acceleration_limit", "rad/s^2", 10, 1e5, 2000,
                        "of every joint; low: legs too weak for a step, high: noise is followed"));
inline constexpr GaitdParameter kMaxIterationsParameter = sdk::expert(sdk::integer_parameter(
    "max_iterations", "", 20, 10000, 300,
    "of the solver; low: it gives up in a push, high: a tick takes too long"));
inline constexpr GaitdParameter kReferenceLeakParameter = sdk::real_parameter(
    "reference_leak", "1/s", 0, 1000, 8,
    "of drive references to the joints; low: they wind up, high: friction wins");
inline constexpr GaitdParameter kFootFeedbackParameter =
    sdk::real_parameter("foot_feedback", "1/s", 0, 200, 15,
                        "of the measured CoP by the ankles; 0: none, low: slow, high: feet shake");

// The quadratic program that every whole-body controller here solves (theory section 4):
//   unknowns   z = [vdot (6+n); rho], rho the multipliers of the friction-pyramid edges
//   min        sum |P (J vdot - p)|^2 + |P_h (A vdot - b)|^2 + |P_rho rho|^2 + |P_v vdot|^2 + …
//   s.t.       A vdot + Adot v = W_gravity + B rho + W_external       (six centroidal rows)
//              tau_min <= M_a vdot + c_a - J_c,a' f <= tau_max        (every joint)
//              sum of the vertical forces <= m (g + (rise speed - v_z) / rise time)
//                                              (v_z of the CoM; more while it falls, to brake)
//              vdot_min <= vdot <= vdot_max,  rho_min <= rho <= rho_max
// Torques that would jump from the tick before by more than the torque rate allows are solved for
// once more, with the cost  weight (tau_i - tau_i,before -+ step)^2 / limit^2  for each of them. A
// bound would do the same until it contradicts the contacts; a cost never does. So are separations
// that the solution falls short of (SeparationRows).
// Call begin(), add what is special to the variant, then solve() and write().
class InverseDynamicsQp {
 public:
  static constexpr int kEdges = 4;  // of a friction pyramid
  static constexpr int kMaxRho = kEdges * GAITD_MAX_CONTACTS;
  static constexpr int kMaxRows = 6 * GAITD_MAX_TASKS + 6;

  struct Limits {
    double torque_scale = 1.0;           // share of the effort limits that may be used
    double joint_acceleration = 2000.0;  // rad/s^2
    // Faster than any joint that its drive can stop within its range.
    double joint_rate_gain = 30.0;      // 1/s, allowed rate per distance to a position limit
    double horizon = 0.02;              // s, in which a limit may be reached
    double base_acceleration = 1000.0;  // rad/s^2, m/s^2, beyond what a fall or a blow makes
    // Of the CoM, upwards, that the contacts may build up: more of it is a jump.
    double rise_speed = 0.7;  // m/s
    double rise_time = 0.15;  // s, in which they may
    // A change of torque that a drive follows costs nothing, a faster one as much as counts.
    double torque_rate = 120.0;       // effort limits per s, above which a change costs
    double torque_rate_weight = 1e6;  // of the square of what is above, in effort limits
  };
  // How the drives follow what was solved.
  struct Drives {
    double reference_leak = 8.0;  // 1/s, of the references
    double foot_feedback = 15.0;  // 1/s, see FootFeedback
  };
  // From the parameters of a variant, `P` the enumeration that names them.
  template <class P>
  static Limits limits_of(const sdk::Parameters<P>& p) {
    return {.torque_scale = p[P::kTorqueScale], .joint_acceleration = p[P::kJointAcceleration]};
  }
  template <class P>
  static Drives drives_of(const sdk::Parameters<P>& p) {
    return {.reference_leak = p[P::kReferenceLeak], .foot_feedback = p[P::kFootFeedback]};
  }

  explicit InverseDynamicsQp(const GaitdModel& model);

  // Forgets forces, accelerations and the warm start.
  void reset();
  void get_state(GaitdWholeBodyControllerState& state) const;
  void set_state(const GaitdWholeBodyControllerState& state);

  // Whether the foot of `side` is in contact.
  static bool stands(const GaitdObjectives& objectives, int side);
  // Takes the state, the contacts, all tasks of the objectives and the momentum rows of `mask`.
  void begin(const GaitdRobotState& robot, const GaitdObjectives& objectives, std::uint32_t mask,
             const Limits& limits);
  // Adds weight * (vdot_joint - acceleration)^2.
  void add_joint(int joint, double acceleration, double weight);
  // Adds weight * (row x - target)^2; `row` has velocity_size() entries, or as many as problem().
  void add_row(const Eigen::Ref<const Eigen::VectorXd>& row, double target, double weight);
  // Everything that the tasks taken by begin() claim: rows of weight zero claim nothing.
  void claim(const GaitdObjectives& objectives, NullSpaceProjector& projector) const;

  // What solve() solves, as begin() and what was added made it. The views hold until begin().
  qp::Problem problem() const;
  // `dt` (s) since the tick before, `max_iterations` of each of the solutions.
  void solve(double dt, int max_iterations);
  // Torques, references and figures of the last solve, for a tick of `dt` seconds. The references
  // of the drives are integrated from the solved accelerations and leak towards the measured state:
  // what a drive adds around them makes good for friction and the like, as the foot feedback does.
  void write(double dt, const Drives& drives, const GaitdRobotState& robot,
             const GaitdObjectives& objectives, GaitdWholeBodyControllerOutput& out);

  int velocity_size() const { return nv_; }

 private:
  void add_rows(const GaitdObjectives& objectives, std::uint32_t mask);
  void add_contacts(const GaitdObjectives& objectives);
  void add_costs(const GaitdObjectives& objectives);
  void add_equalities(const GaitdObjectives& objectives);
  void add_limits(const GaitdRobotState& robot, const GaitdObjectives& objectives,
                  const Limits& limits);
  // Keeps the sum of the vertical forces from throwing the robot into the air: with the height
  // free, a large force is the cheapest way to a large horizontal one.
  void add_rise_limit(const GaitdRobotState& robot, const Limits& limits);
  // Torques of the joints by the last solution, with the damping of their drives.
  void compute_torque();
  // Adds the cost of each torque that jumps and has none yet; whether there was one.
  bool add_jumps(double dt);
  double previous_rho(const GaitdObjectives& objectives, int contact, int edge) const;
  void remember(const GaitdObjectives& objectives);
  void write_commands(double dt, double reference_leak, const GaitdRobotState& robot,
                      const GaitdObjectives& objectives, GaitdJointCommands& commands);
  void write_figures(const GaitdObjectives& objectives, GaitdWbcInfo& info) const;

  const GaitdModel model_;
  const int nv_;
  const int joints_;
  dynamics::Dynamics dynamics_;
  qp::DenseSolver solver_;
  qp::Status status_ = qp::Status::invalid_dimensions;
  int iterations_ = 0;     // of all solutions of the tick
  double residual_ = 0.0;  // of the last one

  int row_count_ = 0;
  int rho_count_ = 0;
  int size_ = 0;  // unknowns
  std::uint32_t momentum_mask_ = 0;
  Eigen::MatrixXd rows_;         // kMaxRows x nv, task rows
  Eigen::VectorXd targets_;      // kMaxRows
  Eigen::VectorXd weights_;      // kMaxRows
  Eigen::MatrixXd weighted_;     // kMaxRows x nv
  dynamics::Matrix6X jacobian_;  // 6 x nv, scratch
  Eigen::MatrixXd edges_;        // 3 x kMaxRho, unit forces in W
  Eigen::MatrixXd wrench_;       // 6 x kMaxRho, about the CoM, moment first
  Eigen::MatrixXd contact_;      // nv x kMaxRho, generalised force of each unit rho
  Eigen::MatrixXd H_, A_, C_;
  Eigen::VectorXd g_, b_, l_, u_, lb_, ub_;
  Eigen::VectorXd acceleration_;  // nv, solution
  Eigen::VectorXd rho_;           // kMaxRho, solution
  Eigen::VectorXd torque_;        // nv; of the joints with drag
  Eigen::VectorXd drag_;          // joints, N m, that their damping takes
  Eigen::VectorXd row_;           // size, scratch
  SeparationRows separations_;
  std::array<bool, GAITD_MAX_JOINTS> jumps_{};
  Limits limits_{};
  Eigen::VectorXd last_torque_;  // joints, N m, of the tick before
  bool last_torque_known_ = false;

  FootFeedback foot_feedback_;
  GaitdWholeBodyControllerState state_{};
  bool references_valid_ = false;
};

}  // namespace gaitd::plugins
