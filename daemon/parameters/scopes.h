// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "gaitd/abi/plugin.h"

namespace gaitd::daemon {

/// Who owns a parameter: one of the layers (GAITD_LAYER_*), or one of these scopes of the daemon.
enum ParameterOwner : int {
  kGaitParameterOwner = GAITD_LAYER_COUNT,
  kSwingParameterOwner,
  kLegParameterOwner,
  kObjectiveParameterOwner,
  kSafetyParameterOwner,
  kLimitParameterOwner,
  kSwapParameterOwner,
  kDriveParameterOwner,
  kParameterOwnerCount
};

/// One scope of the daemon with the table that declares its parameters.
struct DaemonScope {
  int owner;
  std::string_view name;  ///< before the dot of its keys
  std::span<const GaitdParameter> table;
  std::string_view holds;  ///< what it is about, for the reference
};

/// In the order of ParameterOwner.
std::span<const DaemonScope> daemon_scopes();

/// When a change takes effect.
struct ParameterEffect {
  enum Kind { kAtOnce, kLater, kAtRest, kBounded } kind = kAtOnce;
  /// kLater: what a new value holds for. kAtRest: why not while the robot walks or readies.
  /// kBounded: why not every value of the range then.
  const char* text = "";
  /// kBounded: what it may be set to while the robot walks or readies, within the range.
  double minimum = 0.0, maximum = 0.0;
};

/// Of the parameter with this key; those that nothing is said of take effect at once.
ParameterEffect parameter_effect(std::string_view key);
/// "at once; while walking 0.5..1", of kBounded.
std::string bounded_text(const ParameterEffect& effect);
/// How many parameters take effect otherwise than at once.
int parameter_rule_count();

}  // namespace gaitd::daemon
