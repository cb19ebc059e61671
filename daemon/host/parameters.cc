// SPDX-License-Identifier: Apache-2.0
#include "daemon/host/parameters.h"

#include <cmath>
#include <sstream>

namespace gaitd::daemon {

std::vector<double> default_parameters(const GaitdPluginDescriptor& descriptor) {
  std::vector<double> values(descriptor.parameter_count);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = descriptor.parameters[i].default_value;
  }
  return values;
}

std::string check_parameter(const GaitdParameter& parameter, double value) {
  const bool in_range =
      std::isfinite(value) && value >= parameter.minimum && value <= parameter.maximum;
  const bool whole = parameter.type == GAITD_PARAMETER_REAL || value == std::floor(value);
  if (in_range && whole) return "";
  std::ostringstream out;
  out << "got " << value << ", expected "
      << (parameter.type == GAITD_PARAMETER_REAL ? "a number" : "a whole number") << " from "
      << parameter.minimum << " to " << parameter.maximum;
  if (parameter.unit[0] != 0) out << ' ' << parameter.unit;
  return out.str();
}

}  // namespace gaitd::daemon
