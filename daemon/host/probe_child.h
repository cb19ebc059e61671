// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace gaitd::daemon {

// The child of probe() is started as `<program> kProbeArgument <library>...`. Besides what
// child_side.h says it writes "step <name>" before each step and "survived <library>" after all of
// one.
inline constexpr const char* kProbeArgument = "--gaitd-probe-plugin";

/// Runs the child to its end and returns its exit code. `count` paths of libraries.
int run_probe_child(const char* const* libraries, int count);

}  // namespace gaitd::daemon
