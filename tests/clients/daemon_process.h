// SPDX-License-Identifier: Apache-2.0
// A gaitd of its own for a test.
#pragma once

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "daemon/server/test/raw_client.h"

namespace gaitd::clients {

class DaemonProcess {
 public:
  // Starts gaitd (GAITD_PROGRAM) on `socket`, with a limit of open files if `files` is not 0. What
  // it says goes to `output`.
  DaemonProcess(const std::string& socket, const std::string& output,
                std::vector<std::string> arguments, rlim_t files = 0)
      : socket_(socket), output_(output) {
    arguments.insert(arguments.begin(), {GAITD_PROGRAM, "--socket", socket});
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ != 0) return;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (files != 0) {
      const rlimit limit{files, files};
      setrlimit(RLIMIT_NOFILE, &limit);
    }
    const int out = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    dup2(out, STDOUT_FILENO);
    dup2(out, STDERR_FILENO);
    close(out);
    execv(argv[0], argv.data());
    _exit(127);
  }
  ~DaemonProcess() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
  }
  DaemonProcess(const DaemonProcess&) = delete;
  DaemonProcess& operator=(const DaemonProcess&) = delete;

  // The result of `status`, null if there is none.
  nlohmann::json status() const {
    daemon::RawClient client(socket_);
    if (!client.connected()) return nullptr;
    const auto answer = client.ask(R"({"jsonrpc":"2.0","id":1,"method":"status"})");
    return answer.is_object() ? answer.value("result", nlohmann::json()) : nullptr;
  }
  // Whether it comes to that state within 30 s.
  bool reaches(const std::string& state) const {
    for (int i = 0; i < 600; ++i) {
      const nlohmann::json s = status();
      if (s.is_object() && s["state"] == state) return true;  // null before the first tick
      siginfo_t ended{};
      waitid(P_PID, static_cast<id_t>(pid_), &ended, WEXITED | WNOHANG | WNOWAIT);
      if (ended.si_pid != 0) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return false;
  }
  // The exit code, after `signal` if that is not 0; -1 if it was killed.
  int end(int signal) {
    if (signal != 0) kill(pid_, signal);
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  // Open files, once their number has not changed for half a second.
  int descriptors() const {
    int last = -1;
    for (int same = 0; same < 10;) {
      const std::filesystem::directory_iterator files("/proc/" + std::to_string(pid_) + "/fd");
      const int now = static_cast<int>(std::distance(files, std::filesystem::directory_iterator()));
      same = now == last ? same + 1 : 0;
      last = now;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return last;
  }
  std::string output() const {
    std::ifstream in(output_);
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  std::string socket_;
  std::string output_;
  pid_t pid_ = 0;
};

}  // namespace gaitd::clients
