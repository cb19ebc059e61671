// SPDX-License-Identifier: Apache-2.0
#include "daemon/verdict/expectations.h"

#include <array>

namespace gaitd::daemon {

namespace {

constexpr std::array<const char*, 6> kStatistics = {"rms", "mean", "min", "max", "p99", "range"};
constexpr std::array<const char*, 5> kPhases = {"always", "stand", "transfer", "swing", "walk"};

template <class Enum, std::size_t Size>
std::optional<Enum> parse(const std::array<const char*, Size>& words, const std::string& word) {
  for (std::size_t i = 0; i < Size; ++i) {
    if (word == words[i]) return static_cast<Enum>(i);
  }
  return std::nullopt;
}

}  // namespace

std::optional<Statistic> parse_statistic(const std::string& word) {
  return parse<Statistic>(kStatistics, word);
}

std::optional<During> parse_during(const std::string& word) { return parse<During>(kPhases, word); }

const char* statistic_name(Statistic statistic) {
  return kStatistics[static_cast<std::size_t>(statistic)];
}

const char* during_name(During during) { return kPhases[static_cast<std::size_t>(during)]; }

}  // namespace gaitd::daemon
