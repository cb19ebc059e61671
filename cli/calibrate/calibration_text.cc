// SPDX-License-Identifier: Apache-2.0
#include "cli/calibrate/calibration_text.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "cli/doctor/finding.h"

namespace gaitd::calibrate {
namespace {

using daemon::JointCalibration;
using doctor::format;

constexpr const char* kSides[] = {"left", "right"};
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kSaid = 0.3;             // of the largest coefficient, that is worth telling
constexpr double kLeastStiffness = 0.25;  // by moment_scale()
constexpr double kLargestStiffness = 5e3;
constexpr double kLargestZero = 0.2;  // rad

double sigma_of(const Zeros& zeros, std::size_t i) {
  const auto k = static_cast<Eigen::Index>(i);
  return std::sqrt(zeros.covariance(k, k));
}

std::string vector_text(const std::array<double, 3>& v) {
  return format("[%.4f, %.4f, %.4f]", v[0], v[1], v[2]);
}

std::string friction_text(double bias, double coulomb, double viscous) {
  return format(", torque_bias: %.4g, coulomb: %.4g, viscous: %.4g", bias, coulomb, viscous);
}

// The joints that a sum is mostly made of: "l_leg_hpy + r_leg_hpy - 0.5 back_bky".
std::string sum_text(const GaitdModel& model, const Zeros& zeros, const Unobservable& sum) {
  double largest = 0;
  for (const double c : sum.coefficients) {
    if (std::abs(c) > std::abs(largest)) largest = c;
  }
  std::string text;
  for (std::size_t i = 0; i < sum.coefficients.size(); ++i) {
    const double c = sum.coefficients[i] / largest;
    if (std::abs(c) < kSaid) continue;
    const char* sign = c < 0 ? (text.empty() ? "-" : " - ") : (text.empty() ? "" : " + ");
    text += sign;
    if (std::abs(c) < 0.95) text += format("%.1f ", std::abs(c));
    text += model.joints[zeros.joints[i]].name;
  }
  return text;
}

// What would tell: the joint that the sum holds most of.
std::string help_text(const GaitdModel& model, const Zeros& zeros, const Unobservable& sum) {
  const auto most = std::max_element(sum.coefficients.begin(), sum.coefficients.end(),
                                     [](double a, double b) { return std::abs(a) < std::abs(b); });
  const auto i = static_cast<std::size_t>(most - sum.coefficients.begin());
  return std::string("hold ") + model.joints[zeros.joints[i]].name +
         " at a stop or in a jig of known angle, or measure how the IMU is mounted";
}

}  // namespace

std::string calibration_yaml(const GaitdModel& model, const Result& result,
                             const std::string& source) {
  const Identified& found = result.identified;
  const Zeros& zeros = found.zeros;
  const double moment = moment_scale(model);
  std::string text = "# Measured by gaitctl calibrate on " + source +
                     ".\nschema: gaitd.calibration/1\nrobot: " + std::string(model.name) +
                     "\njoints:\n";
  for (std::size_t i = 0; i < zeros.joints.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double zero = std::clamp(zeros.value[k], -kLargestZero, kLargestZero);
    text += format("  %s: {zero: %.5f", model.joints[zeros.joints[i]].name, zero);
    const double compliance = found.compliance[i];
    if (compliance * moment > 1 / kLargestStiffness) {
      text += format(", stiffness: %.0f", std::max(kLeastStiffness * moment, 1 / compliance));
    }
    const DriveErrors& drive = result.drives[static_cast<std::size_t>(zeros.joints[i])];
    if (drive.measured) text += friction_text(drive.bias, drive.coulomb, drive.viscous);
    text += format("}  # +-%.5f\n", sigma_of(zeros, i));
  }
  for (int j = 0; j < model.joint_count; ++j) {
    const daemon::JointCalibration& kind = result.known.joints[j];
    if (std::ranges::find(zeros.joints, j) != zeros.joints.end() || kind == JointCalibration()) {
      continue;
    }
    text += format("  %s: {zero: %.5f", model.joints[j].name, kind.zero);
    if (kind.stiffness > 0) text += format(", stiffness: %.0f", kind.stiffness);
    text += friction_text(kind.torque_bias, kind.coulomb, kind.viscous) + "}  # not measured\n";
  }
  text += "feet:\n";
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const daemon::FootCalibration& foot = result.feet[side].value;
    text += format("  %s:\n    mass: %.3f\n", kSides[side], foot.mass);
    text += "    com: " + vector_text(foot.com) + "\n    force: " + vector_text(foot.force) +
            "\n    moment: " + vector_text(foot.moment) + "\n";
  }
  text += "covariance:  # of the zeros, rad^2\n  joints: [";
  for (std::size_t i = 0; i < zeros.joints.size(); ++i) {
    text += (i > 0 ? ", " : "") + std::string(model.joints[zeros.joints[i]].name);
  }
  text += "]\n  zeros:\n";
  for (Eigen::Index r = 0; r < zeros.covariance.rows(); ++r) {
    text += "    - [";
    for (Eigen::Index c = 0; c < zeros.covariance.cols(); ++c) {
      text += format("%s%.3g", c > 0 ? ", " : "", zeros.covariance(r, c));
    }
    text += "]\n";
  }
  return text;
}

