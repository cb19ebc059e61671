// SPDX-License-Identifier: Apache-2.0
// A layer that does as it is loaded what nobody asked it for: it leaves a trace in the file that
// GAITD_TEST_TRACE names, and where it is not being tried in a child it ends the process as if all
// were well, if GAITD_TEST_EXIT is set.
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "never.h"

namespace {

__attribute__((constructor)) void at_load() {
  const bool tried = std::getenv("GAITD_CHILD_PROCESS") != nullptr;
  const char* trace = std::getenv("GAITD_TEST_TRACE");
  if (trace != nullptr) std::ofstream(trace, std::ios::app) << (tried ? "tried\n" : "loaded\n");
  if (!tried && std::getenv("GAITD_TEST_EXIT") != nullptr) _exit(0);
}

}  // namespace

GAITD_EXPORT_LAYER(gaitd::plugins::Never, GAITD_LAYER_TOE_OFF, "evil", "1.0.0", 1000.0)
