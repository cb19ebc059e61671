// SPDX-License-Identifier: Apache-2.0
// gaitd-cma-es: one generation of CMA-ES (Hansen, The CMA evolution strategy: a comparing review,
// 2006), by pagmo. The only argument is JSON: {"seed", "start": [...], "spread", "population",
// "fitness": [[...], ...]}, the fitness of each candidate of the generations so far, less is
// better; {"candidates": [[...], ...]} of the next one goes to standard output. It remembers
// nothing: the same argument gives the same candidates.
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <utility>
#include <vector>

namespace {

using nlohmann::json;
using pagmo::vector_double;

struct Played {
  std::vector<double> fitness;            // of the generations that are known
  std::vector<vector_double> candidates;  // as they are asked for
};

// What is not known yet is 0: its candidates were drawn before.
struct Problem {
  std::shared_ptr<Played> played = std::make_shared<Played>();
  std::size_t dimension = 1;

  vector_double fitness(const vector_double& candidate) const {
    played->candidates.push_back(candidate);
    const std::size_t i = played->candidates.size() - 1;
    return {i < played->fitness.size() ? played->fitness[i] : 0.0};
  }
  std::pair<vector_double, vector_double> get_bounds() const {
    return {vector_double(dimension, 0.0), vector_double(dimension, 1.0)};
  }
};

json next_generation(const json& asked) {
  const vector_double start = asked.at("start");
  const std::size_t population = asked.at("population");
  Problem problem;
  problem.dimension = start.size();
  const std::shared_ptr<Played> played = problem.played;
  for (const json& generation : asked.at("fitness")) {
    for (const json& fitness : generation) played->fitness.push_back(fitness);
  }
  const unsigned seed = asked.at("seed");
  pagmo::population first(pagmo::problem(problem), 0u, seed);
  for (std::size_t i = 0; i < population; ++i) first.push_back(start, {0.0});
  const auto generations = static_cast<unsigned>(asked.at("fitness").size() + 1);
  // It ends after the generations alone, and draws beyond the bounds: who plays a candidate mirrors
  // it there.
  const pagmo::cmaes strategy(generations, -1, -1, -1, -1, asked.at("spread"), 0.0, 0.0, false,
                              false, seed);
  strategy.evolve(first);
  json candidates = json::array();
  for (std::size_t i = played->candidates.size() - population; i < played->candidates.size(); ++i) {
    candidates.push_back(played->candidates[i]);
  }
  return {{"candidates", candidates}};
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 2)
      throw std::invalid_argument(
          "expected one argument, JSON; gaitctl campaign tune calls this program");
    std::cout << next_generation(json::parse(argv[1])).dump() << "\n";
    return 0;
  } catch (const std::exception& e) {
    std::cerr << "gaitd-cma-es: " << e.what() << "\n";
    return 1;
  }
}
