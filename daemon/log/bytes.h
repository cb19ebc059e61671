// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <string_view>

namespace gaitd::daemon {

static_assert(std::endian::native == std::endian::little, "files are little-endian");

// Appends the fixed-width types, strings and maps of MCAP.
template <std::integral T>
void put(std::string& out, T value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

inline void put_string(std::string& out, std::string_view text) {
  put(out, static_cast<std::uint32_t>(text.size()));
  out.append(text);
}

inline void put_map(std::string& out, const std::map<std::string, std::string>& map) {
  std::string entries;
  for (const auto& [key, value] : map) {
    put_string(entries, key);
    put_string(entries, value);
  }
  put_string(out, entries);
}

// Takes them again. Reading past the end gives zeros and empty strings and clears ok().
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

  template <std::integral T>
  T take() {
    T value{};
    const std::string_view bytes = take_bytes(sizeof(T));
    if (ok_) std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
  }

  std::string_view take_bytes(std::uint64_t count) {
    if (!ok_ || count > rest_.size()) {
      ok_ = false;
      return {};
    }
    const std::string_view bytes = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return bytes;
  }

  std::string_view take_string() { return take_bytes(take<std::uint32_t>()); }

  std::map<std::string, std::string> take_map() {
    std::map<std::string, std::string> map;
    ByteReader entries(take_string());
    while (entries.ok() && !entries.rest().empty()) {
      const std::string_view key = entries.take_string();
      const std::string_view value = entries.take_string();
      if (entries.ok()) map.emplace(key, value);
    }
    ok_ = ok_ && entries.ok();
    return map;
  }

  bool ok() const { return ok_; }
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
  bool ok_ = true;
};

}  // namespace gaitd::daemon
