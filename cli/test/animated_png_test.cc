// SPDX-License-Identifier: Apache-2.0
#include "cli/report/animated_png.h"

#include <gtest/gtest.h>

#include "daemon/log/crc32.h"

namespace gaitd::cli {
namespace {

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 255u);
  return bytes;
}

std::string chunk(const std::string& type, const std::string& data) {
  return big_endian(static_cast<std::uint32_t>(data.size())) + type + data +
         big_endian(daemon::crc32(type + data));
}

std::string png(const std::string& data, char depth = 8) {
  const std::string header =
      big_endian(4) + big_endian(3) + std::string(1, depth) + "\x02" + std::string(3, '\0');
  return std::string("\x89PNG\r\n\x1a\n", 8) + chunk("IHDR", header) + chunk("IDAT", data) +
         chunk("IEND", "");
}

TEST(AnimatedPng, HoldsEveryFrameInOrder) {
  const std::string film = animated_png({png("one"), png("two")}, 10);
  const std::string rest = big_endian(4) + big_endian(3) + big_endian(0) + big_endian(0) +
                           std::string("\0\1\0\xa\0\0", 6);
  const std::size_t frames = film.find(chunk("acTL", big_endian(2) + big_endian(0)));
  const std::size_t first = film.find(chunk("fcTL", big_endian(0) + rest));
  const std::size_t one = film.find(chunk("IDAT", "one"));
  const std::size_t second = film.find(chunk("fcTL", big_endian(1) + rest));
  const std::size_t two = film.find(chunk("fdAT", big_endian(2) + "two"));
  ASSERT_NE(two, std::string::npos);
  EXPECT_LT(frames, first);
  EXPECT_LT(first, one);
  EXPECT_LT(one, second);
  EXPECT_LT(second, two);
  EXPECT_TRUE(film.ends_with(chunk("IEND", "")));
}

TEST(AnimatedPng, RefusesWhatDoesNotFit) {
  EXPECT_EQ(animated_png({}, 10), "");
  EXPECT_EQ(animated_png({"no picture"}, 10), "");
  EXPECT_EQ(animated_png({png("one").substr(0, 40)}, 10), "");
  EXPECT_EQ(animated_png({png("one"), png("two", 16)}, 10), "");
}

}  // namespace
}  // namespace gaitd::cli
