// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace gaitd::cli {

/// Where the tasks of a job are.
struct SlurmQueue {
  int waiting = 0, running = 0;

  bool over() const { return waiting + running == 0; }
};

/// The commands of Slurm, as a user has them.
class Slurm {
 public:
  /// What they print goes through files in `folder`.
  explicit Slurm(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// The first of its commands that is not on PATH; empty if all are.
  static std::string missing();

  /// The number of the job. Nothing with what sbatch said in `error`.
  std::optional<std::string> submit(const std::vector<std::string>& arguments, std::string* error);
  /// Nothing with what squeue said in `error`: the controller may not be there for now.
  std::optional<SlurmQueue> queue(const std::string& job, std::string* error);

 private:
  std::optional<std::string> call(std::vector<std::string> arguments, std::string* error);

  std::filesystem::path folder_;
};

}  // namespace gaitd::cli
