// SPDX-License-Identifier: Apache-2.0
#include "daemon/log/signal_codec.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "daemon/log/signal_tree.h"

namespace gaitd::daemon {

namespace {

using Kind = SignalDescription::Kind;

constexpr int kVarint = 0;  // wire types of protobuf
constexpr int kFixed64 = 1;
constexpr int kLengthDelimited = 2;
constexpr char kNoWord = 127;  // enumeration out of range; never a word, see kMaxWords
constexpr std::int64_t kNoInteger = std::numeric_limits<std::int64_t>::min();

void put_varint(std::uint64_t value, std::string* out) {
  for (; value >= 0x80; value >>= 7) *out += static_cast<char>((value & 0x7F) | 0x80);
  *out += static_cast<char>(value);
}

std::string tag(int number, int wire_type) {
  std::string bytes;
  put_varint(static_cast<std::uint64_t>(number) << 3 | static_cast<unsigned>(wire_type), &bytes);
  return bytes;
}

bool is_wide(Kind kind) { return kind == Kind::kReal || kind == Kind::kInteger; }

std::int64_t to_integer(double value) {
  constexpr double kLimit = 9223372036854775808.0;  // 2^63
  return value >= -kLimit && value < kLimit ? static_cast<std::int64_t>(value) : kNoInteger;
}

}  // namespace

SignalCodec::SignalCodec(const SignalTable& table) : places_(table.size()) {
  template_ = encode(table, build_signal_tree(table), 0);
  std::vector<std::pair<std::size_t, std::size_t>> values;
  for (const Place& place : places_) {
    values.emplace_back(place.offset, is_wide(place.kind) ? 8 : 1);
  }
  std::sort(values.begin(), values.end());
  std::size_t end = 0;
  for (const auto& [offset, size] : values) {
    fixed_.emplace_back(end, offset - end);
    end = offset + size;
  }
}

// The bytes of the message of the node with all values zero, and the places of its values.
// `offset`: where those bytes will stand in the whole message. The length before a nested message
// must be known to place what is in it, so a first pass measures.
std::string SignalCodec::encode(const SignalTable& table, const SignalNode& node,
                                std::size_t offset) {
  std::string bytes;
  for (const SignalNode& child : node.children) {
    if (child.signal < 0) {
      const std::size_t size = encode(table, child, 0).size();
      bytes += tag(child.number, kLengthDelimited);
      put_varint(size, &bytes);
      bytes += encode(table, child, offset + bytes.size());
      continue;
    }
    const auto signal = static_cast<std::size_t>(child.signal);
    const SignalDescription& description = table[signal];
    const bool wide = is_wide(description.kind);
    bytes += tag(child.number, wide ? kFixed64 : kVarint);
    places_[signal] = {offset + bytes.size(), description.kind,
                       static_cast<int>(description.words.size())};
    bytes.append(wide ? 8 : 1, '\0');
  }
  return bytes;
}

void SignalCodec::append(std::span<const double> values, std::string* out) const {
  const std::size_t start = out->size();
  out->append(template_);
  char* message = out->data() + start;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Place& place = places_[i];
    char* target = message + place.offset;
    const double value = values[i];
    switch (place.kind) {
      case Kind::kReal:
        std::memcpy(target, &value, sizeof(value));
        break;
      case Kind::kInteger: {
        const std::int64_t integer = to_integer(value);
        std::memcpy(target, &integer, sizeof(integer));
        break;
      }
      case Kind::kBoolean:
        *target = value != 0.0 ? 1 : 0;
        break;
      case Kind::kEnumeration:
        *target = value >= 0.0 && value < place.words ? static_cast<char>(value) : kNoWord;
        break;
    }
  }
}

bool SignalCodec::matches(std::string_view message) const {
  if (message.size() != template_.size()) return false;
  return std::all_of(fixed_.begin(), fixed_.end(), [&](const auto& part) {
    return std::memcmp(message.data() + part.first, template_.data() + part.first, part.second) ==
           0;
  });
}

double SignalCodec::value(std::string_view message, std::size_t signal) const {
  const Place& place = places_[signal];
  const char* source = message.data() + place.offset;
  double value = std::numeric_limits<double>::quiet_NaN();
  switch (place.kind) {
    case Kind::kReal:
      std::memcpy(&value, source, sizeof(value));
      break;
    case Kind::kInteger: {
      std::int64_t integer;
      std::memcpy(&integer, source, sizeof(integer));
      if (integer != kNoInteger) value = static_cast<double>(integer);
      break;
    }
    case Kind::kBoolean:
      value = *source != 0 ? 1.0 : 0.0;
      break;
    case Kind::kEnumeration:
      if (*source >= 0 && *source < place.words) value = *source;
      break;
  }
  return value;
}

}  // namespace gaitd::daemon
