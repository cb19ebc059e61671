// SPDX-License-Identifier: Apache-2.0
// An icp_planner that does what its parameters say: for the tests of LayerSlot.
#include <limits>

#include "gaitd/sdk/layer.h"

namespace {

class ScriptedPlanner {
 public:
  enum class P { kValue, kFault, kFaultTick, kCount };
  static constexpr std::array<GaitdParameter, 3> kParameters = {
      gaitd::sdk::real_parameter("value", "m", -10, 10, 0, "x of the ICP"),
      gaitd::sdk::integer_parameter("fault", "", 0, 3, 0, "1 error, 2 NaN, 3 takes no state"),
      gaitd::sdk::integer_parameter("fault_tick", "", 0, 1000000, 0, "from when on")};

  explicit ScriptedPlanner(const GaitdModel&) {}
  void set_parameter(int index, double value) { p_.set(index, value); }
  GaitdStatus process(const GaitdIcpPlannerInput& in, GaitdIcpPlan& out) {
    out = {};
    out.size = sizeof(out);
    out.icp[0] = p_[P::kValue];
    out.kappa = 1.0;
    out.offset[0] = handed_over_;
    out.time_remaining = resets_;
    if (in.time.tick < p_[P::kFaultTick]) return GAITD_OK;
    if (p_[P::kFault] == 1.0) return GAITD_ERROR;
    if (p_[P::kFault] == 2.0) out.icp[1] = std::numeric_limits<double>::quiet_NaN();
    return GAITD_OK;
  }
  void reset() { resets_ += 1.0; }
  void get_state(GaitdIcpPlannerState& s) const { s.offset[0] = p_[P::kValue]; }
  void set_state(const GaitdIcpPlannerState& s) {
    if (p_[P::kFault] == 3.0) throw 1;
    handed_over_ = s.offset[0];
  }

 private:
  gaitd::sdk::Parameters<P> p_{kParameters};
  double handed_over_ = 0.0;
  double resets_ = 0.0;
};

}  // namespace

GAITD_EXPORT_LAYER(ScriptedPlanner, GAITD_LAYER_ICP_PLANNER, "scripted", "1.0.0", 40.0)
