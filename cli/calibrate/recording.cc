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
constexpr double kAirborne = 0.1;     // of the weight, on both feet together
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

std::optional<Recording> read_recording(const LogReader& log, const GaitdModel& model,
                                        std::string* error) {
  const std::vector<double> time = log.column("time", error);
  const std::vector<double> phase = log.column("gait/phase", error);
  const std::vector<double> step = log.column("gait/step_index", error);
  const std::vector<double> state = log.column("safety/state", error);
  if (time.empty() || phase.empty() || step.empty() || state.empty()) return std::nullopt;
  const int standing = word_of(log, "safety/state", "standing");
  const int testing = word_of(log, "safety/state", "testing");
  const std::map<std::int64_t, int> joints = tested_joints(log, model.joint_count);
  const double weight = model.total_mass * model.gravity;
  const std::vector<int> carrying = carrying_joints(model);
  Recording recording;
  LogReader::SensorsCursor cursor = log.sensors();
  GaitdSensors sensors;
  Window window(model.joint_count);
  double begin = 0;
  int stance = -1;
  const auto close = [&](double end) {
    if (window.count == 0 || end - begin < 0.99 * kWindow) return;
    const Stillness still = window.mean(0.5 * (begin + end));
    const double left = still.foot_wrench[GAITD_LEFT][5];
    const double right = still.foot_wrench[GAITD_RIGHT][5];
    const double travel = largest(window.highest - window.lowest, carrying);
    if (std::abs(left) + std::abs(right) < kAirborne * weight && travel < kSlowTravel) {
      recording.hanging.push_back(still);
    } else if (stance >= 0 && travel < kTravel && std::min(left, right) > kLeastLoad * weight &&
               left + right > kWholeLoad * weight) {
      std::vector<Posture>& all = recording.postures;
      const bool again = !all.empty() && all.back().stance == stance &&
                         largest(all.back().position - still.position, carrying) < kNewPosture;
      if (again) all.pop_back();  // it has settled further
      all.push_back({still, stance, std::max(1.0, travel / kRest)});
    }
  };
  bool tested = false;
  while (cursor.next(&sensors)) {
    const std::size_t row = cursor.row();
    if (row >= time.size()) break;
    const bool tests = state[row] == testing && !joints.empty();
    if (tests) {
      if (!tested) {
        const auto next = joints.upper_bound(sensors.tick);
        if (next != joints.begin()) recording.tests.push_back({std::prev(next)->second, {}});
      }
      if (!recording.tests.empty()) {
        JointTest& test = recording.tests.back();
        const bool due =
            test.samples.empty() || time[row] > test.samples.back().time + 0.99 * kSampling;
        if (due) {
          test.samples.push_back(sample_of(sensors, test.joint, time[row], model.joint_count));
        }
      }
    }
    tested = tests;
    const bool stands = phase[row] == GAITD_PHASE_STAND && state[row] == standing;
    const int now = stands ? static_cast<int>(step[row]) : -1;
    if (now != stance || time[row] - begin >= kWindow) {
      close(time[row]);
      window = Window(model.joint_count);
      begin = time[row];
      stance = now;
    }
    window.add(sensors);
  }
  std::erase_if(recording.tests,
                [](const JointTest& test) { return test.samples.size() < kFewSamples; });
  return recording;
}

}  // namespace gaitd::calibrate
