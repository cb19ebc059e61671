// SPDX-License-Identifier: Apache-2.0
// The process that holds the connection to the robot, as gaitd sees it.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "exchange.h"

namespace gaitd::unitree {

// It is a process and not a thread, so that it outlives gaitd, however that ends, and damps the
// robot. Should it die itself, another one is started at once that does nothing but damp.
class LinkProcess {
 public:
  using Log = std::function<void(int level, const std::string& line)>;

  // `program`: the executable; `arguments`: of its command line, see link/main.cc.
  LinkProcess(std::string program, std::vector<std::string> arguments, Log log);
  ~LinkProcess();
  LinkProcess(const LinkProcess&) = delete;
  LinkProcess& operator=(const LinkProcess&) = delete;

  // Starts it and waits until it has the robot, or says why not. False: everything that is wrong
  // is in `errors`.
  bool start(std::vector<std::string>* errors);
  // Asks it to damp and to end, and waits until it does the first, 0.3 s at most.
  void stop();
  // It is gone, and so is nobody's last command.
  bool gone() const { return gone_.load(std::memory_order_relaxed); }
  pid_t pid() const { return pid_.load(); }

  Exchange& exchange() { return *exchange_; }
  const Exchange& exchange() const { return *exchange_; }

 private:
  bool spawn(bool rescue, std::string* error);
  void listen();
  bool hear();  // false: it is gone
  void say(Talk what) const;

  std::string program_;
  std::vector<std::string> arguments_;
  Log log_;
  Exchange* exchange_ = nullptr;
  int memory_ = -1;
  std::atomic<int> talk_{-1};
  std::atomic<pid_t> pid_{-1};
  std::atomic<bool> gone_{false};
  std::thread listener_;
  std::mutex mutex_;
  std::condition_variable heard_;
  bool ready_ = false, bye_ = false, ended_ = false, stopping_ = false, starting_ = true;
  std::vector<std::string> errors_;
};

// Where it is installed with the running gaitd; an empty text if it is not there. The plugin cannot
// say: it is mapped from a copy without a place.
std::string find_link_program();

}  // namespace gaitd::unitree
