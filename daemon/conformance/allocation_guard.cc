// SPDX-License-Identifier: Apache-2.0
#include "daemon/conformance/allocation_guard.h"

#include <atomic>
#include <cerrno>
#include <cstddef>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)

namespace gaitd::daemon {
bool allocations_are_counted() { return false; }
long allocation_count() { return 0; }
}  // namespace gaitd::daemon

#else

namespace {
// Constant initialisation: malloc is called before any constructor.
constinit std::atomic<long> allocations{0};

void count() { allocations.fetch_add(1, std::memory_order_relaxed); }
}  // namespace

#define GAITD_INTERPOSE extern "C" __attribute__((visibility("default")))

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t number, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

GAITD_INTERPOSE void* malloc(std::size_t size) {
  count();
  return __libc_malloc(size);
}
GAITD_INTERPOSE void* calloc(std::size_t number, std::size_t size) {
  count();
  return __libc_calloc(number, size);
}
GAITD_INTERPOSE void* realloc(void* old, std::size_t size) {
  count();
  return __libc_realloc(old, size);
}
GAITD_INTERPOSE void* memalign(std::size_t alignment, std::size_t size) {
  count();
  return __libc_memalign(alignment, size);
}
GAITD_INTERPOSE void* aligned_alloc(std::size_t alignment, std::size_t size) {
  count();
  return __libc_memalign(alignment, size);
}
GAITD_INTERPOSE int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  count();
  void* const found = __libc_memalign(alignment, size);
  if (found == nullptr) return ENOMEM;
  *memory = found;
  return 0;
}

namespace gaitd::daemon {
bool allocations_are_counted() { return true; }
long allocation_count() { return allocations.load(std::memory_order_relaxed); }
}  // namespace gaitd::daemon

#endif
