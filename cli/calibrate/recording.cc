// SPDX-License-Identifier: Apache-2.0
#include "cli/calibrate/recording.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "gaitd/sdk/views.h"

namespace gaitd::calibrate {
namespace {

using daemon::LogReader;

constexpr double kWindow = 0.4;       // s, over which a reading is averaged
constexpr double kRest = 4e-3;        // rad that an encoder moves in it, robot at rest
constexpr double kTravel = 15e-3;     // rad beyond which it is of no use that the robot stands
constexpr double kSlowTravel = 0.08;  // rad, hanging
constexpr double kNewPosture = 0.02;  // rad, by which one posture differs from the next
constexpr double kAirborne = 0.1;     // of the weight, on both feet together, beside their own
constexpr double kLeastLoad = 0.15;   // of the weight, on each foot that stands
constexpr double kWholeLoad = 0.93;   // of the weight, on both: no rope carries any of it

constexpr double kSampling = 5e-3;  // s, between the samples of a joint test
constexpr std::size_t kFewSamples = 20;

struct Window {
  explicit Window(int joints)
      : position(Eigen::VectorXd::Zero(joints)),
        torque(Eigen::VectorXd::Zero(joints)),
        lowest(Eigen::VectorXd::Constant(joints, 1e9)),
        highest(Eigen::VectorXd::Constant(joints, -1e9)) {
    wrench.fill(Vector6d::Zero());
  }

  void add(const GaitdSensors& sensors) {
    for (Eigen::Index j = 0; j < position.size(); ++j) {
      const GaitdJointSensor& joint = sensors.joints[j];
      position[j] += joint.position;
      torque[j] += joint.torque;
      lowest[j] = std::min(lowest[j], joint.position);
      highest[j] = std::max(highest[j], joint.position);
    }
    force += sdk::view(sensors.imus[0].specific_force);
    for (int side = 0; side < GAITD_MAX_FEET; ++side) {
      wrench[side].head<3>() += sdk::view(sensors.feet[side].moment);
      wrench[side].tail<3>() += sdk::view(sensors.feet[side].force);
    }
    ++count;
  }

  Stillness mean(double time) const {
    Stillness s{time, position / count, torque / count, force / count, wrench};
    for (Vector6d& w : s.foot_wrench) w /= count;
    return s;
  }

  double count = 0;
  Eigen::VectorXd position, torque, lowest, highest;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  std::array<Vector6d, GAITD_MAX_FEET> wrench;
};

// N, that the ground pushes a foot up with, by a force sensor that hangs in it.
double push(const GaitdFoot& foot, const Vector6d& reading) {
  const Eigen::Vector3d force =
      sdk::quaternion(foot.force_sensor.orientation) * Eigen::Vector3d(reading.tail<3>());
  return (sdk::quaternion(foot.sole.orientation).conjugate() * force).z();
}

// Value of the word of an enumeration, -1 if the log has no such word.
int word_of(const LogReader& log, std::string_view signal, std::string_view word) {
  const int i = daemon::find_signal(log.signals(), signal);
  return i < 0 ? -1 : daemon::find_word(log.signals()[i], word);
}

// Joint that is tested from each tick on, by tick.
std::map<std::int64_t, int> tested_joints(const LogReader& log, int joint_count) {
  std::map<std::int64_t, int> joints;
  for (const daemon::Event& event : log.events()) {
    const auto text = nlohmann::json::parse(event.text, nullptr, false);
    if (!text.is_object() || text.value("command", "") != "joint.test") continue;
    const int joint = text.value("joint", -1);
    if (text.value("accepted", false) && joint >= 0 && joint < joint_count) {
      joints[event.tick] = joint;
    }
  }
  return joints;
}

JointTest::Sample sample_of(const GaitdSensors& sensors, int joint, double time, int joints) {
  JointTest::Sample sample{time, Eigen::VectorXd(joints), sensors.joints[joint].torque,
                           sdk::view(sensors.imus[0].specific_force)};
  for (int j = 0; j < joints; ++j) sample.position[j] = sensors.joints[j].position;
  return sample;
}

double largest(const Eigen::VectorXd& values, const std::vector<int>& joints) {
  double most = 0;
  for (const int j : joints) most = std::max(most, std::abs(values[j]));
  return most;
}

// Sorts what is still into readings in the air and postures.
class Sorter {
 public:
  Sorter(const GaitdModel& model, Recording* recording)
      : model_(model),
        weight_(model.total_mass * model.gravity),
        joints_(carrying_joints(model)),
        recording_(*recording) {
    for (const GaitdFoot& foot : model.feet) feet_ += model.bodies[foot.body].mass * model.gravity;
  }

