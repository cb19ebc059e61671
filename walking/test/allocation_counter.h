// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace gaitd::testing {

// Calls of malloc, calloc, realloc, aligned_alloc and posix_memalign by this program so far, of the
// C++ operators and of Eigen (which calls malloc itself) alike. Programs that use it link
// allocation_counter.cc with --wrap for these names.
int allocation_count();

}  // namespace gaitd::testing
