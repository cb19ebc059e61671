// SPDX-License-Identifier: Apache-2.0
#include "cli/report/animated_png.h"

#include <cstdint>
#include <optional>
#include <string_view>

#include "daemon/log/crc32.h"

namespace gaitd::cli {
namespace {

constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);

struct Chunk {
  std::string_view type;
  std::string_view data;
};

std::uint32_t number_at(std::string_view bytes, std::size_t place) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value = value << 8 | static_cast<unsigned char>(bytes[place + i]);
  }
  return value;
}

void append(std::string* out, std::uint32_t value, int bytes = 4) {
  for (int i = bytes - 1; i >= 0; --i) *out += static_cast<char>(value >> (8 * i) & 255u);
}

void append_chunk(std::string* out, std::string_view type, std::string_view data) {
  append(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = out->size();
  *out += type;
  *out += data;
  append(out, daemon::crc32(std::string_view(*out).substr(begin)));
}

// Nothing if the file is no PNG, or cut off.
std::optional<std::vector<Chunk>> chunks_of(std::string_view png) {
  constexpr std::size_t kFrame = 12;  // size, type and checksum
  if (!png.starts_with(kSignature)) return std::nullopt;
  png.remove_prefix(kSignature.size());
  std::vector<Chunk> chunks;
  while (png.size() >= kFrame) {
    const std::size_t size = number_at(png, 0);
    if (size > png.size() - kFrame) return std::nullopt;
    chunks.push_back({png.substr(4, 4), png.substr(8, size)});
    png.remove_prefix(size + kFrame);
  }
  const bool whole = chunks.size() >= 3 && chunks.front().type == "IHDR" &&
                     chunks.front().data.size() == 13 && chunks.back().type == "IEND";
  return whole ? std::optional(chunks) : std::nullopt;
}

// That of one frame.
std::string frame_control(std::uint32_t number, std::string_view header, int rate) {
  std::string data;
  append(&data, number);
  data += header.substr(0, 8);                    // width and height
  append(&data, 0);                               // at the left
  append(&data, 0);                               // at the top
  append(&data, 1, 2);                            // shown for 1 ...
  append(&data, static_cast<unsigned>(rate), 2);  // ... of so many parts of a second
  append(&data, 0, 2);                            // left there, and written over
  return data;
}

}  // namespace

std::string animated_png(const std::vector<std::string>& frames, int rate) {
  std::string film(kSignature);
  std::string header;
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto chunks = chunks_of(frames[i]);
    if (!chunks) return "";
    if (i == 0) {
      header = chunks->front().data;
      append_chunk(&film, "IHDR", header);
      std::string control;
      append(&control, static_cast<std::uint32_t>(frames.size()));
      append(&control, 0);  // for ever
      append_chunk(&film, "acTL", control);
    } else if (chunks->front().data != header) {
      return "";
    }
    append_chunk(&film, "fcTL", frame_control(number++, header, rate));
    for (const Chunk& chunk : *chunks) {
      if (chunk.type != "IDAT") continue;
      std::string data;
      if (i > 0) append(&data, number++);
      data += chunk.data;
      append_chunk(&film, i == 0 ? "IDAT" : "fdAT", data);
    }
  }
  append_chunk(&film, "IEND", "");
  return header.empty() ? "" : film;
}

}  // namespace gaitd::cli
