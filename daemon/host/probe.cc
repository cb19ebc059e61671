// SPDX-License-Identifier: Apache-2.0
#include "daemon/host/probe.h"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <string>

#include "daemon/host/probe_child.h"

extern char** environ;

namespace gaitd::daemon {
namespace {

// Every program that can probe can be the child as well, whatever its main() does.
__attribute__((constructor)) void become_probe_child(int argc, char** argv, char**) {
  if (argc == 3 && std::strcmp(argv[1], kProbeArgument) == 0) _exit(run_probe_child(argv[2]));
}

using Clock = std::chrono::steady_clock;

// A file descriptor that closes itself.
class Fd {
 public:
  explicit Fd(int fd = -1) : fd_(fd) {}
  ~Fd() { reset(); }
  Fd(const Fd&) = delete;
  Fd& operator=(const Fd&) = delete;
  int get() const { return fd_; }
  void reset(int fd = -1) {
    if (fd_ >= 0) close(fd_);
    fd_ = fd;
  }

 private:
  int fd_;
};

// The model in an anonymous file, positioned at its start.
bool share_model(const GaitdModel& model, Fd* fd) {
  fd->reset(memfd_create("gaitd-probe-model", MFD_CLOEXEC));
  return fd->get() >= 0 && write(fd->get(), &model, sizeof(model)) == sizeof(model) &&
         lseek(fd->get(), 0, SEEK_SET) == 0;
}

int spawn_child(const std::filesystem::path& executable, const std::filesystem::path& library,
                int model_fd, int report_fd, pid_t* pid) {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  // dup2 to the same number would leave close-on-exec set; both sources lie above the targets,
  // since the caller moved them there.
  posix_spawn_file_actions_adddup2(&actions, model_fd, kProbeModelFd);
  posix_spawn_file_actions_adddup2(&actions, report_fd, kProbeReportFd);
  sigset_t none;
  sigset_t all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  sched_param ordinary{};
  posix_spawnattr_setschedpolicy(&attributes, SCHED_OTHER);
  posix_spawnattr_setschedparam(&attributes, &ordinary);
  posix_spawnattr_setflags(
      &attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSCHEDULER);
  std::string program = executable.string();
  std::string command = kProbeArgument;
  std::string file = library.string();
  char* argv[] = {program.data(), command.data(), file.data(), nullptr};
  const int error = posix_spawn(pid, program.c_str(), &actions, &attributes, argv, environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

// Reads what the child reports until it closes its end. False if the time ran out.
bool read_report(int fd, Clock::time_point deadline, std::string* report) {
  constexpr std::size_t kMaximumReport = 64 * 1024;
  for (;;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return false;
    pollfd entry{fd, POLLIN, 0};
    const int ready = poll(&entry, 1, static_cast<int>(left));
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) return false;
    char buffer[4096];
    const ssize_t n = read(fd, buffer, sizeof(buffer));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return true;
    if (report->size() < kMaximumReport) report->append(buffer, static_cast<std::size_t>(n));
  }
}

// Waits for the end of the child, which has until the deadline before it is killed.
int wait_for_end(pid_t pid, Clock::time_point deadline, bool* killed) {
  int status = 0;
  *killed = false;
  for (;;) {
    const pid_t ended = waitpid(pid, &status, *killed ? 0 : WNOHANG);
    if (ended == pid) return status;
    if (ended < 0 && errno != EINTR) return 0;
    if (ended == 0 && Clock::now() >= deadline) {
      kill(pid, SIGKILL);
      *killed = true;
    } else if (ended == 0) {
      usleep(1000);
    }
  }
}

std::string signal_name(int signal) {
  const char* name = sigabbrev_np(signal);
  return name == nullptr ? "signal " + std::to_string(signal) : std::string("SIG") + name;
}

// The last line that begins with `key`, without it.
std::string last_of(const std::string& report, const std::string& key) {
  std::size_t begin = report.rfind("\n" + key);
  if (begin == std::string::npos) return "";
  begin += 1 + key.size();
  return report.substr(begin, report.find('\n', begin) - begin);
}

void judge(const std::string& report, int status, bool killed, std::chrono::milliseconds timeout,
           Refusal* refusal) {
  const std::string step = last_of(report, "step ");
  const std::string where = "probe in a child process, " + (step.empty() ? "start" : step);
  const std::string error = last_of(report, "error ");
  const char* remedy = "debug the plugin: nothing of it has run in gaitd itself";
  if (killed) {
    refusal->add(where, "hung: not done after " + std::to_string(timeout.count()) + " ms",
                 "an end in that time", remedy);
  } else if (WIFSIGNALED(status)) {
    refusal->add(where, "crashed with " + signal_name(WTERMSIG(status)), "no crash", remedy);
  } else if (!error.empty()) {
    refusal->add(where, error, "success", "mend what the message names");
  } else if (report.find("\ndone\n") == std::string::npos) {
    refusal->add(where, "ended the process with exit code " + std::to_string(WEXITSTATUS(status)),
                 "no end of the process", remedy);
  }
}

}  // namespace

bool probe(const std::filesystem::path& library, const GaitdModel& model, Refusal* refusal,
           const ProbeOptions& options) {
  const std::size_t before = refusal->reasons.size();
  const auto fail = [&](const char* what, int error) {
    refusal->add("probe", std::string(what) + ": " + std::strerror(error), "a child process",
                 "free file descriptors, memory or processes of this machine");
    return false;
  };
  Fd model_fd;
  if (!share_model(model, &model_fd)) return fail("memfd_create", errno);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return fail("pipe", errno);
  Fd report_read(ends[0]);
  Fd report_write(ends[1]);
  const Fd high_model(fcntl(model_fd.get(), F_DUPFD_CLOEXEC, kProbeReportFd + 1));
  Fd high_report(fcntl(report_write.get(), F_DUPFD_CLOEXEC, kProbeReportFd + 1));
  if (high_model.get() < 0 || high_report.get() < 0) return fail("dup", errno);

  pid_t pid = -1;
  const Clock::time_point deadline = Clock::now() + options.timeout;
  const int error =
      spawn_child(options.executable, library, high_model.get(), high_report.get(), &pid);
  if (error != 0) return fail(("start of " + options.executable.string()).c_str(), error);
  report_write.reset();
  high_report.reset();

  std::string report = "\n";
  read_report(report_read.get(), deadline, &report);
  bool killed = false;
  const int status = wait_for_end(pid, deadline, &killed);
  judge(report, status, killed, options.timeout, refusal);
  return refusal->reasons.size() == before;
}

}  // namespace gaitd::daemon
