// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace gaitd::cli {

using Point = std::vector<double>;

/// What makes the next generation of CMA-ES. Coordinates are 0..1 from end to end of their ranges.
struct CmaEs {
  std::uint64_t seed = 1;
  Point start;
  int population = 8;
  std::vector<std::vector<double>> fitness;  ///< of the generations so far; less is better
};

/// The program that draws them; it comes with the package gaitd-tune.
std::filesystem::path cma_es_program();

/// The candidates of the next generation, also beyond 0..1. Files of the call go to `folder`.
/// Nothing with a reason in `error`.
std::optional<std::vector<Point>> next_generation(const CmaEs& state,
                                                  const std::filesystem::path& folder,
                                                  std::string* error);

/// Where the next generation is drawn around: the mean of the better half, weighted as in CMA-ES.
Point recombined(const std::vector<Point>& candidates, const std::vector<double>& fitness);

}  // namespace gaitd::cli
