// SPDX-License-Identifier: Apache-2.0
#include "cli/random_draw.h"

namespace gaitd::cli {

double uniform_draw(std::uint64_t seed, std::string_view name, std::size_t place) {
  std::uint64_t h = 14695981039346656037ULL;  // FNV-1a
  for (const char c : name) h = (h ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  std::uint64_t z = h + (seed + 1) * 0x9e3779b97f4a7c15ULL + place * 0xd1342543de82ef95ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;  // splitmix64
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

}  // namespace gaitd::cli
