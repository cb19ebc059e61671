// SPDX-License-Identifier: Apache-2.0
// Who may do what over the command sockets: the one table. docs/security.md shows it to people, and
// a test compares the two.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

namespace gaitd::daemon {

class Stream;  // daemon/server/stream.h

/// Each role may do what those before it may.
enum class Role : std::uint8_t { kObserve, kCommand, kAdminister };
inline constexpr std::array<std::string_view, 3> kRoleNames = {"observe", "command", "administer"};
constexpr std::string_view role_name(Role role) {
  return kRoleNames[static_cast<std::size_t>(role)];
}

/// Who sent a request.
struct Caller {
  std::uint64_t connection = 0;  ///< tells the clients apart; never used twice
  Role role = Role::kAdminister;
  std::uint64_t estops = 0;  ///< that had been read before the request was (EstopFlag)
  std::uint64_t estop = 0;   ///< number of the one that was raised for it as it was read; 0: none
  std::shared_ptr<Stream> stream = nullptr;  ///< back to it; null where there is none
};

struct MethodRight {
  std::string_view method;
  Role least;
};

/// Every JSON-RPC method with the least role that may call it, by name.
std::span<const MethodRight> method_rights();

/// The least role that may call `method`; of one that is not in the table the highest.
Role least_role(std::string_view method);

/// The scopes of parameters that only an administrator changes, and on a robot only while it is
/// disarmed: what keeps it from hurting itself is not for whoever commands it.
inline constexpr std::array<std::string_view, 4> kGuardedScopes = {"safety", "limits", "swap",
                                                                   "realtime"};
/// Whether `parameter` ("safety.tilt_limit") is in one of kGuardedScopes.
bool is_guarded(std::string_view parameter);

}  // namespace gaitd::daemon
