// SPDX-License-Identifier: Apache-2.0
// Every layer library of this build keeps the contract of gaitd/abi/plugin.h.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "gaitd/abi/plugin.h"
#include "walking/test/atlas.h"

namespace gaitd {
namespace {

constexpr const char* kLayers[] = {"state_estimator", "icp_planner",           "step_adjuster",
                                   "toe_off",         "whole_body_controller", "task_source"};

struct File {
  int layer;
  std::string variant;
  std::string path;
};

std::vector<File> plugin_files() {
  std::vector<File> files;
  for (int layer = 0; layer < GAITD_LAYER_COUNT; ++layer) {
    const std::filesystem::path folder = std::filesystem::path(GAITD_PLUGIN_DIR) / kLayers[layer];
    if (!std::filesystem::exists(folder)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() != ".so") continue;
      files.push_back({layer, entry.path().stem().string(), entry.path().string()});
    }
  }
  std::sort(files.begin(), files.end(),
            [](const File& a, const File& b) { return a.path < b.path; });
  return files;
}

std::string name_of(const ::testing::TestParamInfo<File>& info) {
  return std::string(kLayers[info.param.layer]) + "_" + info.param.variant;
}

class PluginFile : public ::testing::TestWithParam<File> {
 protected:
  void SetUp() override {
    library_ = dlopen(GetParam().path.c_str(), RTLD_NOW | RTLD_LOCAL);
    ASSERT_NE(library_, nullptr) << dlerror();
    descriptor_ = static_cast<const GaitdPluginDescriptor*>(dlsym(library_, GAITD_PLUGIN_SYMBOL));
    create_ = reinterpret_cast<GaitdCreateFunction>(dlsym(library_, GAITD_CREATE_SYMBOL));
    ASSERT_NE(descriptor_, nullptr);
    ASSERT_NE(create_, nullptr);
  }
  void TearDown() override {
    if (instance_.self != nullptr) instance_.vtable->destroy(instance_.self);
    if (library_ != nullptr) dlclose(library_);
  }
  void create() {
    host_.size = sizeof(host_);
    host_.abi_major = GAITD_ABI_MAJOR;
    ASSERT_EQ(create_(&host_, &instance_), GAITD_OK);
    ASSERT_NE(instance_.self, nullptr);
    ASSERT_NE(instance_.vtable, nullptr);
  }
  void init() {
    create();
    std::vector<double> defaults;
    for (std::uint32_t i = 0; i < descriptor_->parameter_count; ++i) {
      defaults.push_back(descriptor_->parameters[i].default_value);
    }
    ASSERT_EQ(instance_.vtable->init(instance_.self, &testing::atlas(), defaults.data(),
                                     descriptor_->parameter_count),
              GAITD_OK);
  }

