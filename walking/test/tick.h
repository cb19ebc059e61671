// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace gaitd::testing {

inline constexpr double kDt = 1e-3;  // s, of a tick

}  // namespace gaitd::testing
