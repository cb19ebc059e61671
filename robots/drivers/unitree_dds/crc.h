// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace gaitd::unitree {

static_assert(std::endian::native == std::endian::little, "the CRC is over little-endian words");

// CRC-32/MPEG-2 over words, each from its most significant bit on: polynomial 0x04C11DB7, initial
// value 0xFFFFFFFF, nothing reflected or inverted.
uint32_t crc32(const void* words, size_t count);

// Of a message of the robot: its struct in memory without the last word, all padding 0. Never of
// the bytes on the wire, which lack some of that padding.
template <class Message>
uint32_t message_crc(const Message& message) {
  static_assert(sizeof(Message) % 4 == 0);
  return crc32(&message, sizeof(Message) / 4 - 1);
}

}  // namespace gaitd::unitree
