// SPDX-License-Identifier: Apache-2.0
// Gamepads of this machine, by libevdev.
#include <fcntl.h>
#include <libevdev/libevdev.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "cli/teleop/pad.h"

namespace gaitd::cli::teleop {
namespace {

struct Free {
  void operator()(libevdev* device) const { libevdev_free(device); }
};
using Device = std::unique_ptr<libevdev, Free>;

class DeviceEvents : public PadEvents {
 public:
  explicit DeviceEvents(Device device) : device_(std::move(device)) {}
  ~DeviceEvents() override { close(libevdev_get_fd(device_.get())); }
  int fd() const override { return libevdev_get_fd(device_.get()); }

  Result next(input_event* event) override {
    const unsigned flags = catching_up_ ? LIBEVDEV_READ_FLAG_SYNC : LIBEVDEV_READ_FLAG_NORMAL;
    const int status = libevdev_next_event(device_.get(), flags, event);
    if (status == -EAGAIN && catching_up_) {
      catching_up_ = false;
      return next(event);
    }
    if (status == -EAGAIN || status == -EINTR) return Result::kNone;
    if (status < 0) return Result::kGone;
    if (status == LIBEVDEV_READ_STATUS_SYNC && !catching_up_) {
      catching_up_ = true;  // what was lost comes as events that end at how the device is now
      *event = {};
      event->type = EV_SYN;
      event->code = SYN_REPORT;
    }
    return Result::kEvent;
  }

 private:
  Device device_;
  bool catching_up_ = false;
};

PadAxis axis_of(const libevdev* device, unsigned code) {
  const input_absinfo* info = libevdev_get_abs_info(device, code);
  if (info == nullptr) return {static_cast<int>(code)};
  return {static_cast<int>(code), info->minimum, info->maximum, info->flat};
}

// Null with the reason.
std::unique_ptr<Pad> open_one(const std::string& path, std::string* why) {
  const int fd = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) {
    const bool denied = errno == EACCES || errno == EPERM;
    *why = denied ? "permission denied: be a member of the group that owns it (input), or root"
                  : std::strerror(errno);
    return nullptr;
  }
  libevdev* raw = nullptr;
  if (const int status = libevdev_new_from_fd(fd, &raw); status < 0) {
    close(fd);
    *why = status == -ENOTTY ? "no input device" : std::strerror(-status);
    return nullptr;
  }
  Device device(raw);
  const char* name = libevdev_get_name(raw);
  const std::string known = name == nullptr ? "" : name;
  if (const std::string missing = lacks(raw); !missing.empty()) {
    close(fd);
    *why = known + ": no gamepad: " + missing;
    return nullptr;
  }
  const PadAxes axes = axes_of(raw);
  return std::make_unique<Pad>(known, axes, std::make_unique<DeviceEvents>(std::move(device)));
}

}  // namespace

bool has_pads() { return true; }

PadAxes axes_of(const libevdev* device) {
  // The right stick is RX on most, Z on those that have no triggers of their own.
  const bool has_rx = libevdev_has_event_code(device, EV_ABS, ABS_RX) != 0;
  return {axis_of(device, ABS_Y), axis_of(device, ABS_X), axis_of(device, has_rx ? ABS_RX : ABS_Z)};
}

std::string lacks(const libevdev* device) {
  const auto has = [&](unsigned type, unsigned code) {
    return libevdev_has_event_code(device, type, code) != 0;
  };
  if (!has(EV_ABS, ABS_X) || !has(EV_ABS, ABS_Y)) return "it has no stick (ABS_X, ABS_Y)";
  if (!has(EV_KEY, BTN_TL)) return "it has no button for the dead man (LB, BTN_TL)";
  if (!has(EV_KEY, BTN_EAST)) return "it has no button for the e-stop (B, BTN_EAST)";
  return "";
}

std::unique_ptr<Pad> open_pad(const std::string& device, std::string* error) {
  std::string why;
  if (!device.empty()) {
    auto pad = open_one(device, &why);
    if (!pad) *error = device + ": " + why;
    return pad;
  }
  std::string looked;
  for (const std::string& path : pad_devices()) {
    if (auto pad = open_one(path, &why)) return pad;
    looked.append("\n  ").append(path).append(": ").append(why);
  }
  if (looked.empty()) looked = "\n  /dev/input has no event devices";
  *error = "no gamepad found:" + looked +
           "\nPlug one in, or name its device: --gamepad /dev/input/event5. It has to be on the "
           "machine that gaitctl runs on.";
  return nullptr;
}

}  // namespace gaitd::cli::teleop