  void* library_ = nullptr;
  const GaitdPluginDescriptor* descriptor_ = nullptr;
  GaitdCreateFunction create_ = nullptr;
  GaitdHost host_{};
  GaitdInstance instance_{};
};

template <int N>
bool terminated(const char (&text)[N]) {
  return std::memchr(text, '\0', N) != nullptr;
}

bool is_identifier(const std::string& name) {
  return !name.empty() &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
}

TEST_P(PluginFile, DescriptorSaysWhatItIs) {
  const GaitdPluginDescriptor& d = *descriptor_;
  EXPECT_EQ(d.magic, GAITD_PLUGIN_MAGIC);
  EXPECT_EQ(d.abi_major, std::uint32_t{GAITD_ABI_MAJOR});
  EXPECT_EQ(d.abi_minor, std::uint32_t{GAITD_ABI_MINOR});
  EXPECT_EQ(d.struct_size, sizeof(GaitdPluginDescriptor));
  EXPECT_EQ(d.layer, GetParam().layer);
  EXPECT_EQ(d.id, GetParam().variant);  // the file is named for the variant
  EXPECT_TRUE(is_identifier(d.id));
  EXPECT_TRUE(terminated(d.version) && terminated(d.build));
  int major = -1, minor = -1, patch = -1;
  EXPECT_EQ(std::sscanf(d.version, "%d.%d.%d", &major, &minor, &patch), 3) << d.version;
  EXPECT_NE(std::string(d.build), "");
  EXPECT_GT(d.worst_case_us, 0.0);
  EXPECT_LE(d.worst_case_us, 1000.0);
  EXPECT_EQ(d.capabilities, 0u);
  EXPECT_GE(d.layer_version, 1u);
}

TEST_P(PluginFile, ParametersAreUniqueAndSane) {
  std::set<std::string> names;
  ASSERT_LE(descriptor_->parameter_count, std::uint32_t{GAITD_MAX_PARAMETERS});
  for (std::uint32_t i = 0; i < descriptor_->parameter_count; ++i) {
    const GaitdParameter& p = descriptor_->parameters[i];
    ASSERT_TRUE(terminated(p.name) && terminated(p.unit) && terminated(p.description));
    EXPECT_TRUE(is_identifier(p.name)) << p.name;
    EXPECT_TRUE(names.insert(p.name).second) << p.name << " twice";
    EXPECT_NE(std::string(p.description), "") << p.name;
    EXPECT_TRUE(std::isfinite(p.minimum) && std::isfinite(p.maximum)) << p.name;
    EXPECT_LT(p.minimum, p.maximum) << p.name;
    EXPECT_LE(p.minimum, p.default_value) << p.name;
    EXPECT_LE(p.default_value, p.maximum) << p.name;
    EXPECT_GE(p.type, GAITD_PARAMETER_REAL) << p.name;
    EXPECT_LE(p.type, GAITD_PARAMETER_BOOLEAN) << p.name;
    if (p.type != GAITD_PARAMETER_REAL) {
      EXPECT_EQ(p.default_value, std::round(p.default_value)) << p.name;
    }
  }
}

TEST_P(PluginFile, VtableIsComplete) {
  create();
  const GaitdLayerVtable& v = *instance_.vtable;
  EXPECT_EQ(v.size, sizeof(GaitdLayerVtable));
  EXPECT_TRUE(v.init && v.activate && v.process && v.reset && v.get_state && v.set_state &&
              v.set_parameter && v.deactivate && v.destroy && v.get_extension);
}

TEST_P(PluginFile, RefusesAHostOfAnotherAbi) {
  GaitdHost host{};
  host.size = sizeof(host);
  host.abi_major = GAITD_ABI_MAJOR + 1;
  GaitdInstance instance{};
  EXPECT_NE(create_(&host, &instance), GAITD_OK);
  EXPECT_NE(create_(nullptr, &instance), GAITD_OK);
  EXPECT_EQ(instance.self, nullptr);
}

TEST_P(PluginFile, DoesNothingBeforeItIsInitialised) {
  create();
  std::vector<char> input(1 << 16);
  std::vector<char> output(1 << 16);
  const GaitdLayerVtable& v = *instance_.vtable;
  EXPECT_EQ(v.activate(instance_.self), GAITD_NOT_READY);
  EXPECT_EQ(v.process(instance_.self, input.data(), output.data()), GAITD_NOT_READY);
  EXPECT_EQ(v.reset(instance_.self), GAITD_NOT_READY);
}

TEST_P(PluginFile, RefusesAModelOfAnotherSizeAndAWrongNumberOfParameters) {
  create();
  const GaitdLayerVtable& v = *instance_.vtable;
  auto model = std::make_unique<GaitdModel>(testing::atlas());
  const std::vector<double> values(GAITD_MAX_PARAMETERS);
  EXPECT_EQ(v.init(instance_.self, model.get(), values.data(), descriptor_->parameter_count + 1),
            GAITD_INVALID_ARGUMENT);
  model->size = sizeof(GaitdModel) - 8;
  EXPECT_EQ(v.init(instance_.self, model.get(), nullptr, 0), GAITD_INVALID_ARGUMENT);
  EXPECT_EQ(v.init(instance_.self, nullptr, nullptr, 0), GAITD_INVALID_ARGUMENT);
}

TEST_P(PluginFile, TakesItsDefaultsAndRefusesUnknownParameters) {
  init();
  const GaitdLayerVtable& v = *instance_.vtable;
  EXPECT_EQ(v.activate(instance_.self), GAITD_OK);
  for (std::uint32_t i = 0; i < descriptor_->parameter_count; ++i) {
    EXPECT_EQ(v.set_parameter(instance_.self, i, descriptor_->parameters[i].default_value),
              GAITD_OK);
  }
  EXPECT_EQ(v.set_parameter(instance_.self, descriptor_->parameter_count, 0.0),
            GAITD_INVALID_ARGUMENT);
  EXPECT_EQ(v.get_extension(instance_.self, "no.such.extension"), nullptr);
  EXPECT_EQ(v.deactivate(instance_.self), GAITD_OK);
}

TEST_P(PluginFile, RefusesAnInputAndAStateOfAnOlderContract) {
  init();
  std::vector<char> input(1 << 16);  // size 0
  std::vector<char> output(1 << 16);
  const GaitdLayerVtable& v = *instance_.vtable;
  EXPECT_EQ(v.process(instance_.self, input.data(), output.data()), GAITD_INVALID_ARGUMENT);
  EXPECT_EQ(v.set_state(instance_.self, input.data()), GAITD_INVALID_ARGUMENT);
}

TEST_P(PluginFile, AResetComesBackWithOk) {
  init();
  EXPECT_EQ(instance_.vtable->reset(instance_.self), GAITD_OK);
}

INSTANTIATE_TEST_SUITE_P(Built, PluginFile, ::testing::ValuesIn(plugin_files()), name_of);

TEST(PluginFiles, EveryLayerHasOne) {
  std::set<int> layers;
  for (const File& f : plugin_files()) layers.insert(f.layer);
  EXPECT_EQ(layers.size(), static_cast<std::size_t>(GAITD_LAYER_COUNT));
}

}  // namespace
}  // namespace gaitd
