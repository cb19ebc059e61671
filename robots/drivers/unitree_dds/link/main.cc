// SPDX-License-Identifier: Apache-2.0
// gaitd-unitree-link: started by the backend unitree_dds with the shared memory and a socket to it.
//   gaitd-unitree-link realtime|lockstep SETTINGS [rescue]
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <cstdio>
#include <cstring>
#include <exception>

#include "link.h"

namespace {

gaitd::unitree::Link* running = nullptr;
void stop(int) {
  if (running != nullptr) running->stop();
}

int fail(const char* text) {
  std::fprintf(stderr, "gaitd-unitree-link: %s\n", text);
  return 2;
}

// Threads that are made later have it too.
void ask_for_real_time() {
  sched_param parameters{};
  parameters.sched_priority = 60;
  sched_setscheduler(0, SCHED_FIFO, &parameters);
  // With a limit, memory that is asked for later would be refused.
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  if (limit.rlim_cur == RLIM_INFINITY) mlockall(MCL_CURRENT | MCL_FUTURE);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace gaitd::unitree;  // NOLINT(google-build-using-namespace): of this function
  if (argc < 3) return fail("is started by gaitd --backend unitree_dds, not by hand");
  struct stat memory {};
  if (fstat(kExchangeFd, &memory) != 0 || memory.st_size < static_cast<off_t>(sizeof(Exchange))) {
    return fail("expected the memory of gaitd --backend unitree_dds, got none");
  }
  void* exchange = mmap(nullptr, sizeof(Exchange), PROT_READ | PROT_WRITE,
                        MAP_SHARED | MAP_POPULATE, kExchangeFd, 0);
  if (exchange == MAP_FAILED) return fail("the memory of gaitd cannot be mapped");
  const bool lockstep = std::strcmp(argv[1], "lockstep") == 0;
  const bool rescue = argc > 3 && std::strcmp(argv[3], "rescue") == 0;
  // A terminal's and a session's end are gaitd's business, which then tells.
  // And so is a watchdog that takes gaitd for hung: then this has to damp.
  signal(SIGINT, SIG_IGN);
  signal(SIGABRT, SIG_IGN);
  signal(SIGHUP, SIG_IGN);
  signal(SIGPIPE, SIG_IGN);
  signal(SIGTERM, stop);
  if (!lockstep) ask_for_real_time();
  try {
    Link link(from_text(argv[2]), lockstep, rescue, static_cast<Exchange*>(exchange));
    running = &link;
    const int code = link.run();
    running = nullptr;
    return code;
  } catch (const std::exception& problem) {
    const std::string text = std::string(1, static_cast<char>(Talk::kLog)) +
                             static_cast<char>('0' + GAITD_LOG_ERROR) + problem.what();
    send(kTalkFd, text.data(), text.size(), MSG_NOSIGNAL);
    return 1;
  }
}
