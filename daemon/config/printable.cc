// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/printable.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>

namespace gaitd::daemon {

namespace {

bool is_plain(char c) { return (c >= ' ' && c < 127) || c == '\n' || c == '\t'; }

void append_escape(std::uint32_t code, std::string* out) {
  char text[16];
  std::snprintf(text, sizeof(text), "\\u%04x", code);
  *out += text;
}

// Characters of two bytes or more that act instead of being seen.
bool acts(std::uint32_t code) {
  const bool control = code >= 0x80 && code < 0xA0;  // C1: a terminal may take 0x9B as an escape
  const bool direction = (code >= 0x200E && code <= 0x200F) || (code >= 0x202A && code <= 0x202E) ||
                         (code >= 0x2066 && code <= 0x2069);
  return control || direction;
}

std::size_t size_of(unsigned char first) {
  if (first >= 0xC2 && first < 0xE0) return 2;
  if (first >= 0xE0 && first < 0xF0) return 3;
  return first >= 0xF0 && first < 0xF5 ? 4 : 0;
}

}  // namespace

void Printable::drop_partial(std::string* out) {
  for (const char c : partial_) append_escape(static_cast<unsigned char>(c), out);
  partial_.clear();
}

void Printable::take(unsigned char byte, std::string* out) {
  if (!partial_.empty() && (byte & 0xC0) != 0x80) drop_partial(out);
  if (partial_.empty()) {
    size_ = size_of(byte);
    if (is_plain(static_cast<char>(byte))) {
      *out += static_cast<char>(byte);
    } else if (size_ == 0) {
      append_escape(byte, out);
    } else {
      partial_ += static_cast<char>(byte);
    }
    return;
  }
  partial_ += static_cast<char>(byte);
  if (partial_.size() < size_) return;
  std::uint32_t code = static_cast<unsigned char>(partial_[0]) & (0x7Fu >> size_);
  for (std::size_t i = 1; i < size_; ++i) {
    code = code << 6 | (static_cast<unsigned char>(partial_[i]) & 0x3Fu);
  }
  constexpr std::uint32_t kSmallest[] = {0, 0, 0x80, 0x800, 0x10000};
  if (code < kSmallest[size_]) return drop_partial(out);  // a longer way to write another one
  if (acts(code)) {
    append_escape(code, out);
  } else {
    *out += partial_;
  }
  partial_.clear();
}

void Printable::append(std::string_view text, std::string* out) {
  while (!text.empty()) {
    if (partial_.empty()) {
      const auto* const end = std::find_if_not(text.begin(), text.end(), is_plain);
      const auto plain = static_cast<std::size_t>(end - text.begin());
      out->append(text.substr(0, plain));
      text.remove_prefix(plain);
      if (text.empty()) return;
    }
    take(static_cast<unsigned char>(text.front()), out);
    text.remove_prefix(1);
  }
}

void Printable::finish(std::string* out) { drop_partial(out); }

std::string printable(std::string_view text) {
  std::string out;
  Printable filter;
  filter.append(text, &out);
  filter.finish(&out);
  return out;
}

}  // namespace gaitd::daemon
