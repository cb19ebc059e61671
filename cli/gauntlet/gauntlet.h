// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gaitd::cli {

/// The kinds of ground and task of which the gauntlet draws scenarios; see docs/gauntlet.md.
const std::vector<std::string>& gauntlet_kinds();

/// The scenario (schema gaitd.scenario/1) of one of these kinds and a seed, as text: the same to
/// the byte on every machine. Ground, task, friction, masses and pushes are drawn; gait mode,
/// estimator and drives are left to whoever plays it.
std::string gauntlet_scenario(std::string_view kind, std::uint64_t seed);

}  // namespace gaitd::cli
