// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/signals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "walking/test/allocation_counter.h"
#include "walking/test/atlas.h"

namespace gaitd::daemon {
namespace {

using testing::atlas;

const LayerVariants& variants() {
  static const LayerVariants v = {{{"kinematic_inertial", "invariant_ekf"},
                                   {"heel_to_toe", "single_cmp"},
                                   {"step_plan", "fixed_steps"},
                                   {"icp_criteria", "never"},
                                   {"nullspace_qp", "com_height_qp"},
                                   {"trajectory_player"}}};
  return v;
}

SignalTable table_with(bool truth) { return make_signal_table(atlas(), variants(), truth); }

// a{b,c}d as abd and acd, again and again.
std::vector<std::string> expanded(const std::string& pattern) {
  const std::size_t open = pattern.find('{');
  if (open == std::string::npos) return {pattern};
  const std::size_t close = pattern.find('}', open);
  std::vector<std::string> names;
  std::size_t from = open + 1;
  while (from <= close) {
    const std::size_t to = std::min(pattern.find(',', from), close);
    for (const std::string& rest : expanded(pattern.substr(close + 1))) {
      names.push_back(pattern.substr(0, open) + pattern.substr(from, to - from) + rest);
    }
    from = to + 1;
  }
  return names;
}

// The names that users and scenarios rely on.
const char* const kNames[] = {
    "time",
    "tick",
    "safety/{state,faults}",
    "gait/{mode,phase,support,step_index}",
    "com/{x,y,z}",
    "com/velocity/{x,y,z}",
    "icp/{x,y}",
    "icp/{margin,error}",
    "icp/desired/{x,y}",
    "ecmp/reference/{x,y}",
    "ecmp/desired/{x,y}",
    "cmp/desired/{x,y}",
    "cmp/kappa",
    "cop/{x,y}",
    "pelvis/{x,y,z,roll,pitch,yaw}",
    "foot/{left,right}/{x,y,z,roll,pitch,yaw,contact}",
    "foot/{left,right}/bears/{back,front,right,left}",
    "foot/{left,right}/force/{x,y,z}",
    "leg/{left,right}/{state,knee_privileged}",
    "toe_off/active",
    "toe_off/criterion/{icp,icp_distance,cop,cmp,ankle}",
    "step_adjust/{dx,dy,time_shift}",
    "footstep/{left,right}/{x,y,z,yaw}",
    "wbc/{status,iterations,solve_us,kkt_residual,null_trace,momentum_residual}",
    "layer/{state_estimator,icp_planner,step_adjuster,toe_off,whole_body_controller,task_source}/"
    "variant",
    "tick/{total_us,estimator_us,planner_us,adjuster_us,toe_off_us,wbc_us,tasks_us,jitter_us}",
    "pose/{pelvis/x,pelvis/yaw,chest/roll,clearance}",
    "hand/{left,right}/{active,goal/x,error,turn_error,rest_error,rest_turn_error,reach_error}"};
const char* const kTruthNames[] = {"truth/pelvis/{x,y,z,roll,pitch,yaw}", "truth/com/{x,y,z}",
                                   "truth/com/velocity/{x,y,z}",
                                   "truth/foot/{left,right}/{slip,penetration,side_force}",
                                   "truth/foot/{left,right}/force/{x,y,z}"};

TEST(Signals, HaveTheNamesThatOthersRelyOn) {
  const SignalTable table = table_with(true);
  for (const char* pattern : kNames) {
    for (const std::string& name : expanded(pattern)) {
      EXPECT_GE(find_signal(table, name), 0) << name;
    }
  }
  for (const char* pattern : kTruthNames) {
    for (const std::string& name : expanded(pattern)) {
      EXPECT_GE(find_signal(table, name), 0) << name;
    }
  }
  for (int i = 0; i < atlas().joint_count; ++i) {
    for (const char* what : {"position", "velocity", "torque_desired", "torque"}) {
      const std::string name = std::string("joint/") + atlas().joints[i].name + "/" + what;
      EXPECT_GE(find_signal(table, name), 0) << name;
    }
  }
}

TEST(Signals, TruthIsThereInSimulationOnly) {
  for (const SignalDescription& s : table_with(false)) {
    EXPECT_NE(s.name.rfind("truth/", 0), 0u) << s.name;
  }
}

TEST(Signals, TheTableCanBeLogged) {
  for (bool truth : {false, true}) EXPECT_EQ(validate_signal_table(table_with(truth)), "");
}

TEST(Signals, EnumerationsHaveTheWordsOfTheirValues) {
  const SignalTable table = table_with(true);
  auto word = [&](const char* name, const char* text) {
    const int i = find_signal(table, name);
    return i < 0 ? -1 : find_word(table[i], text);
  };
  EXPECT_EQ(word("gait/phase", "stand"), GAITD_PHASE_STAND);
  EXPECT_EQ(word("gait/phase", "transfer"), GAITD_PHASE_TRANSFER);
  EXPECT_EQ(word("gait/phase", "swing"), GAITD_PHASE_SWING);
  EXPECT_EQ(word("gait/support", "left"), GAITD_LEFT);
  EXPECT_EQ(word("gait/support", "right"), GAITD_RIGHT);
  EXPECT_EQ(word("gait/support", "both"), GAITD_BOTH);
  EXPECT_EQ(word("foot/left/contact", "none"), GAITD_CONTACT_NONE);
  EXPECT_EQ(word("foot/left/contact", "toe"), GAITD_CONTACT_TOE);
  EXPECT_EQ(word("foot/left/contact", "full"), GAITD_CONTACT_FULL);
  EXPECT_EQ(word("leg/right/state", "straighten"),
            static_cast<int>(walking::LegState::kStraighten));
  EXPECT_EQ(word("leg/right/state", "extend"), static_cast<int>(walking::LegState::kExtend));
  EXPECT_EQ(word("wbc/status", "non_finite"), GAITD_WBC_NON_FINITE);
  EXPECT_EQ(word("wbc/status", "infeasible"), GAITD_WBC_INFEASIBLE);
  EXPECT_EQ(word("safety/state", "disarmed"), static_cast<int>(SafetyState::kDisarmed));
  EXPECT_EQ(word("safety/state", "fault"), static_cast<int>(SafetyState::kFault));
  EXPECT_EQ(word("layer/step_adjuster/variant", "fixed_steps"), 1);
}

// Ticks that differ in one figure each differ in the signals of that name, and in those alone.
class Recorded {
 public:
  explicit Recorded(bool truth = true)
      : table(table_with(truth)), data(std::make_unique<TickData>()) {
    data->has_truth = truth;
    data->robot.pelvis_orientation[3] = 1.0;
    data->truth.pelvis_orientation[3] = 1.0;
    for (auto& foot : data->robot.feet) foot.orientation[3] = 1.0;
    for (auto& foothold : data->gait.footholds) foothold.pose.orientation[3] = 1.0;
    for (auto& step : data->gait.adjusted) step.pose.orientation[3] = 1.0;
  }
  std::vector<double> values() const {
    std::vector<double> v(table.size(), -12345.0);
    record_signals(atlas(), *data, v);
    return v;
  }
  double operator[](const std::string& name) const {
    const int i = find_signal(table, name);
    EXPECT_GE(i, 0) << name;
    return i < 0 ? -12345.0 : values()[i];
  }
  SignalTable table;
  std::unique_ptr<TickData> data;
};

TEST(Signals, EveryColumnOfTheTableIsWritten) {
  for (bool truth : {false, true}) {
    const Recorded r(truth);
    const std::vector<double> values = r.values();
    for (std::size_t i = 0; i < values.size(); ++i)
      EXPECT_NE(values[i], -12345.0) << r.table[i].name;
  }
}

TEST(Signals, ValuesStandUnderTheirNames) {
  Recorded r;
  TickData& d = *r.data;
  d.time.time = 1.25;
  d.time.tick = 1250;
  d.safety = SafetyState::kWalking;
  d.faults = 5;
  d.gait.phase = GAITD_PHASE_SWING;
  d.gait.step_index = 4;
  d.robot.com[2] = 1.1;
  d.robot.com_velocity[0] = 0.3;
  d.robot.icp[1] = 0.07;
  d.plan.icp[0] = 0.4;
  d.plan.ecmp[1] = -0.1;
  d.adjustment.cmp[0] = 0.41;
  d.adjustment.kappa = 1.07;
  d.adjustment.shift[1] = 0.03;
  d.adjustment.time_shift = -0.1;
  d.robot.cop[0] = 0.39;
  sdk::store(sdk::from_roll_pitch_yaw(0.1, 0.2, 0.3), d.robot.pelvis_orientation);
  d.robot.feet[GAITD_RIGHT].position[0] = 0.55;
  d.robot.feet[GAITD_RIGHT].contact = GAITD_CONTACT_FULL;
  d.gait.footholds[GAITD_RIGHT].contact = GAITD_CONTACT_TOE;
  d.robot.feet[GAITD_LEFT].wrench[5] = 800.0;
  d.legs[GAITD_LEFT] = {walking::LegState::kBent, 0.7, 0.0, 0.0, 0.0};
  d.toe_off.active = 1;
  d.toe_off.criterion[GAITD_TOE_OFF_COP] = 0.04;
  d.wbc.info.momentum_residual = 3.5;
  d.wbc.info.iterations = 17;
  d.robot.joint_position[6] = 0.61;
  d.commands.joints[6].torque = 12.0;
  d.sensors.joints[6].torque = 11.0;
  d.times.layer_us[GAITD_LAYER_TOE_OFF] = 2.5;
  d.times.jitter_us = 9.0;
  d.truth.feet[GAITD_LEFT].slip = 0.002;
  d.truth.com[1] = 0.01;
  d.variants[GAITD_LAYER_ICP_PLANNER] = 1;
  EXPECT_EQ(r["time"], 1.25);
  EXPECT_EQ(r["tick"], 1250);
  EXPECT_EQ(r["safety/state"], 3);
  EXPECT_EQ(r["safety/faults"], 5);
  EXPECT_EQ(r["gait/phase"], 2);
  EXPECT_EQ(r["gait/step_index"], 4);
  EXPECT_EQ(r["com/z"], 1.1);
  EXPECT_EQ(r["com/velocity/x"], 0.3);
  EXPECT_EQ(r["icp/y"], 0.07);
  EXPECT_EQ(r["icp/desired/x"], 0.4);
  EXPECT_EQ(r["ecmp/reference/y"], -0.1);
  EXPECT_EQ(r["cmp/desired/x"], 0.41);
  EXPECT_EQ(r["cmp/kappa"], 1.07);
  EXPECT_EQ(r["step_adjust/dy"], 0.03);
  EXPECT_EQ(r["step_adjust/time_shift"], -0.1);
  EXPECT_EQ(r["cop/x"], 0.39);
  EXPECT_NEAR(r["pelvis/roll"], 0.1, 1e-12);
  EXPECT_NEAR(r["pelvis/pitch"], 0.2, 1e-12);
  EXPECT_NEAR(r["pelvis/yaw"], 0.3, 1e-12);
  EXPECT_EQ(r["foot/right/x"], 0.55);
  EXPECT_EQ(r["foot/right/contact"], GAITD_CONTACT_TOE);
  EXPECT_EQ(r["foot/left/contact"], GAITD_CONTACT_NONE);
  EXPECT_EQ(r["foot/left/force/z"], 800.0);
  EXPECT_EQ(r["leg/left/state"], static_cast<int>(walking::LegState::kBent));
  EXPECT_EQ(r["leg/left/knee_privileged"], 0.7);
  EXPECT_EQ(r["toe_off/active"], 1);
  EXPECT_EQ(r["toe_off/criterion/cop"], 0.04);
  EXPECT_EQ(r["wbc/momentum_residual"], 3.5);
  EXPECT_EQ(r["wbc/iterations"], 17);
  const std::string joint = std::string("joint/") + atlas().joints[6].name;
  EXPECT_EQ(r[joint + "/position"], 0.61);
  EXPECT_EQ(r[joint + "/torque_desired"], 12.0);
  EXPECT_EQ(r[joint + "/torque"], 11.0);
  EXPECT_EQ(r["tick/toe_off_us"], 2.5);
  EXPECT_EQ(r["tick/jitter_us"], 9.0);
  EXPECT_EQ(r["truth/foot/left/slip"], 0.002);
  EXPECT_EQ(r["truth/com/y"], 0.01);
  EXPECT_EQ(r["layer/icp_planner/variant"], 1);
  EXPECT_EQ(r["layer/toe_off/variant"], 0);
}

TEST(Signals, WhatAFootBearsOnIsTheExtentOfItsFoothold) {
  Recorded r;
  GaitdFoothold& foothold = r.data->gait.footholds[GAITD_RIGHT];
  EXPECT_EQ(r["foot/right/bears/front"], 0.0) << "of no polygon";
  const double corners[4][2] = {{0.13, -0.06}, {0.13, 0.01}, {-0.12, 0.01}, {-0.12, -0.06}};
  foothold.polygon_count = 4;
  for (int i = 0; i < 4; ++i) sdk::view(foothold.contact_polygon[i]) = sdk::view(corners[i]);
  EXPECT_EQ(r["foot/right/bears/back"], -0.12);
  EXPECT_EQ(r["foot/right/bears/front"], 0.13);
  EXPECT_EQ(r["foot/right/bears/right"], -0.06);
  EXPECT_EQ(r["foot/right/bears/left"], 0.01);
}

TEST(Signals, AFootstepIsTheOneAheadOfItsFootOrWhereItStands) {
  Recorded r;
  GaitdGaitState& g = r.data->gait;
  g.footholds[GAITD_LEFT].pose.position[0] = 1.0;
  g.footholds[GAITD_RIGHT].pose.position[0] = 1.3;
  EXPECT_EQ(r["footstep/left/x"], 1.0);
  EXPECT_EQ(r["footstep/right/x"], 1.3);
  g.footstep_count = 2;
  g.adjusted[0].side = GAITD_LEFT;
  g.adjusted[0].pose.position[0] = 1.6;
  g.adjusted[1].side = GAITD_RIGHT;
  g.adjusted[1].pose.position[0] = 1.9;
  EXPECT_EQ(r["footstep/left/x"], 1.6);
  EXPECT_EQ(r["footstep/right/x"], 1.9);
}

TEST(Signals, RecordingNeverAllocates) {
  const Recorded r;
  std::vector<double> values(r.table.size());
  const int before = testing::allocation_count();
  for (int i = 0; i < 10; ++i) record_signals(atlas(), *r.data, values);
  EXPECT_EQ(testing::allocation_count(), before);
}

}  // namespace
}  // namespace gaitd::daemon
