// SPDX-License-Identifier: Apache-2.0
// PNG images of one channel of 16 bit.
#ifndef GAITD_TERRAIN_GREY_PNG_H_
#define GAITD_TERRAIN_GREY_PNG_H_

#include <cstdint>
#include <string>
#include <vector>

namespace gaitd::terrain {

// Row by row from the top, each from the left.
struct GreyImage {
  int width = 0, height = 0;
  std::vector<std::uint16_t> pixels;
};

// Of an image that is read or written: a little more than the largest map that plans are made on.
inline constexpr std::uint64_t kMaxPixels = 4096 * 4096;

// "" or what is wrong.
std::string read_grey_png(const std::string& file, GreyImage* image);
std::string write_grey_png(const GreyImage& image, const std::string& file);

}  // namespace gaitd::terrain

#endif  // GAITD_TERRAIN_GREY_PNG_H_
