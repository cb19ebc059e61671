// SPDX-License-Identifier: Apache-2.0
#include "daemon/server/request_worker.h"

#include <pthread.h>

#include <utility>

namespace gaitd::daemon {

RequestWorker::RequestWorker(Methods methods, const RpcLimits& limits, CommandBridge* bridge,
                             EstopFlag* flag, std::function<void(std::uint64_t)> room)
    : methods_(std::move(methods)),
      limits_(limits),
      bridge_(bridge),
      estops_(flag),
      room_(std::move(room)) {
  // For those that come within a batch, or in a line too long for the lane of their own.
  methods_.add_async("estop", [this](const nlohmann::json&, const Caller& caller, Respond respond) {
    estops_.stop(std::move(respond), caller.estop);
  });
}

RequestWorker::~RequestWorker() { stop(); }

void RequestWorker::start() {
  thread_ = std::thread([this] { run(); });
  pthread_setname_np(thread_.native_handle(), "gaitd-requests");
}

void RequestWorker::stop() {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
  const std::scoped_lock lock(mutex_);
  queue_.clear();
}

bool RequestWorker::has_room(std::uint64_t client, std::size_t bytes) {
  const std::scoped_lock lock(mutex_);
  const auto waiting = bytes_.find(client);
  const bool room = queue_.has_room(client) &&
                    (waiting == bytes_.end() || waiting->second + bytes <= kShareBytes);
  if (!room) full_.insert(client);
  return room;
}

void RequestWorker::push(const Caller& caller, std::string_view line, Exchange::Send send) {
  const std::scoped_lock lock(mutex_);
  if (stopping_) return;  // nobody will answer any more
  queue_.push(caller.connection, {caller, std::string(line), std::move(send), {}});
  bytes_[caller.connection] += line.size();
  wake_.notify_one();
}

void RequestWorker::retire(std::uint64_t client) {
  const std::scoped_lock lock(mutex_);
  queue_.retire(client);
  full_.erase(client);
}

// False: nothing to do just now.
bool RequestWorker::next(std::pair<std::uint64_t, Job>* job, bool waiting) {
  std::unique_lock lock(mutex_);
  const auto ready = [this] { return stopping_ || !queue_.empty(); };
  if (waiting) {
    wake_.wait_for(lock, std::chrono::milliseconds(1), ready);
  } else {
    wake_.wait(lock, ready);
  }
  if (stopping_) return false;
  auto popped = queue_.pop();
  if (!popped) return false;
  *job = std::move(*popped);
  return true;
}

void RequestWorker::run() {
  for (;;) {
    std::pair<std::uint64_t, Job> job;
    if (next(&job, waiting())) work(job.first, std::move(job.second));
    {
      const std::scoped_lock lock(mutex_);
      if (stopping_) break;
    }
    try {
      poll();
    } catch (...) {
      // As in work().
    }
  }
  estops_.abandon();
  if (bridge_ != nullptr) bridge_->abandon();
}

// One request; the others of a batch wait for their turn.
void RequestWorker::work(std::uint64_t client, Job job) {
  try {
    if (!job.begun) job.begun.emplace(methods_, limits_, job.caller, job.line, job.send);
    if (job.begun->step()) {
      const std::scoped_lock lock(mutex_);
      queue_.push_front(client, std::move(job));
      return;
    }
  } catch (...) {
    // Out of memory for one line, say: that one is lost, the others go on.
  }
  bool was_full = false;
  {
    const std::scoped_lock lock(mutex_);
    const auto bytes = bytes_.find(client);
    if ((bytes->second -= job.line.size()) == 0) bytes_.erase(bytes);
    was_full = full_.erase(client) > 0;
  }
  if (was_full) room_(client);
}

void RequestWorker::poll() {
  const auto now = EstopAnswers::Clock::now();
  estops_.poll(now);
  if (bridge_ != nullptr) bridge_->poll(now);
}

}  // namespace gaitd::daemon
