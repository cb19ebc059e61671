// SPDX-License-Identifier: Apache-2.0
// Gamepads by recorded events, and by devices that libevdev describes.
#include "cli/teleop/pad.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#ifdef GAITD_LIBEVDEV
#include <libevdev/libevdev-uinput.h>
#include <libevdev/libevdev.h>
#include <poll.h>
#endif

namespace gaitd::cli::teleop {
namespace {

using Keys = std::vector<Key>;

input_event event(int type, int code, int value) {
  input_event result{};
  result.type = static_cast<unsigned short>(type);
  result.code = static_cast<unsigned short>(code);
  result.value = value;
  return result;
}

TEST(PadState, MovesOnlyWhileTheDeadMansButtonIsHeld) {
  PadState state({});
  state.take(event(EV_ABS, ABS_Y, -32768));
  EXPECT_FALSE(state.held());
  EXPECT_TRUE(state.motion().still());
  state.take(event(EV_KEY, BTN_TL, 1));
  EXPECT_TRUE(state.held());
  EXPECT_NEAR(state.motion().forward, 1.0, 1e-9);
  state.take(event(EV_KEY, BTN_TL, 0));
  EXPECT_FALSE(state.held());
  EXPECT_TRUE(state.motion().still());
}

TEST(PadState, UpAndLeftArePositive) {
  PadState state({});
  state.take(event(EV_KEY, BTN_TL, 1));
  state.take(event(EV_ABS, ABS_X, -32768));
  EXPECT_NEAR(state.motion().lateral, 1.0, 1e-9);
  state.take(event(EV_ABS, ABS_X, 32767));
  EXPECT_NEAR(state.motion().lateral, -1.0, 1e-9);
  state.take(event(EV_ABS, ABS_RX, -32768));
  EXPECT_NEAR(state.motion().turn, 1.0, 1e-9);
  state.take(event(EV_ABS, ABS_Y, 32767));
  EXPECT_NEAR(state.motion().forward, -1.0, 1e-9);
}

TEST(PadState, RestsInTheDeadZoneAndGoesOnFromThereWithoutAJump) {
  PadState state({});
  state.take(event(EV_KEY, BTN_TL, 1));
  state.take(event(EV_ABS, ABS_Y, -3900));
  EXPECT_TRUE(state.motion().still());
  state.take(event(EV_ABS, ABS_Y, -4000));
  EXPECT_GT(state.motion().forward, 0.0);
  EXPECT_LT(state.motion().forward, 0.01);
}

TEST(PadState, TakesRangeAndRestOfTheAxis) {
  PadAxes axes;
  axes.forward = {ABS_Y, 0, 255, 64};
  PadState state(axes);
  state.take(event(EV_KEY, BTN_TL, 1));
  for (const int rest : {66, 127, 128, 190}) {
    state.take(event(EV_ABS, ABS_Y, rest));
    EXPECT_TRUE(state.motion().still()) << rest;
  }
  state.take(event(EV_ABS, ABS_Y, 0));
  EXPECT_NEAR(state.motion().forward, 1.0, 1e-9);
  axes.forward = {ABS_Y, 5, 5, 0};  // a device that says nothing
  PadState broken(axes);
  broken.take(event(EV_KEY, BTN_TL, 1));
  broken.take(event(EV_ABS, ABS_Y, 5));
  EXPECT_TRUE(broken.motion().still());
}

TEST(PadState, ButtonsAreKeysOnceForEachPress) {
  PadState state({});
  for (const int code : {BTN_EAST, BTN_SOUTH, BTN_START, BTN_SELECT, BTN_WEST}) {
    state.take(event(EV_KEY, code, 1));
    state.take(event(EV_KEY, code, 0));
  }
  state.take(event(EV_ABS, ABS_HAT0Y, -1));
  state.take(event(EV_ABS, ABS_HAT0Y, 0));
  state.take(event(EV_ABS, ABS_HAT0Y, 1));
  EXPECT_EQ(state.pressed(),
            (Keys{Key::kEstop, Key::kStop, Key::kArm, Key::kReset, Key::kFaster, Key::kSlower}));
  EXPECT_EQ(state.pressed(), Keys{});
}

TEST(PadState, LostEventsLetGo) {
  PadState state({});
  state.take(event(EV_KEY, BTN_TL, 1));
  state.take(event(EV_ABS, ABS_Y, -32768));
  state.take(event(EV_SYN, SYN_DROPPED, 0));
  EXPECT_FALSE(state.held());
  state.take(event(EV_KEY, BTN_TL, 1));  // of the report that is not whole
  EXPECT_FALSE(state.held());
  state.take(event(EV_SYN, SYN_REPORT, 0));
  state.take(event(EV_KEY, BTN_TL, 1));
  EXPECT_TRUE(state.held());
}

// A recording on a pipe.
class Recording : public ::testing::Test {
 protected:
  Recording() {
    EXPECT_EQ(pipe2(ends_, O_NONBLOCK), 0);
    pad_ = std::make_unique<Pad>("recording", PadAxes{}, std::make_unique<EventStream>(ends_[0]));
  }
  ~Recording() override { unplug(); }
  void play(const void* bytes, std::size_t count) {
    ASSERT_EQ(write(ends_[1], bytes, count), static_cast<ssize_t>(count));
    pad_->read();
  }
  void play(const input_event& one) { play(&one, sizeof(one)); }
  void unplug() {
    if (ends_[1] >= 0) close(ends_[1]);
    ends_[1] = -1;
  }

