// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/impedance.h"

namespace gaitd::daemon {

void set_impedance(const ImpedanceProfile& profile, walking::ObjectiveBuilder* objectives) {
  using Impedance = walking::ObjectiveBuilder::Impedance;
  if (!profile.given) return;
  objectives->set_impedance(Impedance::kSupport, profile.support.stiffness,
                            profile.support.damping);
  objectives->set_impedance(Impedance::kSwing, profile.swing.stiffness, profile.swing.damping);
  objectives->set_impedance(Impedance::kHeelStrike, profile.heel_strike.stiffness,
                            profile.heel_strike.damping);
}

}  // namespace gaitd::daemon
