// SPDX-License-Identifier: Apache-2.0
#include "daemon/replay/stages.h"

#include "daemon/log/glob.h"

namespace gaitd::daemon {
namespace {

struct Rule {
  const char* glob;
  SignalStage stage;
};

constexpr SignalStage kNone{};
constexpr SignalStage kEstimator{"state_estimator", 1};
constexpr SignalStage kGait{"gait machine", 2};
constexpr SignalStage kTasks{"task_source", 3};
constexpr SignalStage kPlanner{"icp_planner", 4};
constexpr SignalStage kAdjuster{"step_adjuster", 5};
constexpr SignalStage kToeOff{"toe_off", 6};
constexpr SignalStage kObjectives{"objectives", 7};
constexpr SignalStage kController{"whole_body_controller", 8};
constexpr SignalStage kSafety{"safety", 9};

// The first that fits.
constexpr Rule kRules[] = {
    {"tick/*", kNone},
    {"truth/*", kNone},
    {"wbc/solve_us", kNone},
    {"joint/*/torque", kNone},
    {"layer/*/variant", kSafety},
    {"gait/*", kGait},
    {"footstep/*", kGait},
    {"foot/*/contact", kGait},
    {"icp/margin", kGait},
    {"drive/*", kGait},
    {"icp/error", kPlanner},
    {"pose/clearance", kObjectives},
    {"pose/*", kTasks},
    {"hand/*", kTasks},
    {"icp/desired/*", kPlanner},
    {"ecmp/reference/*", kPlanner},
    {"ecmp/desired/*", kAdjuster},
    {"cmp/*", kAdjuster},
    {"step_adjust/*", kAdjuster},
    {"toe_off/*", kToeOff},
    {"leg/*", kObjectives},
    {"com/height_target", kObjectives},
    {"wbc/*", kController},
    {"foot/*/force_desired/*", kController},
    {"joint/*/torque_desired", kSafety},
    {"safety/*", kSafety},
    {"*", kEstimator},
};

}  // namespace

SignalStage stage_of(std::string_view signal) {
  for (const Rule& rule : kRules) {
    if (glob_match(rule.glob, signal)) return rule.stage;
  }
  return kNone;
}

}  // namespace gaitd::daemon
