// SPDX-License-Identifier: Apache-2.0
#include "recorded_ticks.h"

#include <lzma.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <type_traits>

namespace gaitd::benchmarks {
namespace {

static_assert(std::is_trivially_copyable_v<RecordedTick>);
constexpr std::size_t kSize = sizeof(RecordedTick);
constexpr std::array<char, 8> kMagic = {'G', 'A', 'I', 'T', 'T', 'C', 'K', '1'};
constexpr std::size_t kLimit = 10000;  // ticks of one file

struct Header {
  std::array<char, 8> magic = kMagic;
  std::uint32_t count = 0;
  std::uint32_t size = kSize;
};

// Byte k of all ticks side by side, each against the tick before: most of them do not change.
std::string pack(const std::vector<RecordedTick>& ticks) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(ticks.data());
  std::string packed(ticks.size() * kSize, '\0');
  for (std::size_t k = 0; k < kSize; ++k) {
    unsigned char before = 0;
    for (std::size_t t = 0; t < ticks.size(); ++t) {
      const unsigned char now = bytes[t * kSize + k];
      packed[k * ticks.size() + t] = static_cast<char>(now ^ before);
      before = now;
    }
  }
  return packed;
}

std::vector<RecordedTick> unpack(const std::string& packed, std::size_t count) {
  std::vector<RecordedTick> ticks(count);
  auto* bytes = reinterpret_cast<unsigned char*>(ticks.data());
  for (std::size_t k = 0; k < kSize; ++k) {
    unsigned char before = 0;
    for (std::size_t t = 0; t < count; ++t) {
      before ^= static_cast<unsigned char>(packed[k * count + t]);
      bytes[t * kSize + k] = before;
    }
  }
  return ticks;
}

}  // namespace

bool write_ticks(const std::string& file, const std::vector<RecordedTick>& ticks) {
  const Header header{.count = static_cast<std::uint32_t>(ticks.size())};
  const std::string packed = pack(ticks);
  std::vector<std::uint8_t> out(lzma_stream_buffer_bound(packed.size()));
  std::size_t size = 0;
  if (lzma_easy_buffer_encode(9 | LZMA_PRESET_EXTREME, LZMA_CHECK_CRC64, nullptr,
                              reinterpret_cast<const std::uint8_t*>(packed.data()), packed.size(),
                              out.data(), &size, out.size()) != LZMA_OK) {
    return false;
  }
  std::ofstream stream(file, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(&header), sizeof(header));
  stream.write(reinterpret_cast<const char*>(out.data()), static_cast<std::streamsize>(size));
  return static_cast<bool>(stream.flush());
}

std::vector<RecordedTick> read_ticks(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  Header header;
  stream.read(reinterpret_cast<char*>(&header), sizeof(header));
  if (!stream || header.magic != kMagic || header.size != kSize || header.count > kLimit) return {};
  const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
  std::string packed(header.count * kSize, '\0');
  std::uint64_t memory = UINT64_MAX;
  std::size_t in = 0, out = 0;
  if (lzma_stream_buffer_decode(&memory, 0, nullptr,
                                reinterpret_cast<const std::uint8_t*>(bytes.data()), &in,
                                bytes.size(), reinterpret_cast<std::uint8_t*>(packed.data()), &out,
                                packed.size()) != LZMA_OK ||
      out != packed.size()) {
    return {};
  }
  return unpack(packed, header.count);
}

std::vector<RecordedTick> read_walk(const std::string& name) {
  return read_ticks(std::string(GAITD_BENCHMARK_DATA "/") + name + ".ticks");
}

}  // namespace gaitd::benchmarks
