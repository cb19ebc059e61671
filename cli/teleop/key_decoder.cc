// SPDX-License-Identifier: Apache-2.0
#include "cli/teleop/key_decoder.h"

namespace gaitd::cli::teleop {
namespace {

using std::chrono::milliseconds;

constexpr unsigned char kEscapeByte = 0x1b;
constexpr unsigned char kInterrupt = 0x03;  // Ctrl-C where it is no signal
constexpr milliseconds kAlone{50};
constexpr milliseconds kRest{1000};  // in which the rest of a sequence comes, or never

std::optional<Key> key_of(unsigned char byte) {
  switch (byte) {
    case 'w':
    case 'W':
      return Key::kForward;
    case 's':
    case 'S':
      return Key::kBackward;
    case 'a':
    case 'A':
      return Key::kLeft;
    case 'd':
    case 'D':
      return Key::kRight;
    case 'q':
    case 'Q':
      return Key::kTurnLeft;
    case 'e':
    case 'E':
      return Key::kTurnRight;
    case ' ':
      return Key::kStop;
    case '+':
    case '=':  // + without Shift
      return Key::kFaster;
    case '-':
    case '_':
      return Key::kSlower;
    case 'm':
    case 'M':
      return Key::kArm;
    case 'r':
    case 'R':
      return Key::kReset;
    case '?':
      return Key::kHelp;
    case 'x':
    case 'X':
    case kInterrupt:
      return Key::kQuit;
    default:
      return std::nullopt;
  }
}

std::optional<Key> arrow(unsigned char letter) {
  switch (letter) {
    case 'A':
      return Key::kForward;
    case 'B':
      return Key::kBackward;
    case 'C':
      return Key::kRight;
    case 'D':
      return Key::kLeft;
    default:
      return std::nullopt;
  }
}

bool introduces(unsigned char byte) { return byte == '[' || byte == 'O'; }

}  // namespace

void KeyDecoder::begin_sequence(unsigned char introducer, Time now) {
  state_ = introducer == '[' ? State::kSequence : State::kLetter;
  since_ = now;
  first_ = true;
}

void KeyDecoder::take_one(unsigned char byte, Time now, std::vector<Key>* keys) {
  if (byte == kEscapeByte && state_ != State::kEscape) {
    state_ = State::kEscape;
    since_ = now;
    unwanted_ = false;
    return;
  }
  // No keyboard puts these into a sequence: it has come to nothing.
  const bool in_sequence = state_ != State::kGround && state_ != State::kEscape;
  if (in_sequence && byte <= ' ') state_ = State::kGround;
  switch (state_) {
    case State::kGround:
      if (introduces(byte) && alone_ && now - *alone_ < kRest) {
        alone_.reset();
        unwanted_ = true;
        return begin_sequence(byte, now);
      }
      if (const auto key = key_of(byte)) keys->push_back(*key);
      return;
    case State::kEscape:
      if (byte == kEscapeByte) {
        unwanted_ = true;  // Esc held, or Alt with an arrow: the first one's time goes on
        return;
      }
      if (introduces(byte)) return begin_sequence(byte, now);
      state_ = State::kGround;
      keys->push_back(Key::kEstop);
      return;
    case State::kSequence:
      if (first_ && byte == '[') {  // function keys of the Linux console: ESC [ [ A
        state_ = State::kLinux;
        return;
      }
      first_ = false;
      if (byte >= 0x20 && byte < 0x40) return;  // numbers, of Shift and Ctrl
      break;
    case State::kLinux:
      state_ = State::kGround;
      return;
    case State::kLetter:
      break;
  }
  state_ = State::kGround;
  if (const auto key = arrow(byte); key && !unwanted_) keys->push_back(*key);
}

std::vector<Key> KeyDecoder::take(std::string_view bytes, Time now) {
  std::vector<Key> keys;
  const bool in_sequence = state_ != State::kGround && state_ != State::kEscape;
  if (in_sequence && now - since_ > kRest) state_ = State::kGround;
  for (const char byte : bytes) take_one(static_cast<unsigned char>(byte), now, &keys);
  return keys;
}

bool KeyDecoder::lone_escape(Time now) {
  if (state_ != State::kEscape || now - since_ < kAlone) return false;
  state_ = State::kGround;
  alone_ = now;
  return true;
}

}  // namespace gaitd::cli::teleop
