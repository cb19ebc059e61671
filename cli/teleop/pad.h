// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <linux/input.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cli/teleop/pad_state.h"

struct libevdev;

namespace gaitd::cli::teleop {

/// Where the events of a gamepad come from.
class PadEvents {
 public:
  enum class Result { kEvent, kNone, kGone };

  PadEvents() = default;
  virtual ~PadEvents() = default;
  PadEvents(const PadEvents&) = delete;
  PadEvents& operator=(const PadEvents&) = delete;

  virtual int fd() const = 0;                   ///< readable when there may be an event
  virtual Result next(input_event* event) = 0;  ///< does not wait
};

/// `struct input_event` after each other on a descriptor, as the device file has them: a recording,
/// a pipe. It closes the descriptor, which must not block.
class EventStream : public PadEvents {
 public:
  explicit EventStream(int fd) : fd_(fd) {}
  ~EventStream() override;
  int fd() const override { return fd_; }
  Result next(input_event* event) override;

 private:
  int fd_;
  std::size_t filled_ = 0;  // bytes of an event of which more are to come
  input_event partial_{};
};

/// A gamepad and what the hands do on it.
class Pad {
 public:
  Pad(std::string name, const PadAxes& axes, std::unique_ptr<PadEvents> events)
      : name_(std::move(name)), state_(axes), events_(std::move(events)) {}

  const std::string& name() const { return name_; }
  int fd() const { return events_ ? events_->fd() : -1; }
  bool gone() const { return events_ == nullptr; }
  void read();  ///< all events there are; when the device goes, nothing is held
  PadState& state() { return state_; }
  const PadState& state() const { return state_; }

 private:
  std::string name_;
  PadState state_;
  std::unique_ptr<PadEvents> events_;
};

/// The device files in /dev/input that may be gamepads, as they were plugged in.
std::vector<std::string> pad_devices();

/// Opens the gamepad `device`; empty: the first one found in /dev/input. Null with what was looked
/// at, why each will not do and what to do in `error`.
std::unique_ptr<Pad> open_pad(const std::string& device, std::string* error);

/// Whether this gaitctl was built with libevdev, which open_pad needs.
bool has_pads();

/// Only with libevdev. The axes that a device has, with its own ranges; "" or what it lacks of a
/// gamepad.
PadAxes axes_of(const libevdev* device);
std::string lacks(const libevdev* device);

}  // namespace gaitd::cli::teleop
