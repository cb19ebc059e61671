// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace gaitd::daemon {

/// Why a library is not loaded: all reasons at once, each with what was found, what is needed and
/// what to do about it.
struct Refusal {
  struct Reason {
    std::string what;    ///< the thing that does not fit, e.g. "abi_major"
    std::string has;     ///< as found in the file
    std::string needed;  ///< what this gaitd accepts
    std::string remedy;  ///< what the author or operator does
  };

  std::string file;
  std::vector<Reason> reasons;

  bool empty() const { return reasons.empty(); }
  void add(std::string what, std::string has, std::string needed, std::string remedy) {
    reasons.push_back({std::move(what), std::move(has), std::move(needed), std::move(remedy)});
  }
  /// One line for the file and one per reason.
  std::string text() const;
};

}  // namespace gaitd::daemon
