// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/signals.h"

#include <bit>
#include <cmath>
#include <initializer_list>
#include <string>

#include "daemon/host/layers.h"
#include "gaitd/sdk/loads.h"
#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"

namespace gaitd::daemon {
namespace {

using Words = std::initializer_list<const char*>;
using Kind = SignalDescription::Kind;

constexpr const char* kSides[] = {"left", "right"};
constexpr const char* kAxes[] = {"x", "y", "z"};
constexpr const char* kSlots[GAITD_MAX_LOADS] = {"0", "1", "2", "3"};

// Two visitors walk the same enumeration below: one writes down the names, the other the values.
// A name comes in parts, so that recording does not have to put any together.
class Describe {
 public:
  explicit Describe(SignalTable* table) : table_(table) {}
  template <class... Parts>
  void real(double, const char* unit, Parts... parts) {
    add(Kind::kReal, unit, {}, parts...);
  }
  template <class... Parts>
  void integer(double, Parts... parts) {
    add(Kind::kInteger, "", {}, parts...);
  }
  template <class... Parts>
  void boolean(bool, Parts... parts) {
    add(Kind::kBoolean, "", {}, parts...);
  }
  template <class... Parts>
  void word(int, Words words, Parts... parts) {
    add(Kind::kEnumeration, "", words, parts...);
  }
  // Of the model; -1: none.
  template <class... Parts>
  void link(int, const GaitdModel& model, Parts... parts) {
    add(Kind::kEnumeration, "", {"none"}, parts...);
    for (int i = 0; i < model.body_count; ++i) {
      table_->back().words.emplace_back(model.bodies[i].name);
    }
  }

 private:
  template <class... Parts>
  void add(Kind kind, const char* unit, Words words, Parts... parts) {
    table_->push_back({(std::string() + ... + parts), unit, kind, {words.begin(), words.end()}});
  }
  SignalTable* table_;
};

class Record {
 public:
  explicit Record(std::span<double> values) : values_(values) {}
  template <class... Parts>
  void real(double value, const char*, Parts...) {
    put(value);
  }
  template <class... Parts>
  void integer(double value, Parts...) {
    put(value);
  }
  template <class... Parts>
  void boolean(bool value, Parts...) {
    put(value ? 1.0 : 0.0);
  }
  template <class... Parts>
  void word(int value, Words, Parts...) {
    put(value);
  }
  template <class... Parts>
  void link(int body, const GaitdModel&, Parts...) {
    put(body + 1);
  }

