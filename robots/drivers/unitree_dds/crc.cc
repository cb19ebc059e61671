// SPDX-License-Identifier: Apache-2.0
#include "crc.h"

#include <array>
#include <cstring>

namespace gaitd::unitree {
namespace {

constexpr std::array<uint32_t, 256> make_table() {
  std::array<uint32_t, 256> table{};
  for (uint32_t i = 0; i < 256; ++i) {
    uint32_t value = i << 24;
    for (int bit = 0; bit < 8; ++bit) {
      value = (value & 0x80000000u) != 0 ? (value << 1) ^ 0x04C11DB7u : value << 1;
    }
    table[i] = value;
  }
  return table;
}

constexpr std::array<uint32_t, 256> kTable = make_table();

}  // namespace

uint32_t crc32(const void* words, size_t count) {
  uint32_t crc = 0xFFFFFFFFu;
  const auto* bytes = static_cast<const unsigned char*>(words);
  for (size_t i = 0; i < count; ++i) {
    uint32_t word;
    std::memcpy(&word, bytes + 4 * i, 4);
    for (int shift = 24; shift >= 0; shift -= 8) {
      crc = (crc << 8) ^ kTable[(crc >> 24) ^ ((word >> shift) & 0xFF)];
    }
  }
  return crc;
}

}  // namespace gaitd::unitree
