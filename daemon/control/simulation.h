// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "gaitd/abi/backend.h"

namespace gaitd::daemon {

inline constexpr const char* kNoSimulation =
    "this backend is no simulation; start gaitd with --backend simbody";

// Pushes the simulated robot. Null, or why it was not pushed: a backend that has no pushes, and one
// that refuses this one.
inline const char* sim_push(const GaitdBackendInstance& backend, const GaitdDisturbance& push) {
  const GaitdStatus status = backend.vtable->disturb == nullptr
                                 ? GaitdStatus{GAITD_NOT_SUPPORTED}
                                 : backend.vtable->disturb(backend.self, &push);
  if (status == GAITD_NOT_SUPPORTED) {
    return kNoSimulation;
  }
  if (status != GAITD_OK) {
    return "the simulation refused the force; look at link, figures and duration";
  }
  return nullptr;
}

// Loads it, likewise.
inline const char* sim_load(const GaitdBackendInstance& backend, const GaitdLoad& load) {
  const GaitdBackendVtable& v = *backend.vtable;
  const bool can =
      v.size >= offsetof(GaitdBackendVtable, carry) + sizeof(v.carry) && v.carry != nullptr;
  const GaitdStatus status = can ? v.carry(backend.self, &load) : GaitdStatus{GAITD_NOT_SUPPORTED};
  if (status == GAITD_NOT_SUPPORTED) {
    return "this backend cannot change masses; start gaitd with --backend simbody";
  }
  if (status != GAITD_OK) return "the simulation refused the load; look at link and figures";
  return nullptr;
}

}  // namespace gaitd::daemon