  int ends_[2] = {-1, -1};
  std::unique_ptr<Pad> pad_;
};

TEST_F(Recording, DrivesUntilItEnds) {
  play(event(EV_KEY, BTN_TL, 1));
  play(event(EV_ABS, ABS_Y, -32768));
  play(event(EV_SYN, SYN_REPORT, 0));
  EXPECT_NEAR(pad_->state().motion().forward, 1.0, 1e-9);
  unplug();
  pad_->read();
  EXPECT_TRUE(pad_->gone());
  EXPECT_EQ(pad_->fd(), -1);
  EXPECT_FALSE(pad_->state().held());
  EXPECT_TRUE(pad_->state().motion().still());
}

TEST_F(Recording, AnEventMayComeInPieces) {
  const input_event press = event(EV_KEY, BTN_TL, 1);
  play(&press, 5);
  EXPECT_FALSE(pad_->state().held());
  play(reinterpret_cast<const char*>(&press) + 5, sizeof(press) - 5);
  EXPECT_TRUE(pad_->state().held());
}

TEST(Pad, SaysWhyThereIsNone) {
  std::string error;
  EXPECT_EQ(open_pad("/dev/null", &error), nullptr);
  EXPECT_FALSE(error.empty());
  if (!has_pads()) return;
  EXPECT_NE(error.find("/dev/null: no input device"), std::string::npos) << error;
  EXPECT_EQ(open_pad("/dev/input/none", &error), nullptr);
  EXPECT_NE(error.find("No such file"), std::string::npos) << error;
}

#ifdef GAITD_LIBEVDEV
// A described device, as libevdev has it of a real one.
class Device {
 public:
  Device() : device_(libevdev_new()) { libevdev_set_name(device_, "gaitd test pad"); }
  ~Device() { libevdev_free(device_); }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  Device& key(unsigned code) {
    libevdev_enable_event_type(device_, EV_KEY);
    libevdev_enable_event_code(device_, EV_KEY, code, nullptr);
    return *this;
  }
  Device& axis(unsigned code, int minimum, int maximum, int flat) {
    input_absinfo info{};
    info.minimum = minimum;
    info.maximum = maximum;
    info.flat = flat;
    libevdev_enable_event_type(device_, EV_ABS);
    libevdev_enable_event_code(device_, EV_ABS, code, &info);
    return *this;
  }
  libevdev* get() const { return device_; }

