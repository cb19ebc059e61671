// SPDX-License-Identifier: Apache-2.0
#include "gaitd/terrain/height_map_file.h"

#include <gtest/gtest.h>
#include <png.h>

#include <filesystem>
#include <fstream>
#include <random>

namespace gaitd::terrain {
namespace {

namespace fs = std::filesystem;

class HeightMapFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) /
              ::testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string file(const char* name) const { return (folder_ / name).string(); }
  std::string write(const char* name, const std::string& text) const {
    std::ofstream(file(name)) << text;
    return file(name);
  }
  // An image of grey pixels, `format` as of libpng's simplified interface.
  void image(const char* name, png_uint_32 format, int width, int height) const {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(width);
    image.height = static_cast<png_uint_32>(height);
    image.format = format;
    const std::vector<unsigned char> pixels(PNG_IMAGE_SIZE(image), 100);
    ASSERT_TRUE(png_image_write_to_file(&image, file(name).c_str(), 0, pixels.data(), 0, nullptr));
  }
  std::string error_of(const std::string& name) const {
    std::string error;
    EXPECT_FALSE(load_height_map(name, &error));
    return error;
  }

  fs::path folder_;
};

HeightMap drawn_map(bool variances) {
  HeightMap map(Grid{17, 11, 0.025, {-3.5, 2.25}});
  std::mt19937 random(4);
  std::uniform_real_distribution<double> height(-0.7, 1.3), variance(0.0, 1e-3);
  for (int j = 0; j < 11; ++j) {
    for (int i = 0; i < 17; ++i) map.set(i, j, height(random), variances ? variance(random) : 0.0);
  }
  map.set(3, 2, HeightMap::kUnknown);
  return map;
}

TEST_F(HeightMapFile, ComesBackAsItWasWritten) {
  for (const bool variances : {false, true}) {
    const HeightMap map = drawn_map(variances);
    ASSERT_EQ(save_height_map(map, file("map.yaml")), "");
    std::string error;
    const auto again = load_height_map(file("map.yaml"), &error);
    ASSERT_TRUE(again) << error;
    EXPECT_EQ(again->grid().columns, 17);
    EXPECT_EQ(again->grid().rows, 11);
    EXPECT_EQ(again->grid().resolution, 0.025);
    EXPECT_EQ(again->grid().origin, Eigen::Vector2d(-3.5, 2.25));
    EXPECT_EQ(again->known_cells(), 17 * 11 - 1);
    EXPECT_FALSE(again->known(3, 2));
    for (int j = 0; j < 11; ++j) {
      for (int i = 0; i < 17; ++i) {
        if (!map.known(i, j)) continue;
        ASSERT_NEAR(again->height(i, j), map.height(i, j), 2.0 / 65534);
        ASSERT_NEAR(again->variance(i, j), map.variance(i, j), 1e-3 / 65534);
      }
    }
  }
}

TEST_F(HeightMapFile, TheFirstRowOfTheImageIsThatOfLargestY) {
  HeightMap map(Grid{3, 2, 0.1, {0, 0}});
  for (int i = 0; i < 3; ++i) {
    map.set(i, 0, 0.0);
    map.set(i, 1, 1.0);
  }
  ASSERT_EQ(save_height_map(map, file("map.yaml")), "");
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&image, file("map.png").c_str()));
  image.format = PNG_FORMAT_LINEAR_Y;
  std::vector<std::uint16_t> pixels(6);
  ASSERT_TRUE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr));
  EXPECT_EQ(pixels[0], 65534);
  EXPECT_EQ(pixels[5], 0);
}

