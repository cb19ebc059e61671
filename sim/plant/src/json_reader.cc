// SPDX-License-Identifier: Apache-2.0
#include "json_reader.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace gaitd::sim {
namespace {

using nlohmann::json;

std::string text(double value) { return json(value).dump(); }

std::string describe(const Range& range) {
  std::string result;
  if (std::isfinite(range.minimum)) {
    result += (range.open_minimum ? " > " : " >= ") + text(range.minimum);
  }
  if (std::isfinite(range.maximum)) {
    result += (result.empty() ? " <= " : " and <= ") + text(range.maximum);
  }
  return result;
}

bool fits(const json& value, const Range& range) {
  if (!value.is_number()) return false;
  const double v = value.get<double>();
  return std::isfinite(v) && v <= range.maximum &&
         (range.open_minimum ? v > range.minimum : v >= range.minimum);
}

}  // namespace

JsonReader::JsonReader(const json& value, std::string path, std::vector<std::string>* errors)
    : object_(&value), path_(std::move(path)), errors_(errors) {
  static const json kEmpty = json::object();
  if (value.is_object()) return;
  error(path_.empty() ? "configuration" : path_, "an object", value);
  object_ = &kEmpty;
}

std::string JsonReader::path(const std::string& key) const {
  return path_.empty() ? key : path_ + "." + key;
}

void JsonReader::allow(const std::vector<const char*>& keys) {
  std::string known;
  for (const char* key : keys) known += (known.empty() ? "" : ", ") + std::string(key);
  for (const auto& [key, value] : object_->items()) {
    const bool found = std::any_of(keys.begin(), keys.end(), [&name = key](const char* candidate) {
      return name == candidate;
    });
    if (!found)
      errors_->push_back(path(key) + ": expected one of the keys " + known +
                         ", got unknown key \"" + key + "\"");
  }
}

bool JsonReader::has(const char* key) const { return object_->contains(key); }

void JsonReader::number(const char* key, const Range& range, double* value) {
  if (!has(key)) return;
  if (fits(at(key), range)) {
    *value = at(key).get<double>();
  } else {
    error(path(key), "a number" + describe(range), at(key));
  }
}

void JsonReader::number(const char* key, const Range& range, std::optional<double>* value) {
  if (!has(key)) return;
  double read = 0;
  number(key, range, &read);
  *value = read;
}

bool JsonReader::numbers(const char* key, const Range& range, std::span<double> values) {
  if (!has(key)) return false;
  const json& array = at(key);
  if (!array.is_array() || array.size() != values.size() ||
      !std::all_of(array.begin(), array.end(), [&](const json& v) { return fits(v, range); })) {
    const char* count = values.size() == 2 ? "two" : "three";
    error(path(key), std::string(count) + " numbers" + describe(range), array);
    return false;
  }
  for (size_t k = 0; k < values.size(); ++k) values[k] = array[k].get<double>();
  return true;
}

void JsonReader::vector(const char* key, const Range& range, Eigen::Vector3d* value) {
  numbers(key, range, {value->data(), 3});
}

void JsonReader::error(const std::string& path, const std::string& expected, const json& got) {
  std::string shown = got.dump(-1, ' ', true, json::error_handler_t::replace);
  constexpr size_t kLongest = 80;
  if (shown.size() > kLongest) shown = shown.substr(0, kLongest) + "...";
  errors_->push_back(path + ": expected " + expected + ", got " + shown);
}

}  // namespace gaitd::sim
