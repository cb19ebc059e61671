// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/campaign/campaign.h"

namespace gaitd::cli {

/// Between the coordinates of the optimiser, 0..1 over the range of each parameter, and the values
/// that are played. Positive ranges are logarithmic. What is beyond 0..1 is mirrored back.
class ParameterSpace {
 public:
  explicit ParameterSpace(const std::vector<TunedParameter>& parameters)
      : parameters_(parameters) {}

  std::vector<double> usual() const;
  /// Values as --set takes them, in the order of the parameters.
  std::vector<std::string> values(const std::vector<double>& point) const;

 private:
  const std::vector<TunedParameter>& parameters_;
};

/// Each of the values once 15 % smaller and once 15 % larger, within what its declaration allows,
/// the others as they are. Where that changes nothing it is left out.
struct Neighbour {
  std::string name;  ///< "gait.swing_height -15 %"
  std::vector<std::string> values;
};
std::vector<Neighbour> neighbours(const std::vector<TunedParameter>& parameters,
                                  const std::vector<std::string>& values);

}  // namespace gaitd::cli
