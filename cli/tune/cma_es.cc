// SPDX-License-Identifier: Apache-2.0
#include "cli/tune/cma_es.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numeric>
#include <system_error>

#include "cli/child.h"
#include "cli/whole_file.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kSpread = 0.2;  // of the first generation, a standard deviation, of the ranges

}  // namespace

fs::path cma_es_program() {
  std::error_code ignored;
  return fs::read_symlink("/proc/self/exe", ignored).parent_path().parent_path() /
         "lib/gaitd/gaitd-cma-es";
}

std::optional<std::vector<Point>> next_generation(const CmaEs& state, const fs::path& folder,
                                                  std::string* error) {
  const json asked = {{"seed", state.seed},
                      {"start", state.start},
                      {"spread", kSpread},
                      {"population", state.population},
                      {"fitness", state.fitness}};
  const fs::path out = folder / "cma-es.json", err = folder / "cma-es.txt";
  const pid_t pid =
      start_child({cma_es_program().string(), asked.dump()}, out.string(), err.string());
  if (pid < 0) {
    *error = "cannot start " + cma_es_program().string() + ": " + std::strerror(errno) +
             "; install the package gaitd-tune, or build gaitd where libpagmo-dev is installed";
    return std::nullopt;
  }
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  const json answer = json::parse(read_file(out), nullptr, false);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || !answer.is_object()) {
    *error = cma_es_program().string() + " gave no candidates: " + read_file(err);
    return std::nullopt;
  }
  std::error_code ignored;
  fs::remove(out, ignored);
  fs::remove(err, ignored);
  return answer.at("candidates").get<std::vector<Point>>();
}

Point recombined(const std::vector<Point>& candidates, const std::vector<double>& fitness) {
  std::vector<std::size_t> order(candidates.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return fitness[a] < fitness[b]; });
  const std::size_t parents = std::max<std::size_t>(1, candidates.size() / 2);
  Point mean(candidates.front().size(), 0.0);
  double sum = 0.0;
  for (std::size_t i = 0; i < parents; ++i) {
    const double weight =
        std::log(static_cast<double>(parents) + 0.5) - std::log(static_cast<double>(i) + 1.0);
    sum += weight;
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += weight * candidates[order[i]][k];
  }
  for (double& coordinate : mean) coordinate /= sum;
  return mean;
}

}  // namespace gaitd::cli
