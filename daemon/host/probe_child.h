// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace gaitd::daemon {

// The child of probe() is started as `<program> kProbeArgument <library>` with the model readable
// on kProbeModelFd. It writes lines to kProbeReportFd: "step <name>" before each step, "error
// <text>" when one fails, "done" when all went well.
inline constexpr const char* kProbeArgument = "--gaitd-probe-plugin";
inline constexpr int kProbeModelFd = 3;
inline constexpr int kProbeReportFd = 4;

/// Runs the child to its end and returns its exit code.
int run_probe_child(const char* library);

}  // namespace gaitd::daemon
