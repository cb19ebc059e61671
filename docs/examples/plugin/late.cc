// SPDX-License-Identifier: Apache-2.0
// A toe-off that waits: the trailing foot rolls in the last share of each transfer, whatever the
// capture point does.
#include <algorithm>
#include <iterator>

#include "gaitd/sdk/layer.h"

namespace {

class Late {
 public:
  static constexpr std::array<GaitdParameter, 1> kParameters = {gaitd::sdk::real_parameter(
      "share", "", 0, 1, 0.2, "of the transfer, at its end, in which the foot rolls")};

  explicit Late(const GaitdModel& model) : model_(model) {}
  void set_parameter(int, double value) { share_ = value; }
  GaitdStatus process(const GaitdToeOffInput& in, GaitdToeOff& out) {
    out = {};
    out.size = sizeof(out);
    out.side = GAITD_BOTH;
    const GaitdGaitState& gait = *in.gait;
    const int side = gait.trailing_side;
    if (side != GAITD_LEFT && side != GAITD_RIGHT) return GAITD_OK;
    const auto& toe = model_.feet[side].toe_point;
    std::copy(std::begin(toe), std::end(toe), out.toe_point);
    const bool late = gait.phase == GAITD_PHASE_TRANSFER && gait.transfer_final == 0 &&
                      gait.time_remaining < share_ * gait.phase_duration;
    if (late) {
      out.active = 1;
      out.side = side;
    }
    return GAITD_OK;
  }
  void reset() {}
  void get_state(GaitdToeOffState& s) const { s.side = GAITD_BOTH; }
  void set_state(const GaitdToeOffState&) {}

 private:
  const GaitdModel model_;
  double share_ = 0.2;
};

}  // namespace

GAITD_EXPORT_LAYER(Late, GAITD_LAYER_TOE_OFF, "late", "1.0.0", 5.0)
