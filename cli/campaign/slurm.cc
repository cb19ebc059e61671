// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/slurm.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <utility>

#include "cli/child.h"
#include "cli/one_line.h"
#include "cli/whole_file.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

// As execvp() finds it; empty if it does not.
std::string on_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path file = fs::path(folder) / program;
    if (access(file.c_str(), X_OK) == 0) return file.string();
  }
  return "";
}

}  // namespace

std::string Slurm::missing() {
  for (const char* program : {"sbatch", "squeue"}) {
    if (on_path(program).empty()) return program;
  }
  return "";
}

std::optional<std::string> Slurm::call(std::vector<std::string> arguments, std::string* error) {
  const std::string program = arguments.front();
  arguments.front() = on_path(program);
  const std::string out = (folder_ / (program + ".out")).string();
  const std::string err = (folder_ / (program + ".err")).string();
  const pid_t pid = start_child(std::move(arguments), out, err);
  if (pid < 0) {
    *error = "cannot start " + program + ": " + std::strerror(errno);
    return std::nullopt;
  }
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return read_file(out);
  *error = program + ": " + one_line(read_file(err));
  return std::nullopt;
}

std::optional<std::string> Slurm::submit(const std::vector<std::string>& arguments,
                                         std::string* error) {
  std::vector<std::string> all{"sbatch", "--parsable"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  const auto said = call(all, error);
  if (!said) return std::nullopt;
  // The number, and behind a semicolon the name of the cluster.
  std::string job = one_line(*said);
  job.resize(std::min(job.size(), job.find(';')));
  if (!job.empty() && job.find_first_not_of("0123456789") == std::string::npos) return job;
  *error = "sbatch gave no number of a job: " + one_line(*said);
  return std::nullopt;
}

std::optional<SlurmQueue> Slurm::queue(const std::string& job, std::string* error) {
  const auto said =
      call({"squeue", "--noheader", "--array", "--jobs=" + job, "--format=%T"}, error);
  SlurmQueue queue;
  if (!said) {
    // A few minutes after its end the controller no longer knows a job.
    if (error->find("Invalid job id") == std::string::npos) return std::nullopt;
    error->clear();
    return queue;
  }
  std::istringstream lines(*said);
  for (std::string state; std::getline(lines, state);) {
    ++(state == "PENDING" ? queue.waiting : queue.running);
  }
  return queue;
}

}  // namespace gaitd::cli
