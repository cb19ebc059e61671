// SPDX-License-Identifier: Apache-2.0
// The estimate of a limit on success curves that are known, and against bisection.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "cli/campaign/limit.h"

namespace gaitd::cli {
namespace {

constexpr int kLevels = 51;
constexpr double kStop = 0.1;  // width of the interval, of the range

double place(int level) { return level / (kLevels - 1.0); }

// Shares of success that fall through a rate at a limit.
using Curve = std::function<double(double place)>;
Curve logistic(double limit, double width, double rate, double lapse = 0.0) {
  const double share = rate / (1.0 - lapse);
  return [=](double x) {
    return (1.0 - lapse) / (1.0 + (1.0 - share) / share * std::exp((x - limit) / width));
  };
}
Curve early(double limit, double width, double rate) {  // a long beginning
  return [=](double x) { return std::exp(std::log(rate) * std::exp((x - limit) / width)); };
}
Curve late(double limit, double width, double rate) {  // a long end
  return [=](double x) {
    return 1.0 - std::exp(std::log(1.0 - rate) * std::exp((limit - x) / width));
  };
}
Curve step(double limit) {
  return [=](double x) { return x < limit ? 1.0 : 0.0; };
}

class Chance {
 public:
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(draws_() >> 11) * 0x1p-53;
  }

 private:
  std::mt19937_64 draws_{20};
};

struct Found {
  double low = 0.0, limit = 0.0, high = 0.0;
  int runs = 0;
};

// As a campaign searches.
Found search(const LimitModel& model, const Curve& curve, int most, Chance* chance) {
  std::vector<Trial> trials;
  for (;;) {
    const LimitPosterior posterior = model.posterior(trials);
    const Found found{posterior.quantile(0.025), posterior.quantile(0.5), posterior.quantile(0.975),
                      static_cast<int>(trials.size())};
    const double width = std::clamp(found.high, 0.0, 1.0) - std::clamp(found.low, 0.0, 1.0);
    if (found.runs >= most || (found.runs > 0 && width <= kStop)) return found;
    for (const int level : model.next_levels(posterior, 4)) {
      trials.push_back({level, chance->between(0.0, 1.0) < curve(place(level))});
    }
  }
}

// Each seed has a limit of its own, bisected to a step; of these the quantile that is asked for.
double bisected(const Curve& curve, double rate, int runs, Chance* chance) {
  const int seeds = std::max(1, runs / 6);  // a bisection of 51 levels takes six
  std::vector<double> limits;
  for (int seed = 0; seed < seeds; ++seed) {
    const double luck = chance->between(0.0, 1.0);
    int held = -1, failed = kLevels;
    while (failed - held > 1) {
      const int middle = (held + failed) / 2;
      (luck < curve(place(middle)) ? held : failed) = middle;
    }
    limits.push_back((held + 0.5) / (kLevels - 1.0));
  }
  std::sort(limits.begin(), limits.end());
  const double at = (1.0 - rate) * (seeds - 1);
  const auto below = static_cast<std::size_t>(at), above = std::min(below + 1, limits.size() - 1);
  return limits[below] + (at - static_cast<double>(below)) * (limits[above] - limits[below]);
}

struct Score {
  int searches = 0, held = 0;
  double squares = 0.0, squares_bisected = 0.0;

  double coverage() const { return static_cast<double>(held) / searches; }
};

Score score_of(double rate, int count) {
  const LimitModel model(kLevels, rate);
  Chance chance;
  Score score;
  for (int i = 0; i < count; ++i) {
    const double limit = chance.between(0.05, 0.95);
    const double width = 0.005 * std::pow(40.0, chance.between(0.0, 1.0));  // 0.005..0.2
    const Curve curves[] = {logistic(limit, width, rate), logistic(limit, width, rate, 0.03),
                            early(limit, width, rate), late(limit, width, rate)};
    const Curve& curve = curves[i % 4];
    const Found found = search(model, curve, 60, &chance);
    score.searches += 1;
    score.held += found.low <= limit && limit <= found.high ? 1 : 0;
    score.squares += std::pow(found.limit - limit, 2);
    score.squares_bisected += std::pow(bisected(curve, rate, found.runs, &chance) - limit, 2);
  }
  return score;
}

TEST(Limit, IsInItsIntervalAndNearerThanByBisectionWithAsManyRuns) {
  for (const double rate : {0.5, 0.9}) {
    const Score score = score_of(rate, 400);
    EXPECT_GE(score.coverage(), 0.93) << rate;
    EXPECT_LE(score.coverage(), 0.995) << "an interval too wide, " << rate;
    EXPECT_LT(std::sqrt(score.squares), 0.75 * std::sqrt(score.squares_bisected)) << rate;
    RecordProperty("coverage", std::to_string(score.coverage()));
    printf("rate %g: in the interval %.3f, error %.4f, by bisection %.4f\n", rate, score.coverage(),
           std::sqrt(score.squares / score.searches),
           std::sqrt(score.squares_bisected / score.searches));
  }
}

TEST(Limit, OfAStepIsFoundWithFewRuns) {
  const LimitModel model(kLevels, 0.5);
  Chance chance;
  for (int i = 0; i < 50; ++i) {
    const double limit = chance.between(0.05, 0.95);
    const Found found = search(model, step(limit), 60, &chance);
    EXPECT_LE(found.low, limit);
    EXPECT_GE(found.high, limit);
    EXPECT_LE(found.runs, 24);
  }
}

TEST(Limit, BeyondTheLevelsIsSaidToBeThere) {
  Chance chance;
  for (const double rate : {0.5, 0.9}) {
    const LimitModel model(kLevels, rate);
    const Found above = search(model, step(2.0), 40, &chance);
    EXPECT_GT(above.high, 1.0);
    EXPECT_GT(above.limit, 1.0);
    EXPECT_GT(above.low, 1.0 - kStop);
    EXPECT_LE(above.runs, 20);
    const Found below = search(model, step(-1.0), 40, &chance);
    EXPECT_LT(below.low, 0.0);
    EXPECT_LT(below.high, kStop);
  }
}

TEST(Limit, AsksFarApartAtFirstAndBesideTheLimitInTheEnd) {
  const LimitModel model(kLevels, 0.5);
  std::vector<int> levels = model.next_levels(model.posterior({}), 4);
  EXPECT_EQ(levels.front(), 0);
  EXPECT_EQ(levels.back(), kLevels - 1);
  std::vector<Trial> trials;
  for (int i = 0; i < 8; ++i) {
    for (const int level : levels) trials.push_back({level, level < 20});
    levels = model.next_levels(model.posterior(trials), 4);
  }
  for (const int level : levels) EXPECT_NEAR(level, 19.5, 2.0);
}

}  // namespace
}  // namespace gaitd::cli
