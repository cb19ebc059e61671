// SPDX-License-Identifier: Apache-2.0
#include "cli/tune/parameter_space.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "cli/campaign/settings.h"

namespace gaitd::cli {
namespace {

constexpr double kNeighbour = 0.15;

double scaled(const TunedParameter& parameter, double value) {
  return parameter.low > 0.0 ? std::log(value) : value;
}

double mirrored(double coordinate) {
  const double folded = std::fmod(std::abs(coordinate), 2.0);
  return folded <= 1.0 ? folded : 2.0 - folded;
}

}  // namespace

std::vector<double> ParameterSpace::usual() const {
  std::vector<double> point;
  for (const TunedParameter& parameter : parameters_) {
    const double low = scaled(parameter, parameter.low), high = scaled(parameter, parameter.high);
    point.push_back((scaled(parameter, parameter.usual) - low) / (high - low));
  }
  return point;
}

std::vector<std::string> ParameterSpace::values(const std::vector<double>& point) const {
  std::vector<std::string> values;
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    const TunedParameter& parameter = parameters_[i];
    const double low = scaled(parameter, parameter.low), high = scaled(parameter, parameter.high);
    const double value = low + (high - low) * mirrored(point[i]);
    values.push_back(setting_number(
        std::clamp(parameter.low > 0.0 ? std::exp(value) : value, parameter.low, parameter.high)));
  }
  return values;
}

std::vector<Neighbour> neighbours(const std::vector<TunedParameter>& parameters,
                                  const std::vector<std::string>& values) {
  std::vector<Neighbour> out;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    for (const double factor : {1.0 - kNeighbour, 1.0 + kNeighbour}) {
      const double value = std::clamp(factor * std::atof(values[i].c_str()), parameters[i].least,
                                      parameters[i].most);
      Neighbour neighbour{parameters[i].key + (factor < 1.0 ? " -15 %" : " +15 %"), values};
      neighbour.values[i] = setting_number(value);
      if (neighbour.values[i] != values[i]) out.push_back(std::move(neighbour));
    }
  }
  return out;
}

}  // namespace gaitd::cli
