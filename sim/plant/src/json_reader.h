// SPDX-License-Identifier: Apache-2.0
// Reads a JSON object key by key and collects everything that is wrong with it.
#ifndef GAITD_SIM_JSON_READER_H_
#define GAITD_SIM_JSON_READER_H_

#include <Eigen/Core>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gaitd::sim {

struct Range {
  double minimum;
  double maximum;
  bool open_minimum = false;  // minimum itself is refused
};

class JsonReader {
 public:
  // `path` is the key path of `value`, empty for the root. If `value` is no object, that is an
  // error and the reader behaves as if it were empty.
  JsonReader(const nlohmann::json& value, std::string path, std::vector<std::string>* errors);

  // Every key outside `keys` is an error.
  void allow(std::initializer_list<const char*> keys) { allow(std::vector<const char*>(keys)); }
  void allow(const std::vector<const char*>& keys);

  bool has(const char* key) const;
  const nlohmann::json& at(const char* key) const { return object_->at(key); }
  std::string path(const std::string& key) const;
  const nlohmann::json& object() const { return *object_; }

  // Each leaves `value` as it is when the key is absent.
  void number(const char* key, const Range& range, double* value);
  void number(const char* key, const Range& range, std::optional<double>* value);
  // True: `values` was there and is written.
  bool numbers(const char* key, const Range& range, std::span<double> values);
  void vector(const char* key, const Range& range, Eigen::Vector3d* value);

  void error(const std::string& path, const std::string& expected, const nlohmann::json& got);

 private:
  const nlohmann::json* object_;
  std::string path_;
  std::vector<std::string>* errors_;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_JSON_READER_H_
