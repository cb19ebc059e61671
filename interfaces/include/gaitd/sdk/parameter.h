// SPDX-License-Identifier: Apache-2.0
// Parameters are declared once, in a constexpr table; validation, help and reference come from it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "gaitd/abi/plugin.h"

namespace gaitd::sdk {

namespace internal {
template <std::size_t N>
constexpr void copy(char (&to)[N], std::string_view from) {
  // A text that does not fit must not be cut silently: this is evaluated at compile time only.
  if (from.size() >= N) throw "text too long for its field";
  for (std::size_t i = 0; i < N; ++i) to[i] = i < from.size() ? from[i] : '\0';
}
}  // namespace internal

constexpr GaitdParameter real_parameter(std::string_view name, std::string_view unit,
                                        double minimum, double maximum, double default_value,
                                        std::string_view description) {
  GaitdParameter p{};
  internal::copy(p.name, name);
  internal::copy(p.unit, unit);
  internal::copy(p.description, description);
  p.type = GAITD_PARAMETER_REAL;
  p.minimum = minimum;
  p.maximum = maximum;
  p.default_value = default_value;
  return p;
}
constexpr GaitdParameter integer_parameter(std::string_view name, std::string_view unit,
                                           int minimum, int maximum, int default_value,
                                           std::string_view description) {
  GaitdParameter p = real_parameter(name, unit, minimum, maximum, default_value, description);
  p.type = GAITD_PARAMETER_INTEGER;
  return p;
}
constexpr GaitdParameter boolean_parameter(std::string_view name, bool default_value,
                                           std::string_view description) {
  GaitdParameter p = real_parameter(name, "", 0, 1, default_value ? 1 : 0, description);
  p.type = GAITD_PARAMETER_BOOLEAN;
  return p;
}

// Parameters are for tuning unless they are said to be for whoever ports gaitd, or knows its code.
constexpr GaitdParameter porting(GaitdParameter parameter) {
  parameter.rank = GAITD_RANK_PORTING;
  return parameter;
}
constexpr GaitdParameter expert(GaitdParameter parameter) {
  parameter.rank = GAITD_RANK_EXPERT;
  return parameter;
}

// Whether the declaration allows the value: in its range, and whole unless it is a real number.
constexpr bool allowed(const GaitdParameter& parameter, double value) {
  if (!(value >= parameter.minimum && value <= parameter.maximum)) return false;  // NaN as well
  return parameter.type == GAITD_PARAMETER_REAL ||
         value == static_cast<double>(static_cast<std::int64_t>(value));
}

// Values of one table, in the order of the table. `Enum` numbers the rows and ends with kCount.
template <class Enum>
class Parameters {
 public:
  static constexpr int kSize = static_cast<int>(Enum::kCount);
  explicit Parameters(const std::array<GaitdParameter, kSize>& table) {
    for (int i = 0; i < kSize; ++i) values_[i] = table[i].default_value;
  }
  double operator[](Enum e) const { return values_[static_cast<int>(e)]; }
  bool flag(Enum e) const { return values_[static_cast<int>(e)] != 0.0; }
  void set(int index, double value) { values_[index] = value; }
  void set(const double* values, int count) {
    for (int i = 0; i < count && i < kSize; ++i) values_[i] = values[i];
  }

 private:
  std::array<double, kSize> values_;
};

}  // namespace gaitd::sdk
