// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "daemon/log/log_reader.h"
#include "daemon/verdict/run_figures.h"
#include "daemon/verdict/verdict.h"

namespace gaitd::daemon {

// The figures that every verdict carries, whatever is expected.
std::vector<Figure> summarise(const LogReader& log, const RunData& run, const RunFigures& figures);

}  // namespace gaitd::daemon
