// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gaitd/abi/backend.h"

namespace gaitd::daemon {

// Pushes the simulated robot. Null, or why it was not pushed: a backend that has no pushes, and one
// that refuses this one.
inline const char* sim_push(const GaitdBackendInstance& backend, const GaitdDisturbance& push) {
  const GaitdStatus status = backend.vtable->disturb == nullptr
                                 ? GaitdStatus{GAITD_NOT_SUPPORTED}
                                 : backend.vtable->disturb(backend.self, &push);
  if (status == GAITD_NOT_SUPPORTED) {
    return "this backend is no simulation; start gaitd with --backend simbody";
  }
  if (status != GAITD_OK) {
    return "the simulation refused the force; look at link, figures and duration";
  }
  return nullptr;
}

}  // namespace gaitd::daemon
