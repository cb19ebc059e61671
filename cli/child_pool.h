// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace gaitd::cli {

/// Children that each do one piece of numbered work, several at once. Those that are left are ended
/// with it.
class ChildPool {
 public:
  struct End {
    int number = 0;
    int status = 0;  ///< as waitpid() gives it
  };

  explicit ChildPool(int size) : size_(size) {}
  ~ChildPool();
  ChildPool(const ChildPool&) = delete;
  ChildPool& operator=(const ChildPool&) = delete;

  bool idle() const { return children_.empty(); }
  bool full() const { return static_cast<int>(children_.size()) >= size_; }

  /// Arguments and outputs are those of start_child().
  bool start(int number, const std::vector<std::string>& arguments, const std::string& output,
             const std::string& errors, std::string* error);
  /// A child that has ended, if there is one.
  std::optional<End> take();

 private:
  int size_ = 1;
  std::map<pid_t, int> children_;  // numbers of their work
};

enum class PoolEnd { kDone, kInterrupted, kFailed };

/// What a pool works on.
struct PoolWork {
  /// Starts one more piece or does it at once. False if there is none for now, or with an error.
  std::function<bool(std::string* error)> start;
  /// Takes up what a child has done. False with an error.
  std::function<bool(const ChildPool::End& end, std::string* error)> finish;
  /// Called after each piece and a few times a second.
  std::function<void()> progress;
};

/// Keeps the pool busy until nothing is left to do. SIGINT and SIGTERM end it; what was under way
/// is forgotten.
PoolEnd work_off(ChildPool* pool, const PoolWork& work, std::string* error);

}  // namespace gaitd::cli
