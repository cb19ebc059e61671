// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "cli/campaign/results.h"

namespace gaitd::cli {

/// Counts the rows that a shard has written. Of a file that only grew the new part is read: many
/// shards on a shared disk are looked at again and again.
class ShardProgress {
 public:
  ShardProgress(const ResultFormat& format, std::filesystem::path file)
      : format_(&format), file_(std::move(file)) {}

  void look();

  int done() const { return done_; }
  int failed() const { return failed_; }

 private:
  const ResultFormat* format_;
  std::filesystem::path file_;
  std::uintmax_t read_ = 0;  // bytes
  int done_ = 0, failed_ = 0;
};

}  // namespace gaitd::cli
