// SPDX-License-Identifier: Apache-2.0
#include "daemon/server/rights.h"

#include <algorithm>

namespace gaitd::daemon {
namespace {

constexpr MethodRight kRights[] = {
    {"abort", Role::kCommand},
    {"arm", Role::kCommand},
    {"disarm", Role::kCommand},
    {"drive", Role::kCommand},
    {"estop", Role::kObserve},
    {"footsteps", Role::kCommand},
    {"goto", Role::kCommand},
    {"handhold.release", Role::kCommand},
    {"handhold.take", Role::kCommand},
    {"joint.list", Role::kObserve},
    {"joint.test", Role::kAdminister},
    {"map.clear", Role::kCommand},
    {"map.get", Role::kObserve},
    {"map.put", Role::kCommand},
    {"mode", Role::kCommand},
    {"param.get", Role::kObserve},
    {"param.list", Role::kObserve},
    {"param.set", Role::kCommand},
    {"pause", Role::kCommand},
    {"payload.clear", Role::kCommand},
    {"payload.estimate", Role::kCommand},
    {"payload.set", Role::kCommand},
    {"plugin.list", Role::kObserve},
    {"plugin.rollback", Role::kAdminister},
    {"plugin.swap", Role::kAdminister},
    {"pose", Role::kCommand},
    {"reset", Role::kCommand},
    {"resume", Role::kCommand},
    {"robot.describe", Role::kObserve},
    {"sim.load", Role::kAdminister},
    {"sim.push", Role::kAdminister},
    {"sim.reset", Role::kAdminister},
    {"status", Role::kObserve},
    {"stop", Role::kCommand},
    {"tare", Role::kCommand},
    {"telemetry.subscribe", Role::kObserve},
    {"telemetry.unsubscribe", Role::kObserve},
    {"version", Role::kObserve},
    {"walk", Role::kCommand},
};
static_assert(std::ranges::is_sorted(kRights, {}, &MethodRight::method));

}  // namespace

std::span<const MethodRight> method_rights() { return kRights; }

Role least_role(std::string_view method) {
  const auto* row = std::ranges::lower_bound(kRights, method, {}, &MethodRight::method);
  return row != std::end(kRights) && row->method == method ? row->least : Role::kAdminister;
}

bool is_guarded(std::string_view parameter) {
  const std::string_view scope = parameter.substr(0, parameter.find_first_of("./"));
  return std::ranges::find(kGuardedScopes, scope) != kGuardedScopes.end();
}

}  // namespace gaitd::daemon
