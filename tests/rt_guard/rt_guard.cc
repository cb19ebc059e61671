// SPDX-License-Identifier: Apache-2.0
// Preloaded into gaitd by a test: counts what must not happen within a tick – taking or giving back
// memory, page faults, calls that may block – and names the first of each. Locks the memory of the
// process, as gaitd does with the realtime clock. At the end a line of JSON goes to the file
// $GAITD_RT_GUARD. Ticks before $GAITD_RT_GUARD_WARM_UP are not counted.
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sys/epoll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>

namespace {

struct Counter {
  const char* name;
  unsigned long count = 0;
  unsigned long first_tick = 0;
  const char* first_call = "";
  void* trace[24] = {};
  int depth = 0;
};
Counter memory{"memory"};
Counter blocking{"blocking"};
Counter faults{"faults"};
unsigned long ticks = 0;
unsigned long warm_up = 0;

// Written by one thread only: the one within a tick.
__attribute__((tls_model("initial-exec"))) thread_local bool within = false;
__attribute__((tls_model("initial-exec"))) thread_local rusage before;

void happened(Counter& counter, const char* call) {
  if (!within || ticks < warm_up) return;
  if (counter.count++ != 0) return;
  within = false;  // what the backtrace does is its own business
  counter.first_tick = ticks;
  counter.first_call = call;
  counter.depth = backtrace(counter.trace, 24);
  within = true;
}

void say(FILE* out, const Counter& counter) {
  std::fprintf(out, ", \"%s\": %lu", counter.name, counter.count);
  if (counter.count == 0) return;
  std::fprintf(out, ", \"first_%s\": \"%s in tick %lu\"", counter.name, counter.first_call,
               counter.first_tick);
  backtrace_symbols_fd(counter.trace, counter.depth, STDERR_FILENO);
}

__attribute__((constructor)) void begin() {
  void* warm[2];
  backtrace(warm, 2);  // loads what it needs
  if (const char* text = std::getenv("GAITD_RT_GUARD_WARM_UP")) warm_up = std::atol(text);
  mlockall(MCL_CURRENT | MCL_FUTURE);
}

__attribute__((destructor)) void end() {
  const char* file = std::getenv("GAITD_RT_GUARD");
  if (file == nullptr || ticks == 0) return;
  FILE* out = std::fopen(file, "w");
  if (out == nullptr) return;
  std::fprintf(out, "{\"ticks\": %lu", ticks);
  for (const Counter* counter : {&memory, &blocking, &faults}) say(out, *counter);
  std::fprintf(out, "}\n");
  std::fclose(out);
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

// Called by gaitd (daemon/control/tick_guard.h).
void gaitd_tick_begins() {
  getrusage(RUSAGE_THREAD, &before);
  within = true;
}
void gaitd_tick_ends() {
  within = false;
  rusage now;
  getrusage(RUSAGE_THREAD, &now);
  const long count = now.ru_minflt - before.ru_minflt + now.ru_majflt - before.ru_majflt;
  if (count > 0 && ticks >= warm_up) {
    if (faults.count == 0) {
      faults.first_tick = ticks;
      faults.first_call = "page fault";
    }
    faults.count += static_cast<unsigned long>(count);
  }
  ++ticks;
}

void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) {
  happened(memory, "malloc");
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  happened(memory, "calloc");
  return __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) {
  happened(memory, "realloc");
  return __libc_realloc(block, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  happened(memory, "aligned_alloc");
  return __libc_memalign(alignment, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  happened(memory, "memalign");
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  happened(memory, "posix_memalign");
  *block = __libc_memalign(alignment, size);
  return *block == nullptr ? 12 : 0;
}
void free(void* block) {
  if (block != nullptr) happened(memory, "free");
  __libc_free(block);
}

#define GAITD_BLOCKING(result, name, declaration, arguments)     \
  result name declaration {                                      \
    static const auto real = next<result(*) declaration>(#name); \
    happened(blocking, #name);                                   \
    return real arguments;                                       \
  }
GAITD_BLOCKING(int, pthread_mutex_lock, (pthread_mutex_t * m), (m))
GAITD_BLOCKING(int, pthread_rwlock_rdlock, (pthread_rwlock_t * l), (l))
GAITD_BLOCKING(int, pthread_rwlock_wrlock, (pthread_rwlock_t * l), (l))
GAITD_BLOCKING(int, pthread_cond_wait, (pthread_cond_t * c, pthread_mutex_t* m), (c, m))
GAITD_BLOCKING(int, nanosleep, (const timespec* t, timespec* rest), (t, rest))
GAITD_BLOCKING(int, clock_nanosleep, (clockid_t c, int f, const timespec* t, timespec* r),
               (c, f, t, r))
GAITD_BLOCKING(ssize_t, read, (int fd, void* data, std::size_t size), (fd, data, size))
GAITD_BLOCKING(ssize_t, write, (int fd, const void* data, std::size_t size), (fd, data, size))
GAITD_BLOCKING(ssize_t, send, (int fd, const void* data, std::size_t size, int flags),
               (fd, data, size, flags))
GAITD_BLOCKING(ssize_t, recv, (int fd, void* data, std::size_t size, int flags),
               (fd, data, size, flags))
GAITD_BLOCKING(int, poll, (pollfd * fds, nfds_t count, int timeout), (fds, count, timeout))
GAITD_BLOCKING(int, epoll_wait, (int fd, epoll_event* events, int count, int timeout),
               (fd, events, count, timeout))
GAITD_BLOCKING(int, fsync, (int fd), (fd))

}  // extern "C"