  // The window ended at `end` s; the robot stood meanwhile, for the `stand`th time in this log, or
  // did not (-1).
  void take(const Window& window, double begin, double end, int stand) {
    if (window.count == 0 || end - begin < 0.99 * kWindow) return;
    const Stillness still = window.mean(0.5 * (begin + end));
    std::array<double, GAITD_MAX_FEET> load{};
    for (int side = 0; side < GAITD_MAX_FEET; ++side) {
      load[side] = push(model_.feet[side], still.foot_wrench[side]);
    }
    const double travel = largest(window.highest - window.lowest, joints_);
    const bool in_air = std::abs(load[0]) + std::abs(load[1]) < kAirborne * weight_ + feet_;
    if (in_air && travel < kSlowTravel) {
      recording_.hanging.push_back(still);
      const auto count = static_cast<double>(recording_.hanging.size());
      for (int side = 0; side < GAITD_MAX_FEET; ++side) {
        tare_[side] += (load[side] - tare_[side]) / count;
      }
      return;
    }
    if (stand < 0 || travel >= kTravel) return;
    for (int side = 0; side < GAITD_MAX_FEET; ++side) load[side] -= tare_[side];
    // Unless it was seen in the air, what hangs below the sensors is missing.
    const double missing = recording_.hanging.empty() ? feet_ : 0.0;
    if (std::min(load[0], load[1]) < kLeastLoad * weight_ ||
        load[0] + load[1] < kWholeLoad * weight_ - missing) {
      return;
    }
    std::vector<Posture>& all = recording_.postures;
    if (stand != stand_) {
      stance_ = all.empty() ? 0 : stance_ + 1;
      stand_ = stand;
    } else if (largest(all.back().position - still.position, joints_) < kNewPosture) {
      all.pop_back();  // it has settled further
    }
    all.push_back({still, stance_, std::max(1.0, travel / kRest)});
  }

 private:
  const GaitdModel& model_;
  double weight_;                              // N
  double feet_ = 0;                            // N, that may hang below the sensors
  std::vector<int> joints_;                    // that carry
  std::array<double, GAITD_MAX_FEET> tare_{};  // N, what the sensors show of feet in the air
  int stand_ = -1, stance_ = 0;                // of the last posture
  Recording& recording_;
};

// Reads one log after the other; where one ends, the next goes on.
class Reader {
 public:
  explicit Reader(const GaitdModel& model)
      : model_(model), sorter_(model, &recording_), window_(model.joint_count) {}

  bool read(const LogReader& log, std::string* error) {
    const std::vector<double> time = log.column("time", error);
    const std::vector<double> phase = log.column("gait/phase", error);
    const std::vector<double> step = log.column("gait/step_index", error);
    const std::vector<double> state = log.column("safety/state", error);
    if (time.empty() || phase.empty() || step.empty() || state.empty()) return false;
    const int standing = word_of(log, "safety/state", "standing");
    const int testing = word_of(log, "safety/state", "testing");
    const std::map<std::int64_t, int> joints = tested_joints(log, model_.joint_count);
    LogReader::SensorsCursor cursor = log.sensors();
    GaitdSensors sensors;
    while (cursor.next(&sensors)) {
      const std::size_t row = cursor.row();
      if (row >= time.size()) break;
      if (state[row] == testing) {
        test(sensors, time[row], joints);
      } else {
        testing_ = false;
      }
      stand(sensors, time[row], phase[row] == GAITD_PHASE_STAND && state[row] == standing,
            step[row]);
    }
    return true;
  }

  Recording finish() {
    std::erase_if(recording_.tests,
                  [](const JointTest& test) { return test.samples.size() < kFewSamples; });
    return recording_;
  }

 private:
  void test(const GaitdSensors& sensors, double time, const std::map<std::int64_t, int>& joints) {
    if (!testing_) {
      testing_ = true;
      const auto next = joints.upper_bound(sensors.tick);
      known_ = next != joints.begin();
      if (known_) recording_.tests.push_back({std::prev(next)->second, {}});
    }
    if (!known_) return;
    JointTest& test = recording_.tests.back();
    if (test.samples.empty() || time > test.samples.back().time + 0.99 * kSampling) {
      test.samples.push_back(sample_of(sensors, test.joint, time, model_.joint_count));
    }
  }

  void stand(const GaitdSensors& sensors, double time, bool stands, double step) {
    // It has its feet elsewhere after each step, and after each time that it did not stand.
    const bool begins = stands && (!stood_ || step != step_);
    if (begins || stands != stood_ || time - begin_ >= kWindow) {
      sorter_.take(window_, begin_, time, stood_ ? stands_ : -1);
      window_ = Window(model_.joint_count);
      begin_ = time;
    }
    if (begins) ++stands_;
    stood_ = stands;
    step_ = step;
    window_.add(sensors);
  }

  const GaitdModel& model_;
  Recording recording_;
  Sorter sorter_;
  Window window_;
  double begin_ = 0;  // s, of the window
  int stands_ = 0;    // how many times it began to stand
  bool stood_ = false;
  double step_ = 0;
  bool testing_ = false;
  bool known_ = false;  // which joint is tested
};

}  // namespace

std::vector<int> carrying_joints(const GaitdModel& model) {
  std::vector<int> joints;
  for (const GaitdLeg& leg : model.legs) {
    joints.insert(joints.end(), leg.joints, leg.joints + leg.joint_count);
  }
  for (int body = model.chest_body; body > 0; body = model.bodies[body].parent) {
    joints.push_back(model.bodies[body].joint);
  }
  return joints;
}

std::optional<Recording> read_recording(std::span<const std::unique_ptr<daemon::LogReader>> parts,
                                        const GaitdModel& model, std::string* error) {
  Reader reader(model);
  for (const auto& part : parts) {
    if (!reader.read(*part, error)) return std::nullopt;
  }
  return reader.finish();
}

}  // namespace gaitd::calibrate
