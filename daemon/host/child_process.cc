// SPDX-License-Identifier: Apache-2.0
#include "daemon/host/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <deque>

#include "daemon/host/child_side.h"
#include "daemon/host/file_descriptor.h"
#include "gaitd/sdk/bounds.h"

extern char** environ;

namespace gaitd::daemon {
namespace {

using Clock = std::chrono::steady_clock;

// In the environment of every child. A program that does not take the role of a child by its
// arguments would run as itself and start children of its own, without end.
constexpr const char* kChildMark = "GAITD_CHILD_PROCESS";

// The model in an anonymous file, positioned at its start.
bool share_model(const GaitdModel& model, FileDescriptor* fd) {
  fd->reset(memfd_create("gaitd-model", MFD_CLOEXEC));
  return fd->get() >= 0 && write(fd->get(), &model, sizeof(model)) == sizeof(model) &&
         lseek(fd->get(), 0, SEEK_SET) == 0;
}

int spawn_child(const ChildRequest& request, int model_fd, int report_fd,
                const std::deque<FileDescriptor>& libraries, pid_t* pid) {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  // dup2 to the same number would leave close-on-exec set; all sources lie above the targets, since
  // the caller moved them there.
  posix_spawn_file_actions_adddup2(&actions, model_fd, kChildModelFd);
  posix_spawn_file_actions_adddup2(&actions, report_fd, kChildReportFd);
  for (std::size_t i = 0; i < libraries.size(); ++i) {
    posix_spawn_file_actions_adddup2(&actions, libraries[i].get(),
                                     kChildLibraryFd + static_cast<int>(i));
  }
  sigset_t none;
  sigset_t all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  sched_param ordinary{};
  posix_spawnattr_setschedpolicy(&attributes, SCHED_OTHER);
  posix_spawnattr_setschedparam(&attributes, &ordinary);
  posix_spawnattr_setpgroup(&attributes, 0);  // what it starts itself ends with it
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF |
                                            POSIX_SPAWN_SETSCHEDULER | POSIX_SPAWN_SETPGROUP);
  std::string program = request.executable.string();
  std::vector<std::string> arguments = request.arguments;
  std::vector<char*> argv = {program.data()};
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  std::string mark = std::string(kChildMark) + "=1";
  std::vector<char*> environment = {mark.data()};
  for (char** variable = environ; *variable != nullptr; ++variable) {
    environment.push_back(*variable);
  }
  environment.push_back(nullptr);
  const int error =
      posix_spawn(pid, program.c_str(), &actions, &attributes, argv.data(), environment.data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

// How long the child may run.
struct Patience {
  Clock::time_point deadline;
  const std::atomic<bool>* cancel;

  bool cancelled() const { return cancel != nullptr && *cancel; }
  // ms until somebody has to look again; 0: no longer.
  int left() const {
    constexpr long kLook = 50;
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    return cancelled() ? 0 : static_cast<int>(std::clamp(static_cast<long>(left), 0L, kLook));
  }
};

// Reads what the child reports until it closes its end or may run no longer.
void read_report(int fd, const Patience& patience, std::string* report) {
  while (const int left = patience.left()) {
    pollfd entry{fd, POLLIN, 0};
    const int ready = poll(&entry, 1, left);
    if (ready == 0 || (ready < 0 && errno == EINTR)) continue;
    if (ready < 0) return;
    char buffer[4096];
    const ssize_t n = read(fd, buffer, sizeof(buffer));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;
    if (report->size() < bounds::kChildReportBytes) {
      report->append(buffer, static_cast<std::size_t>(n));
    }
  }
}

// Waits for the end of the child, which is killed when it may run no longer.
void wait_for_end(pid_t pid, const Patience& patience, ChildEnd* end) {
  for (bool killed = false;;) {
    const pid_t ended = waitpid(pid, &end->status, killed ? 0 : WNOHANG);
    if (ended == pid || (ended < 0 && errno != EINTR)) return;
    if (ended == 0 && patience.left() == 0) {
      end->cancelled = patience.cancelled();
      end->killed = !end->cancelled;
      kill(-pid, SIGKILL);
      killed = true;
    } else if (ended == 0) {
      usleep(1000);
    }
  }
}

std::string signal_name(int signal) {
  const char* name = sigabbrev_np(signal);
  return name == nullptr ? "signal " + std::to_string(signal) : std::string("SIG") + name;
}

ChildEnd no_child(const std::string& what, int error) {
  ChildEnd end;
  end.start_error = what + ": " + std::strerror(error);
  return end;
}

}  // namespace

std::string ChildEnd::last(const std::string& key) const {
  std::size_t begin = report.rfind("\n" + key);
  if (begin == std::string::npos) return "";
  begin += 1 + key.size();
  return report.substr(begin, report.find('\n', begin) - begin);
}

std::string ChildEnd::abnormal_end() const {
  if (killed) return "hung: not done after " + std::to_string(timeout.count()) + " ms";
  if (cancelled) return "was ended, since gaitd stops";
  if (WIFSIGNALED(status)) return "crashed with " + signal_name(WTERMSIG(status));
  const bool done = report.ends_with("\ndone\n") && WEXITSTATUS(status) == 0;
  if (done || !last("error ").empty()) return "";
  return "ended the process with exit code " + std::to_string(WEXITSTATUS(status));
}

ChildEnd run_child(const ChildRequest& request) {
  if (std::getenv(kChildMark) != nullptr) {
    return no_child("a child process starts no child", EPERM);
  }
  FileDescriptor model_fd;
  if (!share_model(*request.model, &model_fd)) return no_child("memfd_create", errno);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return no_child("pipe", errno);
  FileDescriptor report_read(ends[0]);
  FileDescriptor report_write(ends[1]);
  const int above = kChildLibraryFd + static_cast<int>(request.library_fds.size());
  const auto high = [above](int fd) { return fcntl(fd, F_DUPFD_CLOEXEC, above); };
  const FileDescriptor high_model(high(model_fd.get()));
  FileDescriptor high_report(high(report_write.get()));
  if (high_model.get() < 0 || high_report.get() < 0) return no_child("dup", errno);
  std::deque<FileDescriptor> libraries;
  for (const int fd : request.library_fds) {
    libraries.emplace_back(high(fd));
    if (libraries.back().get() < 0) return no_child("dup", errno);
  }

  pid_t pid = -1;
  const Patience patience{Clock::now() + request.timeout, request.cancel};
  const int error = spawn_child(request, high_model.get(), high_report.get(), libraries, &pid);
  if (error != 0) return no_child("start of " + request.executable.string(), error);
  report_write.reset();
  high_report.reset();

  ChildEnd end;
  end.timeout = request.timeout;
  end.report = "\n";
  read_report(report_read.get(), patience, &end.report);
  wait_for_end(pid, patience, &end);
  return end;
}

}  // namespace gaitd::daemon