std::string summary(const GaitdModel& model, const Result& result) {
  const Identified& found = result.identified;
  const Zeros& zeros = found.zeros;
  std::string text = format("%d postures, %d readings in the air; misfit %.2f (1: as expected)\n",
                            found.postures, result.hanging, found.misfit);
  for (std::size_t i = 0; i < zeros.joints.size(); ++i) {
    text +=
        format("  %-12s zero %+7.3f deg +-%.3f", model.joints[zeros.joints[i]].name,
               zeros.value[static_cast<Eigen::Index>(i)] / kDegree, sigma_of(zeros, i) / kDegree);
    const double compliance = found.compliance[i];
    if (compliance * moment_scale(model) > 1 / kLargestStiffness) {
      text += format("   stiffness %6.0f N m/rad +-%.0f %%", 1 / compliance,
                     100 * found.compliance_sigma[i] / compliance);
    }
    const DriveErrors& drive = result.drives[static_cast<std::size_t>(zeros.joints[i])];
    if (drive.measured) {
      text +=
          format("   bias %+5.1f N m +-%.1f, friction %.1f N m +-%.1f and %.1f N m s/rad +-%.1f",
                 drive.bias, drive.bias_sigma, drive.coulomb, drive.coulomb_sigma, drive.viscous,
                 drive.viscous_sigma);
    }
    text += "\n";
  }
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const FootOffset& foot = result.feet[side];
    text += format("  %s foot: %.2f kg below the sensor, offset %s N +-%.2f, %s N m +-%.3f\n",
                   kSides[side], foot.value.mass, vector_text(foot.value.force).c_str(),
                   foot.force_sigma.maxCoeff(), vector_text(foot.value.moment).c_str(),
                   foot.moment_sigma.maxCoeff());
  }
  const Eigen::Vector3d& imu = found.accelerometer;
  text += format("  the IMU reads [%.3f, %.3f, %.3f] m/s^2 too much\n", imu.x(), imu.y(), imu.z());
  for (const Unobservable& sum : found.unobservable) {
    text += format("not observable, still +-%.2f deg: ", sum.sigma / kDegree) +
            sum_text(model, zeros, sum) + "; " + help_text(model, zeros, sum) + "\n";
  }
  return text;
}

nlohmann::json summary_json(const GaitdModel& model, const Result& result) {
  using nlohmann::json;
  const Identified& found = result.identified;
  json joints = json::object();
  for (std::size_t i = 0; i < found.zeros.joints.size(); ++i) {
    joints[model.joints[found.zeros.joints[i]].name] = {
        {"zero", found.zeros.value[static_cast<Eigen::Index>(i)]},
        {"zero_sigma", sigma_of(found.zeros, i)},
        {"compliance", found.compliance[i]},
        {"compliance_sigma", found.compliance_sigma[i]}};
    const DriveErrors& drive = result.drives[static_cast<std::size_t>(found.zeros.joints[i])];
    if (!drive.measured) continue;
    joints[model.joints[found.zeros.joints[i]].name].update(
        {{"torque_bias", drive.bias},
         {"torque_bias_sigma", drive.bias_sigma},
         {"coulomb", drive.coulomb},
         {"coulomb_sigma", drive.coulomb_sigma},
         {"viscous", drive.viscous},
         {"viscous_sigma", drive.viscous_sigma}});
  }
  json sums = json::array();
  for (const Unobservable& sum : found.unobservable) {
    json coefficients = json::object();
    for (std::size_t i = 0; i < sum.coefficients.size(); ++i) {
      coefficients[model.joints[found.zeros.joints[i]].name] = sum.coefficients[i];
    }
    sums.push_back({{"sigma", sum.sigma}, {"coefficients", coefficients}});
  }
  json feet = json::object();
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const daemon::FootCalibration& foot = result.feet[side].value;
    feet[kSides[side]] = {{"mass", foot.mass},
                          {"com", foot.com},
                          {"force", foot.force},
                          {"moment", foot.moment},
                          {"force_sigma", result.feet[side].force_sigma.maxCoeff()},
                          {"moment_sigma", result.feet[side].moment_sigma.maxCoeff()}};
  }
  return {{"postures", found.postures},
          {"hanging", result.hanging},
          {"misfit", found.misfit},
          {"joints", joints},
          {"feet", feet},
          {"unobservable", sums}};
}

}  // namespace gaitd::calibrate
