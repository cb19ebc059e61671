// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace gaitd::daemon {

// Counts what this process takes from the heap. A program that links this gets malloc and its
// relatives from here, in front of those of the C library, and so do the libraries that it loads.

/// False in a build with a sanitizer, which has its own malloc: nothing is counted then.
bool allocations_are_counted();

/// Calls of malloc, calloc, realloc, memalign, aligned_alloc and posix_memalign of the process so
/// far, those by operator new included.
long allocation_count();

}  // namespace gaitd::daemon