TEST_F(HeightMapFile, EveryMistakeIsNamedWithItsLine) {
  image("wide.png", PNG_FORMAT_LINEAR_Y, 4, 3);
  const std::string error =
      error_of(write("map.yaml",
                     "image: wide.png\nresolution: 0\norigin: [1, far, 0.5]\nheight_scale: "
                     "none\nheigth_offset: 1\nvariance: missing.png\n"));
  for (const char* part :
       {"map.yaml:2: resolution: expected a number from 0.002 to 1, got '0'",
        "map.yaml:3: origin: expected numbers from -10000 to 10000, got 'far'",
        "map.yaml:3: origin: expected a yaw of 0, since maps are not turned, got '0.5'",
        "map.yaml:4: height_scale: expected a number from 1e-07 to 1, got 'none'",
        "map.yaml:5: heigth_offset: expected one of the keys of a height map",
        "variance_scale: expected a number from 1e-12 to 1, got nothing",
        "map.yaml:6: variance: ", "No such file"}) {
    EXPECT_NE(error.find(part), std::string::npos) << part << "\n" << error;
  }
}

TEST_F(HeightMapFile, ImagesThatDoNotFitAreRefused) {
  const char* rest = "\nresolution: 0.02\norigin: [0, 0, 0]\nheight_scale: 0.001\n";
  image("colour.png", PNG_FORMAT_RGB, 4, 3);
  EXPECT_NE(error_of(write("a.yaml", std::string("image: colour.png") + rest))
                .find("expected one channel of grey with 16 bit, got 3 channels of 8 bit"),
            std::string::npos);
  image("thin.png", PNG_FORMAT_LINEAR_Y, 1, 3);
  EXPECT_NE(error_of(write("b.yaml", std::string("image: thin.png") + rest))
                .find("expected at least 2 pixels either way and at most 16777216 of them, got 1 x "
                      "3"),
            std::string::npos);
  image("good.png", PNG_FORMAT_LINEAR_Y, 4, 3);
  image("other.png", PNG_FORMAT_LINEAR_Y, 5, 3);
  EXPECT_NE(error_of(write("c.yaml", std::string("image: good.png\nvariance: other.png\n"
                                                 "variance_scale: 1e-6") +
                                         rest))
                .find("as large as that of the heights, 4 x 3, got 5 x 3"),
            std::string::npos);
  write("text.png", "no image");
  EXPECT_NE(error_of(write("d.yaml", std::string("image: text.png") + rest)).find("libpng refuses"),
            std::string::npos);
}

TEST_F(HeightMapFile, ADamagedImageIsRefused) {
  ASSERT_EQ(save_height_map(drawn_map(false), file("map.yaml")), "");
  const auto size = fs::file_size(file("map.png"));
  fs::resize_file(file("map.png"), size / 2);
  EXPECT_NE(error_of(file("map.yaml")).find("libpng refuses"), std::string::npos);
}

TEST_F(HeightMapFile, WhatIsNoYamlMapIsRefused) {
  EXPECT_NE(error_of(file("none.yaml")).find("no such file"), std::string::npos);
  EXPECT_NE(error_of(write("list.yaml", "- 1\n")).find("something else"), std::string::npos);
  EXPECT_NE(error_of(write("bad.yaml", "a: [1\n")).find("expected YAML"), std::string::npos);
  EXPECT_NE(error_of(write("large.yaml", std::string(70000, '#'))).find("at most 64 KiB"),
            std::string::npos);
}

// What is written can be read: a long map can, and what is too large is refused when it is written.
TEST_F(HeightMapFile, WhatIsTooLargeIsNotWritten) {
  HeightMap strip(Grid{5000, 2, 0.02, {0.0, 0.0}});
  strip.set(4999, 1, 0.5);
  ASSERT_EQ(save_height_map(strip, file("strip.yaml")), "");
  std::string error;
  const auto again = load_height_map(file("strip.yaml"), &error);
  ASSERT_TRUE(again) << error;
  EXPECT_EQ(again->known_cells(), 1);
  const HeightMap large(Grid{4097, 4097, 0.02, {0.0, 0.0}});
  EXPECT_NE(save_height_map(large, file("large.yaml")).find("at most 16777216 of them"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(file("large.yaml")));
}

TEST_F(HeightMapFile, WhatCannotBeWrittenSaysSo) {
  EXPECT_NE(save_height_map(drawn_map(false), file("map.png")).find(".yaml"), std::string::npos);
  EXPECT_NE(save_height_map(drawn_map(false), file("no/map.yaml")).find("cannot be written"),
            std::string::npos);
}

}  // namespace
}  // namespace gaitd::terrain
