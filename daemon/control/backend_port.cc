// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/backend_port.h"

#include <cstddef>

#include "daemon/host/instance.h"

namespace gaitd::daemon {

template <class Function>
GaitdStatus BackendPort::call(Function&& function) {
  inside_.store(true, std::memory_order_relaxed);
  const GaitdStatus status = contained(function);
  inside_.store(false, std::memory_order_relaxed);
  return status;
}

GaitdStatus BackendPort::read(GaitdSensors* sensors) {
  const GaitdStatus status = call([&] { return backend_.vtable->read(backend_.self, sensors); });
  problem_ = "read failed";
  if (status != GAITD_OK) return status;
  problem_ = "wrong number of joints, IMUs or feet";
  const bool of_model = sensors->joint_count == model_.joint_count &&
                        sensors->imu_count == model_.imu_count &&
                        (sensors->foot_count == 0 || sensors->foot_count == int{GAITD_MAX_FEET});
  return of_model ? GAITD_OK : GAITD_INVALID_ARGUMENT;
}

bool BackendPort::write(const GaitdJointCommands& commands) {
  return call([&] { return backend_.vtable->write(backend_.self, &commands); }) == GAITD_OK;
}

bool BackendPort::advance() {
  return call([&] { return backend_.vtable->advance(backend_.self); }) == GAITD_OK;
}

bool BackendPort::truth(GaitdTruth* truth) {
  return backend_.vtable->truth != nullptr &&
         call([&] { return backend_.vtable->truth(backend_.self, truth); }) == GAITD_OK;
}

std::uint32_t BackendPort::health() {
  if (backend_.vtable->health == nullptr) return 0;
  GaitdHealth health{};
  const bool known =
      call([&] { return backend_.vtable->health(backend_.self, &health); }) == GAITD_OK;
  return known ? health.conditions : std::uint32_t{GAITD_HEALTH_BUS};
}

const char* BackendPort::push(const GaitdDisturbance& push) {
  if (!has_pushes()) return kNoSimulation;
  const GaitdStatus status = call([&] { return backend_.vtable->disturb(backend_.self, &push); });
  if (status == GAITD_NOT_SUPPORTED) return kNoSimulation;
  if (status != GAITD_OK) {
    return "the simulation refused the force; look at link, figures and duration";
  }
  return nullptr;
}

const char* BackendPort::load(const GaitdLoad& load) {
  const GaitdBackendVtable& v = *backend_.vtable;
  const bool can =
      v.size >= offsetof(GaitdBackendVtable, carry) + sizeof(v.carry) && v.carry != nullptr;
  const GaitdStatus status =
      can ? call([&] { return v.carry(backend_.self, &load); }) : GaitdStatus{GAITD_NOT_SUPPORTED};
  if (status == GAITD_NOT_SUPPORTED) {
    return "this backend cannot change masses; start gaitd with --backend simbody";
  }
  if (status != GAITD_OK) return "the simulation refused the load; look at link and figures";
  return nullptr;
}

bool BackendPort::reset() {
  return backend_.vtable->reset != nullptr &&
         call([&] { return backend_.vtable->reset(backend_.self); }) == GAITD_OK;
}

}  // namespace gaitd::daemon
