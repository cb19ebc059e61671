// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "gaitd/abi/types.h"

namespace gaitd::daemon {

// The library of a test plugin, by the name of its build.
inline std::filesystem::path plugin_path(const std::string& name) {
  return std::filesystem::path(GAITD_TEST_PLUGINS) / "toe_off" / (name + ".so");
}

inline std::vector<char> contents(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void write_file(const std::filesystem::path& path, const std::vector<char>& bytes) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

inline std::unique_ptr<GaitdModel> some_model() {
  auto model = std::make_unique<GaitdModel>();
  model->size = sizeof(GaitdModel);
  std::string("some robot").copy(model->name, sizeof(model->name) - 1);
  return model;
}

// A directory that goes away with the test.
class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string name = (std::filesystem::temp_directory_path() / "gaitd-test-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~TemporaryDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace gaitd::daemon