 private:
  void put(double value) {
    if (next_ < values_.size()) values_[next_++] = value;
  }
  std::span<double> values_;
  std::size_t next_ = 0;
};

template <class V, class... Parts>
void axes(V& v, const double* values, int count, const char* unit, Parts... prefix) {
  for (int i = 0; i < count; ++i) v.real(values[i], unit, prefix..., kAxes[i]);
}

template <class V, class... Parts>
void pose(V& v, const double* position, const double (&orientation)[4], Parts... prefix) {
  axes(v, position, 3, "m", prefix...);
  const Eigen::Vector3d rpy = sdk::roll_pitch_yaw(sdk::quaternion(orientation));
  v.real(rpy.x(), "rad", prefix..., "roll");
  v.real(rpy.y(), "rad", prefix..., "pitch");
  v.real(rpy.z(), "rad", prefix..., "yaw");
}

template <class V>
void visit_gait(V& v, const TickData& d) {
  v.real(d.time.time, "s", "time");
  v.integer(static_cast<double>(d.time.tick), "tick");
  v.word(static_cast<int>(d.safety),
         {"disarmed", "readying", "standing", "walking", "stopping", "fault", "testing"},
         "safety/state");
  v.integer(d.faults, "safety/faults");
  v.integer(d.health, "safety/health");
  v.integer(std::popcount(d.dropped), "safety/joints_dropped");
  v.word(d.gait.mode, {"stand", "walk-straight", "walk-bent"}, "gait/mode");
  v.word(d.gait.phase, {"stand", "transfer", "swing"}, "gait/phase");
  v.word(d.gait.support, {"left", "right", "both"}, "gait/support");
  v.integer(d.gait.step_index, "gait/step_index");
  v.boolean(d.gait.phase == GAITD_PHASE_SWING && d.gait.commanded[0].closing != 0, "gait/closing");
  v.integer(d.gait.footstep_count, "gait/footsteps_ahead");
  v.boolean(d.gait.paused != 0, "gait/paused");
  v.boolean(d.gait.early_contact != 0, "gait/early_contact");
  v.boolean(d.gait.late_contact != 0, "gait/late_contact");
  v.real(d.gait.time_remaining, "s", "gait/time_remaining");
}

template <class V>
void visit_balance(V& v, const GaitdModel& model, const TickData& d) {
  axes(v, d.robot.com, 3, "m", "com/");
  axes(v, d.robot.com_velocity, 3, "m/s", "com/velocity/");
  v.real(d.objectives.height_target, "m", "com/height_target");
  axes(v, d.robot.icp, 2, "m", "icp/");
  v.real(d.icp_margin, "m", "icp/margin");
  v.real(std::hypot(d.robot.icp[0] - d.plan.icp[0], d.robot.icp[1] - d.plan.icp[1]), "m",
         "icp/error");
  axes(v, d.plan.icp, 2, "m", "icp/desired/");
  axes(v, d.plan.ecmp, 2, "m", "ecmp/reference/");
  axes(v, d.adjustment.ecmp, 2, "m", "ecmp/desired/");
  axes(v, d.adjustment.cmp, 2, "m", "cmp/desired/");
  v.real(d.adjustment.kappa, "", "cmp/kappa");
  axes(v, d.robot.cop, 2, "m", "cop/");
  axes(v, d.external.wrench + 3, 3, "N", "external/force/");
  axes(v, d.external.wrench, 3, "N m", "external/moment/");
  v.boolean(d.external.tared, "external/tared");
  v.boolean(d.external.pulled, "external/pulled");
  v.real(d.external.load, "N", "external/load");
  v.real(d.external.surplus, "N", "external/surplus");
  v.boolean(d.external.misjudged, "external/misjudged");
  v.real(sdk::mass_of(d.loads), "kg", "payload/mass");
  v.boolean(d.payload.estimating, "payload/estimating");
  v.word(static_cast<int>(d.payload.outcome),
         {"none", "found", "nothing", "moved", "pulled", "too much"}, "payload/outcome");
  v.link(d.payload.found.mass > 0.0 ? d.payload.found.body : -1, model, "payload/weighed");
  axes(v, d.payload.uncertainty, 3, "m", "payload/uncertainty/");
  for (int i = 0; i < GAITD_MAX_LOADS; ++i) {
    const GaitdLoad& load = d.loads.loads[i];
    const bool is = i < d.loads.count;
    v.link(is ? load.body : -1, model, "payload/", kSlots[i], "/link");
    v.real(is ? load.mass : 0.0, "kg", "payload/", kSlots[i], "/mass");
    axes(v, load.com, 3, "m", "payload/", kSlots[i], "/com/");
  }
  pose(v, d.robot.pelvis_position, d.robot.pelvis_orientation, "pelvis/");
  const Eigen::Quaterniond orientation = sdk::quaternion(d.robot.pelvis_orientation);
  const Eigen::Vector3d velocity = orientation * sdk::view(d.robot.pelvis_twist).tail<3>();
  const Eigen::Vector3d turn = orientation * sdk::view(d.robot.pelvis_twist).head<3>();
  axes(v, velocity.data(), 3, "m/s", "pelvis/velocity/");
  axes(v, turn.data(), 3, "rad/s", "pelvis/angular_velocity/");
}

template <class V>
void visit_foot(V& v, const TickData& d, int side) {
  const char* name = kSides[side];
  const GaitdFootState& foot = d.robot.feet[side];
  pose(v, foot.position, foot.orientation, "foot/", name, "/");
  const bool toe = d.gait.footholds[side].contact == GAITD_CONTACT_TOE;
  v.word(foot.contact == GAITD_CONTACT_NONE ? 0 : (toe ? 1 : 2), {"none", "toe", "full"}, "foot/",
         name, "/contact");
  v.real(d.bearing[side], "", "foot/", name, "/bearing");
  const GaitdFoothold& foothold = d.gait.footholds[side];
  const auto bears = foothold.polygon_count > 0 ? walking::sole_extent(foothold)
                                                : walking::SoleExtent{0.0, 0.0, 0.0, 0.0};
  v.real(bears.x_min, "m", "foot/", name, "/bears/back");
  v.real(bears.x_max, "m", "foot/", name, "/bears/front");
  v.real(bears.y_min, "m", "foot/", name, "/bears/right");
  v.real(bears.y_max, "m", "foot/", name, "/bears/left");
  const Eigen::Vector3d force =
      sdk::quaternion(foot.orientation) * sdk::view(foot.wrench).tail<3>();
  const Eigen::Vector3d moment =
      sdk::quaternion(foot.orientation) * sdk::view(foot.wrench).head<3>();
  axes(v, force.data(), 3, "N", "foot/", name, "/force/");
  axes(v, moment.data(), 3, "N m", "foot/", name, "/moment/");
  axes(v, d.wbc.info.foot_wrench[side] + 3, 3, "N", "foot/", name, "/force_desired/");
  v.word(static_cast<int>(d.legs[side].state),
         {"straighten", "straight", "collapsed", "bent", "extend"}, "leg/", name, "/state");
  v.real(d.legs[side].knee, "rad", "leg/", name, "/knee_privileged");
  // The foothold ahead of this foot if it has one, else the one it stands on.
  const GaitdPose* goal = &d.gait.footholds[side].pose;
  for (int i = 1; i >= 0; --i) {
    if (i < d.gait.footstep_count && d.gait.adjusted[i].side == side) {
      goal = &d.gait.adjusted[i].pose;
    }
  }
  axes(v, goal->position, 3, "m", "footstep/", name, "/");
  v.real(sdk::yaw_of(sdk::quaternion(goal->orientation)), "rad", "footstep/", name, "/yaw");
}

template <class V>
void velocity(V& v, const walking::Velocity& of, const char* prefix) {
  v.real(of.forward, "m/s", prefix, "forward");
  v.real(of.lateral, "m/s", prefix, "lateral");
  v.real(of.turn, "rad/s", prefix, "turn");
}

template <class V>
void visit_layers(V& v, const TickData& d) {
  v.boolean(d.toe_off.active != 0, "toe_off/active");
  constexpr const char* kCriteria[] = {"icp", "icp_distance", "cop", "cmp", "ankle"};
  for (int i = 0; i < GAITD_TOE_OFF_CRITERIA; ++i) {
    v.real(d.toe_off.criterion[i], "", "toe_off/criterion/", kCriteria[i]);
  }
  v.real(d.adjustment.shift[0], "m", "step_adjust/dx");
  v.real(d.adjustment.shift[1], "m", "step_adjust/dy");
  v.real(d.adjustment.time_shift, "s", "step_adjust/time_shift");
  v.boolean(d.drive.active, "drive/active");
  velocity(v, d.drive.target, "drive/target/");
  velocity(v, d.drive.step, "drive/step/");
  const GaitdWbcInfo& wbc = d.wbc.info;
  v.word(wbc.status, {"solved", "max_iterations", "infeasible", "non_finite"}, "wbc/status");
  v.integer(wbc.iterations, "wbc/iterations");
  v.real(d.times.layer_us[GAITD_LAYER_WHOLE_BODY_CONTROLLER], "us", "wbc/solve_us");
  v.real(wbc.kkt_residual, "", "wbc/kkt_residual");
  v.real(wbc.null_trace, "", "wbc/null_trace");
  v.real(wbc.momentum_residual, "N", "wbc/momentum_residual");
  v.real(d.times.total_us, "us", "tick/total_us");
  for (int i = 0; i < GAITD_LAYER_COUNT; ++i) {
    v.real(d.times.layer_us[i], "us", "tick/", kLayerTimes[i]);
  }
  v.real(d.times.jitter_us, "us", "tick/jitter_us");
}

template <class V>
void visit_tasks(V& v, const GaitdModel& model, const TickData& d) {
  const GaitdTaskReferences& r = d.references;
  pose(v, r.com_shift, r.pelvis_turn, "pose/pelvis/");
  const Eigen::Vector3d chest = sdk::roll_pitch_yaw(sdk::quaternion(r.chest_turn));
  v.real(chest.x(), "rad", "pose/chest/roll");
  v.real(chest.y(), "rad", "pose/chest/pitch");
  v.real(chest.z(), "rad", "pose/chest/yaw");
  if (model.capsule_count > 0) v.real(d.clearance, "m", "pose/clearance");
  for (int side = 0; side < GAITD_MAX_HANDS; ++side) {
    if (model.hands[side].body <= 0) continue;
    const GaitdHandReference& hand = r.hands[side];
    const char* name = kSides[side];
    v.boolean(hand.active != 0, "hand/", name, "/active");
    axes(v, hand.goal.position, 3, "m", "hand/", name, "/goal/");
    v.real(hand.position_error, "m", "hand/", name, "/error");
    v.real(hand.turn_error, "rad", "hand/", name, "/turn_error");
    // Once it is there.
    const double rest = hand.active != 0 && hand.on_its_way == 0 ? 1.0 : 0.0;
    v.real(rest * hand.position_error, "m", "hand/", name, "/rest_error");
    v.real(rest * hand.turn_error, "rad", "hand/", name, "/rest_turn_error");
    v.real(hand.reach_error[0], "m", "hand/", name, "/reach_error");
    v.real(hand.reach_error[1], "rad", "hand/", name, "/reach_turn_error");
    const GaitdHandhold& handhold = d.robot.handholds[side];
    v.word(handhold.state, {"none", "sought", "held", "let go"}, "handhold/", name, "/state");
    axes(v, handhold.position, 3, "m", "handhold/", name, "/");
    axes(v, d.wbc.info.hand_force[side], 3, "N", "handhold/", name, "/force_desired/");
    v.real(handhold.force_max, "N", "handhold/", name, "/force_max");
  }
}

template <class V>
void visit_joints(V& v, const GaitdModel& model, const TickData& d) {
  for (int i = 0; i < model.joint_count; ++i) {
    const char* name = model.joints[i].name;
    v.real(d.robot.joint_position[i], "rad", "joint/", name, "/position");
    v.real(d.robot.joint_velocity[i], "rad/s", "joint/", name, "/velocity");
    v.real(d.commands.joints[i].torque, "N m", "joint/", name, "/torque_desired");
    v.real(d.sensors.joints[i].torque, "N m", "joint/", name, "/torque");
  }
}

// Estimate minus truth.
template <class V>
void visit_estimate_error(V& v, const GaitdRobotState& estimate, const GaitdTruth& t) {
  const Eigen::Quaterniond orientation = sdk::quaternion(estimate.pelvis_orientation);
  const Eigen::Quaterniond true_orientation = sdk::quaternion(t.pelvis_orientation);
  const Eigen::Vector3d position =
      sdk::view(estimate.pelvis_position) - sdk::view(t.pelvis_position);
  const Eigen::Vector3d velocity = orientation * sdk::view(estimate.pelvis_twist).tail<3>() -
                                   true_orientation * sdk::view(t.pelvis_twist).tail<3>();
  const Eigen::Vector3d turn =
      sdk::roll_pitch_yaw(orientation) - sdk::roll_pitch_yaw(true_orientation);
  constexpr const char* kPrefix = "truth/estimate_error/";
  v.real(position.head<2>().norm(), "m", kPrefix, "horizontal");
  v.real(position.z(), "m", kPrefix, "height");
  v.real(velocity.norm(), "m/s", kPrefix, "velocity");
  v.real(turn.x(), "rad", kPrefix, "roll");
  v.real(turn.y(), "rad", kPrefix, "pitch");
  v.real(std::remainder(turn.z(), 2.0 * M_PI), "rad", kPrefix, "yaw");
}

template <class V>
void visit_truth(V& v, const GaitdTruth& t) {
  pose(v, t.pelvis_position, t.pelvis_orientation, "truth/pelvis/");
  axes(v, t.com, 3, "m", "truth/com/");
  axes(v, t.com_velocity, 3, "m/s", "truth/com/velocity/");
  v.boolean(t.body_contact != 0, "truth/body_contact");
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdFootTruth& foot = t.feet[side];
    v.real(foot.slip, "m", "truth/foot/", kSides[side], "/slip");
    v.real(foot.penetration, "m", "truth/foot/", kSides[side], "/penetration");
    v.real(foot.side_force, "N", "truth/foot/", kSides[side], "/side_force");
    axes(v, foot.force, 3, "N", "truth/foot/", kSides[side], "/force/");
    axes(v, foot.position, 3, "m", "truth/foot/", kSides[side], "/");
  }
}

template <class V>
void visit(V&& v, const GaitdModel& model, const TickData& d, bool truth) {
  visit_gait(v, d);
  visit_balance(v, model, d);
  for (int side = 0; side < GAITD_MAX_FEET; ++side) visit_foot(v, d, side);
  visit_layers(v, d);
  visit_tasks(v, model, d);
  visit_joints(v, model, d);
  if (truth) {
    visit_truth(v, d.truth);
    visit_estimate_error(v, d.robot, d.truth);
  }
}

}  // namespace

SignalTable make_signal_table(const GaitdModel& model, const LayerVariants& variants, bool truth) {
  SignalTable table;
  TickData data{};
  data.robot.pelvis_orientation[3] = 1.0;
  visit(Describe(&table), model, data, truth);
  for (int layer = 0; layer < GAITD_LAYER_COUNT; ++layer) {
    table.push_back({"layer/" + std::string(layer_name(layer)) + "/variant", "", Kind::kEnumeration,
                     variants[layer]});
  }
  return table;
}

void record_signals(const GaitdModel& model, const TickData& data, std::span<double> values) {
  const std::size_t rest = values.size() - GAITD_LAYER_COUNT;
  visit(Record(values.first(rest)), model, data, data.has_truth);
  for (int layer = 0; layer < GAITD_LAYER_COUNT; ++layer) {
    values[rest + layer] = data.variants[layer];
  }
}

}  // namespace gaitd::daemon
