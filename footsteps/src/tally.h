// SPDX-License-Identifier: Apache-2.0
// What a search found in its way.
#ifndef GAITD_FOOTSTEPS_TALLY_H_
#define GAITD_FOOTSTEPS_TALLY_H_

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "footholds.h"
#include "step_maker.h"

namespace gaitd::footsteps {

struct Tally {
  std::array<int, 5> footholds{};  // by FootholdState
  std::array<int, 4> steps{};      // by StepState

  void count(FootholdState state) { ++footholds[static_cast<std::size_t>(state)]; }
  void count(StepState state) { ++steps[static_cast<std::size_t>(state)]; }

  // The three largest, in words; empty: nothing was in the way.
  std::string text() const {
    const auto of = [this](FootholdState state) {
      return footholds[static_cast<std::size_t>(state)];
    };
    const auto step = [this](StepState state) { return steps[static_cast<std::size_t>(state)]; };
    std::array<std::pair<int, const char*>, 7> reasons = {{
        {of(FootholdState::kRough), "places not flat enough for a sole"},
        {of(FootholdState::kSteep), "places too steep"},
        {of(FootholdState::kBlocked), "places beside a riser"},
        {of(FootholdState::kUnknown), "places not known"},
        {step(StepState::kReach), "steps out of reach"},
        {step(StepState::kSwing), "steps over too high ground"},
        {step(StepState::kBody), "steps too near to high ground"},
    }};
    std::stable_sort(reasons.begin(), reasons.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::string text;
    for (int i = 0; i < 3 && reasons[i].first > 0; ++i) {
      text +=
          (text.empty() ? "" : ", ") + std::to_string(reasons[i].first) + " " + reasons[i].second;
    }
    return text;
  }
};

}  // namespace gaitd::footsteps

#endif  // GAITD_FOOTSTEPS_TALLY_H_
