// SPDX-License-Identifier: Apache-2.0
// A shipped layer that goes wrong at a time, in a way that its parameters choose, or without them
// the environment: GAITD_TEST_FAULT and GAITD_TEST_FAULT_TIME.
#include FAULTY_HEADER

#include <time.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace {

enum class Fault { kNone, kNan, kError, kThrow, kSize, kSlow, kCrash, kDiverge, kHang };

class FaultyLayer : public FAULTY_CLASS {
 public:
  using Traits = gaitd::sdk::LayerTraits<FAULTY_LAYER>;
  static constexpr std::array<GaitdParameter, 2> kParameters = {
      gaitd::sdk::integer_parameter("fault", "", 0, 8, 0, "what goes wrong"),
      gaitd::sdk::real_parameter("fault_time", "s", 0, 1000, 0.7, "from when on")};

  explicit FaultyLayer(const GaitdModel& model) : FAULTY_CLASS(model) {}
  void set_parameter(int index, double value) {
    if (index == 0) fault_ = static_cast<Fault>(value);
    if (index == 1) time_ = value;
    const char* fault = std::getenv("GAITD_TEST_FAULT");
    const char* time = std::getenv("GAITD_TEST_FAULT_TIME");
    if (fault != nullptr) fault_ = static_cast<Fault>(std::atoi(fault));
    if (time != nullptr) time_ = std::atof(time);
  }
  GaitdStatus process(const Traits::Input& in, Traits::Output& out) {
    const GaitdStatus status = FAULTY_CLASS::process(in, out);
    if (in.time.time < time_) return status;
    switch (fault_) {
      case Fault::kNan:
        spoil(out);
        break;
      case Fault::kError:
        return GAITD_ERROR;
      case Fault::kThrow:
        throw std::runtime_error("out of luck");
      case Fault::kSize:
        out.size = 8;
        break;
      case Fault::kSlow:
        spend(0.004);
        break;
      case Fault::kDiverge:
        drift(in.time.time - time_, out);
        break;
      case Fault::kCrash:
        std::raise(SIGSEGV);
        break;
      case Fault::kHang:
        pause();  // for ever
        break;
      default:
        break;
    }
    return status;
  }

 private:
  static constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  static void spoil(GaitdRobotState& out) { out.joint_velocity[3] = kNan; }
  static void spoil(GaitdIcpPlan& out) { out.icp[1] = kNan; }
  static void spoil(GaitdStepAdjustment& out) { out.linear_momentum_rate[0] = kNan; }
  static void spoil(GaitdToeOff& out) { out.criterion[2] = kNan; }
  static void spoil(GaitdWholeBodyControllerOutput& out) { out.commands.joints[2].torque = kNan; }
  static void spoil(GaitdTaskReferences& out) { out.com_shift[0] = kNan; }
  static void drift(double time, GaitdRobotState& out) { out.pelvis_position[0] += time; }
  static void drift(double time, GaitdIcpPlan& out) { out.icp[0] -= time; }
  static void drift(double time, GaitdStepAdjustment& out) {
    out.linear_momentum_rate[1] += 2000.0 * time;
    out.cmp[1] -= time;
  }
  static void drift(double, GaitdToeOff&) {}
  static void drift(double time, GaitdTaskReferences& out) { out.com_shift[1] += time; }
  static void drift(double time, GaitdWholeBodyControllerOutput& out) {
    out.commands.joints[0].torque += 1000.0 * time;
  }
  static void spend(double seconds) {
    timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    const double end = static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
    do {
      clock_gettime(CLOCK_MONOTONIC, &t);
    } while (static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec) < end + seconds);
  }

  Fault fault_ = Fault::kNone;
  double time_ = 0.7;
};

}  // namespace

GAITD_EXPORT_LAYER(FaultyLayer, FAULTY_LAYER, "faulty", "1.0.0", 1000.0)
