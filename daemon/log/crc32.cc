// SPDX-License-Identifier: Apache-2.0
#include "daemon/log/crc32.h"

#include <array>
#include <cstring>

#ifdef __x86_64__
#include <immintrin.h>
#endif

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

#ifdef __x86_64__

// x^(128 k + 32) and x^(128 k - 32) modulo the polynomial, reflected: what 16 bytes are multiplied
// by when k times 16 bytes follow them.
constexpr long long kFour[] = {0x154442bd4, 0x1c6e41596};
constexpr long long kOne[] = {0x1751997d0, 0x0ccaa009e};

__attribute__((target("pclmul,sse4.1"))) inline __m128i fold(__m128i before, __m128i by,
                                                             __m128i after) {
  const __m128i low = _mm_clmulepi64_si128(before, by, 0x00);
  const __m128i high = _mm_clmulepi64_si128(before, by, 0x11);
  return _mm_xor_si128(_mm_xor_si128(low, high), after);
}

inline __m128i load(const char* data) {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(data));
}

// Makes of `size` bytes, a multiple of 64, 16 with the same remainder if the register was `crc`
// before those and is zero before these (Gopal et al., "Fast CRC computation for generic
// polynomials using PCLMULQDQ instruction").
__attribute__((target("pclmul,sse4.1"))) void fold_all(const char* data, std::size_t size,
                                                       std::uint32_t crc, char (&folded)[16]) {
  __m128i x[4];
  for (int i = 0; i < 4; ++i) x[i] = load(data + 16 * i);
  x[0] = _mm_xor_si128(x[0], _mm_cvtsi32_si128(static_cast<int>(crc)));
  const __m128i four = _mm_set_epi64x(kFour[1], kFour[0]);
  for (std::size_t at = 64; at < size; at += 64) {
    for (int i = 0; i < 4; ++i) x[i] = fold(x[i], four, load(data + at + 16 * i));
  }
  const __m128i one = _mm_set_epi64x(kOne[1], kOne[0]);
  for (int i = 1; i < 4; ++i) x[0] = fold(x[0], one, x[i]);
  _mm_storeu_si128(reinterpret_cast<__m128i*>(folded), x[0]);
}

#endif  // __x86_64__

// Of the register, by tables.
std::uint32_t update(std::uint32_t crc, const char* data, std::size_t left) {
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
  return crc;
}

}  // namespace

// A log has a checksum of every byte, twice: without the folding they took a twentieth of the time
// of a run in lockstep.
std::uint32_t crc32(std::string_view bytes, std::uint32_t so_far) {
  std::uint32_t crc = ~so_far;
#ifdef __x86_64__
  static const bool folds = __builtin_cpu_supports("pclmul") && __builtin_cpu_supports("sse4.1");
  if (const std::size_t whole = bytes.size() / 64 * 64; folds && whole > 0) {
    char folded[16];
    fold_all(bytes.data(), whole, crc, folded);
    crc = update(0, folded, sizeof(folded));
    bytes.remove_prefix(whole);
  }
#endif
  return ~update(crc, bytes.data(), bytes.size());
}

}  // namespace gaitd::daemon
