// SPDX-License-Identifier: Apache-2.0
#include "link_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <utility>

extern char** environ;

namespace gaitd::unitree {
namespace {

using namespace std::chrono_literals;

constexpr auto kReadyTime = 60s;
constexpr auto kStopTime = 300ms;
constexpr int kFirstOwnFd = 10;  // above those that the link finds open

int moved_up(int descriptor) {
  if (descriptor < 0) return descriptor;
  const int higher = fcntl(descriptor, F_DUPFD_CLOEXEC, kFirstOwnFd);
  close(descriptor);
  return higher;
}

}  // namespace

LinkProcess::LinkProcess(std::string program, std::vector<std::string> arguments, Log log)
    : program_(std::move(program)), arguments_(std::move(arguments)), log_(std::move(log)) {}

LinkProcess::~LinkProcess() {
  stop();
  if (talk_ >= 0) ::shutdown(talk_, SHUT_RDWR);
  if (listener_.joinable()) listener_.join();
  if (talk_ >= 0) close(talk_);
  if (pid_ > 0) waitpid(pid_, nullptr, WNOHANG);
  if (exchange_ != nullptr) munmap(exchange_, sizeof(Exchange));
  if (memory_ >= 0) close(memory_);
}

bool LinkProcess::spawn(bool rescue, std::string* error) {
  int pair[2];
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, pair) != 0) {
    *error = "no sockets for the link: " + std::string(std::strerror(errno));
    return false;
  }
  const int own = moved_up(pair[0]);
  const int theirs = moved_up(pair[1]);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, memory_, kExchangeFd);
  posix_spawn_file_actions_adddup2(&actions, theirs, kTalkFd);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  // A group of its own: Ctrl-C in a terminal is meant for gaitd.
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  std::vector<std::string> words = {program_};
  words.insert(words.end(), arguments_.begin(), arguments_.end());
  if (rescue) words.emplace_back("rescue");
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t pid = -1;
  const int result =
      posix_spawn(&pid, program_.c_str(), &actions, &attributes, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  close(theirs);
  if (result != 0) {
    close(own);
    *error = program_ + ": does not start: " + std::strerror(result);
    return false;
  }
  const std::lock_guard lock(mutex_);
  if (talk_ >= 0) close(talk_);
  talk_ = own;
  pid_ = pid;
  return true;
}

bool LinkProcess::start(std::vector<std::string>* errors) {
  memory_ = moved_up(memfd_create("gaitd-unitree", MFD_CLOEXEC));
  void* memory = MAP_FAILED;
  if (memory_ >= 0 && ftruncate(memory_, sizeof(Exchange)) == 0) {
    memory = mmap(nullptr, sizeof(Exchange), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE,
                  memory_, 0);
  }
  if (memory == MAP_FAILED) {
    errors->push_back("no shared memory for the link: " + std::string(std::strerror(errno)));
    return false;
  }
  exchange_ = static_cast<Exchange*>(memory);
  std::string error;
  if (!spawn(false, &error)) {
    errors->push_back(error);
    return false;
  }
  listener_ = std::thread([this] { listen(); });
  std::unique_lock lock(mutex_);
  const bool said = heard_.wait_for(lock, kReadyTime, [this] { return ready_ || ended_; });
  starting_ = false;
  if (ready_) return true;
  *errors = errors_;
  if (!said) errors->push_back("the link to the robot does not get ready");
  if (errors->empty()) errors->push_back("the link to the robot ended without a word");
  return false;
}

void LinkProcess::say(Talk what) const {
  const char letter = static_cast<char>(what);
  send(talk_, &letter, 1, MSG_DONTWAIT | MSG_NOSIGNAL);
}

void LinkProcess::stop() {
  std::unique_lock lock(mutex_);
  if (stopping_ || !listener_.joinable()) return;
  stopping_ = true;
  say(Talk::kStop);
  if (!heard_.wait_for(lock, kStopTime, [this] { return bye_ || ended_; })) {
    lock.unlock();
    log_(GAITD_LOG_ERROR,
         "the link to the robot does not answer: it damps by itself when gaitd is gone");
  }
}

bool LinkProcess::hear() {
  char buffer[1024];
  const ssize_t size = recv(talk_, buffer, sizeof(buffer) - 1, 0);
  if (size <= 0) return false;
  const std::string text(buffer, static_cast<size_t>(size));
  if (text[0] == static_cast<char>(Talk::kLog) && size > 2) {
    const int level = text[1] - '0';
    const std::string line = text.substr(2);
    const std::lock_guard lock(mutex_);
    // Those that keep it from starting are told by start(), all together.
    if (starting_ && level >= GAITD_LOG_ERROR) {
      errors_.push_back(line);
    } else {
      log_(level, line);
    }
    return true;
  }
  {
    const std::lock_guard lock(mutex_);
    ready_ = ready_ || text[0] == static_cast<char>(Talk::kReady);
    bye_ = bye_ || text[0] == static_cast<char>(Talk::kBye);
  }
  heard_.notify_all();
  return true;
}

void LinkProcess::listen() {
  for (;;) {
    while (hear()) {
    }
    gone_ = true;
    bool expected = false;
    {
      const std::lock_guard lock(mutex_);
      expected = stopping_ || !ready_;
      ended_ = true;
    }
    heard_.notify_all();
    waitpid(pid_, nullptr, WNOHANG);
    if (expected) return;
    log_(GAITD_LOG_ERROR, "the link to the robot died: another one is started, to damp it");
    std::string error;
    if (!spawn(true, &error)) {
      log_(GAITD_LOG_ERROR, error);
      return;
    }
  }
}

std::string find_link_program() {
  std::error_code problem;
  const auto daemon = std::filesystem::canonical("/proc/self/exe", problem);
  const auto program = daemon.parent_path().parent_path() / "lib" / "gaitd" / "gaitd-unitree-link";
  return std::filesystem::exists(program, problem) ? program.string() : "";
}

}  // namespace gaitd::unitree
