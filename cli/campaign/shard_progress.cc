// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/shard_progress.h"

#include <fstream>
#include <string>
#include <system_error>

namespace gaitd::cli {

void ShardProgress::look() {
  std::error_code missing;
  const std::uintmax_t size = std::filesystem::file_size(file_, missing);
  if (missing || size == read_) return;
  if (size < read_) read_ = 0;  // written anew
  if (read_ == 0) done_ = failed_ = 0;
  std::ifstream in(file_, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(read_));
  for (std::string line; std::getline(in, line) && !in.eof();) {
    read_ += line.size() + 1;
    const auto result = format_->parse(line);  // not of the header
    if (!result) continue;
    ++done_;
    failed_ += result->success ? 0 : 1;
  }
}

}  // namespace gaitd::cli
