// SPDX-License-Identifier: Apache-2.0
#include "daemon/log/seal.h"

#include <algorithm>

#include "daemon/log/bytes.h"
#include "daemon/log/crc32.h"

namespace gaitd::daemon {

namespace {

constexpr std::uint64_t kBlock = 1u << 20;

std::string seal_head() {
  std::string head;
  put(head, static_cast<std::uint8_t>(mcap::kSeal));
  put(head, kSealContentSize);
  return head;
}

}  // namespace

std::string encode_seal(const Seal& seal) {
  std::string content;
  put(content, seal.start);
  put(content, seal.before);
  put(content, seal.after);
  put(content, crc32(content));
  return content;
}

std::optional<Seal> parse_seal(std::string_view content) {
  if (content.size() != kSealContentSize) return std::nullopt;
  ByteReader reader(content);
  Seal seal;
  seal.start = reader.take<std::uint64_t>();
  seal.before = reader.take<std::uint32_t>();
  seal.after = reader.take<std::uint32_t>();
  const auto checksum = reader.take<std::uint32_t>();
  if (checksum != crc32(content.substr(0, kSealContentSize - sizeof(checksum)))) {
    return std::nullopt;
  }
  return seal;
}

std::optional<FoundSeal> find_seal(const InputFile& file, std::uint64_t from) {
  const std::string head = seal_head();
  std::string block;
  while (from + kSealSize <= file.size()) {
    // Blocks overlap, so that a seal on their border is whole in one of them.
    const std::uint64_t count = std::min(kBlock + kSealSize, file.size() - from);
    if (!file.read(from, count, &block)) return std::nullopt;
    for (std::size_t at = block.find(head); at != std::string::npos;
         at = block.find(head, at + 1)) {
      if (at + kSealSize > block.size()) break;
      const auto seal =
          parse_seal(std::string_view(block).substr(at + head.size(), kSealContentSize));
      if (seal && seal->start < from + at) return FoundSeal{from + at, *seal};
    }
    if (count <= kBlock) break;
    from += kBlock;
  }
  return std::nullopt;
}

std::optional<std::uint32_t> file_crc32(const InputFile& file, std::uint64_t begin,
                                        std::uint64_t end, std::uint32_t so_far) {
  std::string block;
  for (std::uint64_t at = begin; at < end; at += block.size()) {
    if (!file.read(at, std::min(kBlock, end - at), &block)) return std::nullopt;
    so_far = crc32(block, so_far);
  }
  return so_far;
}

}  // namespace gaitd::daemon