 private:
  libevdev* device_;
};

TEST(LibevdevPad, ADeviceIsAGamepadIfItCanMoveAndStopTheRobot) {
  Device mouse;
  mouse.key(BTN_LEFT);
  EXPECT_NE(lacks(mouse.get()).find("no stick"), std::string::npos);
  Device pad;
  pad.axis(ABS_X, -100, 100, 3).axis(ABS_Y, 0, 255, 15);
  EXPECT_NE(lacks(pad.get()).find("BTN_TL"), std::string::npos);
  pad.key(BTN_TL);
  EXPECT_NE(lacks(pad.get()).find("BTN_EAST"), std::string::npos);
  pad.key(BTN_EAST);
  EXPECT_EQ(lacks(pad.get()), "");
}

TEST(LibevdevPad, TakesTheRangesOfTheDevice) {
  Device device;
  device.axis(ABS_X, -100, 100, 3).axis(ABS_Y, 0, 255, 15).axis(ABS_Z, 0, 1023, 63);
  PadAxes axes = axes_of(device.get());
  EXPECT_EQ(axes.lateral.code, ABS_X);
  EXPECT_EQ(axes.lateral.minimum, -100);
  EXPECT_EQ(axes.forward.maximum, 255);
  EXPECT_EQ(axes.forward.flat, 15);
  EXPECT_EQ(axes.turn.code, ABS_Z) << "the right stick of some";
  device.axis(ABS_RX, -32768, 32767, 128);
  axes = axes_of(device.get());
  EXPECT_EQ(axes.turn.code, ABS_RX);
  PadState state(axes);
  state.take(event(EV_KEY, BTN_TL, 1));
  state.take(event(EV_ABS, ABS_Y, 0));
  state.take(event(EV_ABS, ABS_X, 100));
  EXPECT_NEAR(state.motion().forward, 1.0, 1e-9);
  EXPECT_NEAR(state.motion().lateral, -1.0, 1e-9);
}

// Through the kernel, where it lets us make a device.
TEST(LibevdevPad, IsReadFromTheKernelUntilItIsUnplugged) {
  Device device;
  device.axis(ABS_X, -32768, 32767, 128).axis(ABS_Y, -32768, 32767, 128);
  device.axis(ABS_RX, -32768, 32767, 128).key(BTN_TL).key(BTN_EAST).key(BTN_SOUTH);
  libevdev_uinput* made = nullptr;
  if (libevdev_uinput_create_from_device(device.get(), LIBEVDEV_UINPUT_OPEN_MANAGED, &made) != 0) {
    GTEST_SKIP() << "this machine lets nobody make input devices: no /dev/uinput";
  }
  const char* node = libevdev_uinput_get_devnode(made);
  ASSERT_NE(node, nullptr);
  std::string error;
  std::unique_ptr<Pad> pad;
  for (int i = 0; i < 100 && !pad; ++i, usleep(20000)) pad = open_pad(node, &error);  // by udev
  ASSERT_TRUE(pad) << error;
  EXPECT_EQ(pad->name(), "gaitd test pad");
  libevdev_uinput_write_event(made, EV_ABS, ABS_Y, -32768);
  libevdev_uinput_write_event(made, EV_KEY, BTN_TL, 1);
  libevdev_uinput_write_event(made, EV_SYN, SYN_REPORT, 0);
  for (int i = 0; i < 100 && !pad->state().held(); ++i, usleep(20000)) pad->read();
  EXPECT_NEAR(pad->state().motion().forward, 1.0, 1e-9);
  libevdev_uinput_destroy(made);
  for (int i = 0; i < 100 && !pad->gone(); ++i, usleep(20000)) pad->read();
  EXPECT_TRUE(pad->gone());
  EXPECT_FALSE(pad->state().held());
}
#endif

}  // namespace
}  // namespace gaitd::cli::teleop
