// SPDX-License-Identifier: Apache-2.0
#include "daemon/log/crc32.h"

#include <array>
#include <cstring>

namespace gaitd::daemon {

namespace {

constexpr std::uint32_t kPolynomial = 0xEDB88320u;

using Table = std::array<std::array<std::uint32_t, 256>, 8>;

// Row k: the remainder of a byte that is followed by k zero bytes, so that eight bytes are folded
// in one step.
constexpr Table make_table() {
  Table table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t remainder = byte;
    for (int bit = 0; bit < 8; ++bit) {
      remainder = (remainder >> 1) ^ ((remainder & 1u) != 0 ? kPolynomial : 0u);
    }
    table[0][byte] = remainder;
  }
  for (std::size_t row = 1; row < 8; ++row) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = table[row - 1][byte];
      table[row][byte] = (before >> 8) ^ table[0][before & 0xFFu];
    }
  }
  return table;
}

constexpr Table kTable = make_table();

}  // namespace

std::uint32_t crc32(std::string_view bytes, std::uint32_t so_far) {
  std::uint32_t crc = ~so_far;
  const char* data = bytes.data();
  std::size_t left = bytes.size();
  for (; left >= 8; left -= 8, data += 8) {
    std::uint32_t low;
    std::uint32_t high;
    std::memcpy(&low, data, 4);
    std::memcpy(&high, data + 4, 4);
    low ^= crc;
    crc = kTable[7][low & 0xFFu] ^ kTable[6][(low >> 8) & 0xFFu] ^ kTable[5][(low >> 16) & 0xFFu] ^
          kTable[4][low >> 24] ^ kTable[3][high & 0xFFu] ^ kTable[2][(high >> 8) & 0xFFu] ^
          kTable[1][(high >> 16) & 0xFFu] ^ kTable[0][high >> 24];
  }
  for (; left > 0; --left, ++data) {
    crc = (crc >> 8) ^ kTable[0][(crc ^ static_cast<unsigned char>(*data)) & 0xFFu];
  }
  return ~crc;
}

}  // namespace gaitd::daemon
