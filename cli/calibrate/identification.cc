// SPDX-License-Identifier: Apache-2.0
#include "cli/calibrate/identification.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "gaitd/dynamics/dynamics.h"
#include "gaitd/sdk/views.h"

namespace gaitd::calibrate {
namespace {

using Eigen::MatrixXd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;

// Standard deviations of what a still robot shows.
constexpr double kPlaceSigma = 5e-4;    // m, of one foot against the other
constexpr double kTurnSigma = 5e-4;     // rad, likewise
constexpr double kForceSigma = 0.012;   // m/s^2, of the averaged IMU
constexpr double kBalanceSigma = 2e-3;  // m, of the centre of mass against the centre of pressure
// Of unknowns that are not asked for.
constexpr double kScaleSigma = 0.01;     // of the force sensors
constexpr double kPressureSigma = 1e-3;  // m, of a foot's centre of pressure
constexpr double kRollGive = 1.6;        // rad, of a sole in the ground, by moment_scale()
constexpr double kPitchGive = 0.6;
constexpr double kSinking = 2.2e-3;  // of the height of the centre of mass, under the weight
constexpr double kAnywhere = 1.0;    // m, rad: where the feet stand
constexpr double kHuber = 3.0;       // standard deviations beyond which a residual counts less
constexpr int kIterations = 12;
constexpr double kShareToKnow = 0.4;  // of the prior, beyond which nothing was learned

constexpr int kResiduals = 11;  // of a posture: place 3, turn 3, IMU 3, balance 2

// Places of the unknowns in one vector.
struct Layout {
  std::vector<int> joints;
  int stances = 0;

  int count() const { return stance(stances); }
  int joint_count() const { return static_cast<int>(joints.size()); }
  int zero(int i) const { return i; }
  int compliance(int i) const { return joint_count() + i; }
  int accelerometer() const { return 2 * joint_count(); }
  int chest() const { return accelerometer() + 3; }
  int scale() const { return chest() + 3; }
  int pressure(int side) const { return scale() + 2 + 2 * side; }
  int give() const { return pressure(GAITD_MAX_FEET); }  // roll, pitch, sinking
  // Place and turn of the right foot in the left one, tilt of the ground under the left one.
  int stance(int s) const { return give() + 3 + 8 * s; }
};

Layout layout_of(const GaitdModel& model, const Recording& recording) {
  Layout layout;
  layout.joints = carrying_joints(model);
  for (const Posture& p : recording.postures) {
    layout.stances = std::max(layout.stances, p.stance + 1);
  }
  return layout;
}

class Problem {
 public:
  Problem(const GaitdModel& model, const daemon::Calibration& known, const Recording& recording,
          const Prior& prior)
      : model_(model),
        known_(known),
        recording_(recording),
        layout_(layout_of(model, recording)),
        dynamics_(model) {
    set_prior(prior);
    for (const Posture& posture : recording.postures) torques_.push_back(posture.torque);
  }

  const Layout& layout() const { return layout_; }
  const VectorXd& mean() const { return mean_; }
  const VectorXd& sigma() const { return sigma_; }

  // What bends the joints is what the contact forces and the weight ask of them. The drives do not
  // know of their friction, the force sensors tell.
  void balance(const VectorXd& x) {
    for (std::size_t i = 0; i < torques_.size(); ++i) torques_[i] = static_torque(i, x);
  }

  // Of every posture, in standard deviations.
  VectorXd residuals(const VectorXd& x) {
    const std::size_t count = recording_.postures.size();
    VectorXd all(kResiduals * static_cast<Eigen::Index>(count));
    for (std::size_t i = 0; i < count; ++i) {
      all.segment<kResiduals>(kResiduals * static_cast<Eigen::Index>(i)) = residual(i, x);
    }
    return all;
  }

  MatrixXd jacobian(const VectorXd& x) {
    MatrixXd j(kResiduals * static_cast<Eigen::Index>(recording_.postures.size()), x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const double step = 1e-3 * sigma_[i];
      VectorXd ahead = x, behind = x;
      ahead[i] += step;
      behind[i] -= step;
      j.col(i) = (residuals(ahead) - residuals(behind)) / (2 * step);
    }
    return j;
  }

  // Starts the feet where the first posture of each stance has them.
  VectorXd start() {
    VectorXd x = mean_;
    for (int s = layout_.stances; s-- > 0;) {
      for (std::size_t i = 0; i < recording_.postures.size(); ++i) {
        const Posture& posture = recording_.postures[i];
        if (posture.stance != s) continue;
        update(i, x);
        const Ground left = ground(GAITD_LEFT, posture, x);
        const Ground right = ground(GAITD_RIGHT, posture, x);
        x.segment<3>(layout_.stance(s)) = left.R.transpose() * (right.p - left.p);
        x.segment<3>(layout_.stance(s) + 3) =
            sdk::log_so3(Quaterniond(left.R.transpose() * right.R));
        break;
      }
    }
    return x;
  }

 private:
  // The ground under a sole, in the pelvis frame.
  struct Ground {
    Eigen::Matrix3d R;
    Vector3d p;
  };
  struct Load {  // of the ground on the foot, about the sole, pelvis axes
    Vector3d moment, force;
  };

  void set_prior(const Prior& prior) {
    mean_ = VectorXd::Zero(layout_.count());
    sigma_ = VectorXd::Constant(layout_.count(), prior.ground);
    const double moment = moment_scale(model_);
    for (int i = 0; i < layout_.joint_count(); ++i) {
      const double stiffness = known_.joints[layout_.joints[i]].stiffness;
      mean_[layout_.zero(i)] = known_.joints[layout_.joints[i]].zero;
      sigma_[layout_.zero(i)] = prior.zero;
      mean_[layout_.compliance(i)] = stiffness > 0 ? 1 / stiffness : 0.0;
      sigma_[layout_.compliance(i)] =
          stiffness > 0 ? prior.compliance / stiffness : prior.unknown / moment;
    }
    sigma_.segment<3>(layout_.accelerometer()).setConstant(prior.accelerometer);
    sigma_.segment<3>(layout_.chest()).setConstant(prior.chest_com);
    sigma_.segment<2>(layout_.scale()).setConstant(kScaleSigma);
    for (int side = 0; side < GAITD_MAX_FEET; ++side) {
      sigma_.segment<2>(layout_.pressure(side)).setConstant(kPressureSigma);
    }
    sigma_.segment<3>(layout_.give()) << kRollGive / moment, kPitchGive / moment,
        kSinking * model_.nominal_com_height / (model_.total_mass * model_.gravity);
    for (int s = 0; s < layout_.stances; ++s) {
      // Where the feet stand and how they are turned is free; the ground is even and level.
      sigma_.segment<2>(layout_.stance(s)).setConstant(kAnywhere);
      sigma_[layout_.stance(s) + 5] = kAnywhere;
    }
  }

  // rad, of the links.
  VectorXd angles(std::size_t index, const VectorXd& x) const {
    VectorXd q = recording_.postures[index].position;
    for (int i = 0; i < layout_.joint_count(); ++i) {
      const int joint = layout_.joints[i];
      q[joint] -= x[layout_.zero(i)] + x[layout_.compliance(i)] * torques_[index][joint];
    }
    return q;
  }

  void update(std::size_t index, const VectorXd& x) {
    const VectorXd q = angles(index, x);
    dynamics_.update(Vector3d::Zero(), Quaterniond::Identity(), Vector6d::Zero(), q,
                     VectorXd::Zero(q.size()));
  }

  VectorXd static_torque(std::size_t index, const VectorXd& x) {
    const Posture& posture = recording_.postures[index];
    update(index, x);
    const Eigen::Matrix3d level = ground(GAITD_LEFT, posture, x).R.transpose();
    std::array<dynamics::ExternalWrench, GAITD_MAX_FEET> wrenches;
    for (int side = 0; side < GAITD_MAX_FEET; ++side) {
      const Load l = load(side, posture, x);
      wrenches[side].body = model_.feet[side].body;
      wrenches[side].p_BF = sdk::view(model_.feet[side].sole.origin);
      wrenches[side].wrench << level * l.moment, level * l.force;
    }
    const VectorXd q = angles(index, x);
    dynamics_.update(Vector3d::Zero(), Quaterniond(level), Vector6d::Zero(), q,
                     VectorXd::Zero(q.size()));
    VectorXd torque(dynamics_.velocity_size());
    dynamics_.inverse_dynamics(VectorXd::Zero(dynamics_.velocity_size()), wrenches, torque);
    return torque.tail(q.size());
  }

  Load load(int side, const Posture& posture, const VectorXd& x) const {
    const GaitdFoot& foot = model_.feet[side];
    const daemon::FootCalibration& own = known_.feet[side];
    const Eigen::Matrix3d& R = dynamics_.R_WB(foot.body);
    const Quaterniond turn = sdk::quaternion(foot.force_sensor.orientation);
    const double scale = 1 - x[layout_.scale() + side];
    const Vector6d& reading = posture.foot_wrench[side];
    // Without the foot below the sensor; its sole is level.
    const Eigen::Matrix3d sole = sdk::quaternion(foot.sole.orientation).toRotationMatrix();
    const Vector3d weight = own.mass * model_.gravity * sole.col(2);
    const Vector3d arm = Vector3d(own.com.data()) - sdk::view(foot.force_sensor.origin);
    Load l;
    l.force = scale * (turn * (reading.tail<3>() - Vector3d(own.force.data()))) + weight;
    l.moment =
        scale * (turn * (reading.head<3>() - Vector3d(own.moment.data()))) + arm.cross(weight);
    const Vector3d to_sensor = sdk::view(foot.force_sensor.origin) - sdk::view(foot.sole.origin);
    l.moment += to_sensor.cross(l.force);
    const auto off = x.segment<2>(layout_.pressure(side));
    l.moment += (sole.leftCols<2>() * off).cross(sole.col(2) * sole.col(2).dot(l.force));
    return {R * l.moment, R * l.force};
  }

  Ground ground(int side, const Posture& posture, const VectorXd& x) const {
    const GaitdFoot& foot = model_.feet[side];
    const Eigen::Matrix3d R =
        dynamics_.R_WB(foot.body) * sdk::quaternion(foot.sole.orientation).toRotationMatrix();
    const Load l = load(side, posture, x);
    const auto give = x.segment<3>(layout_.give());
    const Vector3d moment = R.transpose() * l.moment;
    const double force = R.col(2).dot(l.force);
    // The edge that bears more sinks in more: the sole turns against the moment of the ground.
    const Vector3d tilt(-give[0] * moment.x(), -give[1] * moment.y(), 0);
    Ground g;
    g.R = R * sdk::exp_so3(tilt).toRotationMatrix().transpose();
    g.p = dynamics_.frame_position(foot.body, sdk::view(foot.sole.origin)) +
          R.col(2) * (give[2] * force);
    return g;
  }

  Eigen::Matrix<double, kResiduals, 1> residual(std::size_t index, const VectorXd& x) {
    const Posture& posture = recording_.postures[index];
    update(index, x);
    const Ground left = ground(GAITD_LEFT, posture, x);
    const Ground right = ground(GAITD_RIGHT, posture, x);
    const int s = layout_.stance(posture.stance);
    Eigen::Matrix<double, kResiduals, 1> r;
    r.segment<3>(0) = (left.R.transpose() * (right.p - left.p) - x.segment<3>(s)) / kPlaceSigma;
    const Quaterniond turn(left.R.transpose() * right.R);
    r.segment<3>(3) =
        sdk::log_so3(sdk::exp_so3(Vector3d(x.segment<3>(s + 3))).conjugate() * turn) / kTurnSigma;
    // Level axes, as the ground under the left foot says.
    const Eigen::Matrix3d level =
        left.R * sdk::exp_so3(Vector3d(x[s + 6], x[s + 7], 0)).toRotationMatrix().transpose();
    const GaitdFrame& imu = model_.imus[0];
    const Eigen::Matrix3d R_imu =
        dynamics_.R_WB(imu.body) * sdk::quaternion(imu.orientation).toRotationMatrix();
    r.segment<3>(6) = (posture.specific_force - x.segment<3>(layout_.accelerometer()) -
                       R_imu.transpose() * level.col(2) * model_.gravity) /
                      kForceSigma;
    const int chest = std::max(0, model_.chest_body);
    const Vector3d com =
        dynamics_.com() + model_.bodies[chest].mass / model_.total_mass *
                              (dynamics_.R_WB(chest) * x.segment<3>(layout_.chest()));
    Vector3d moment = Vector3d::Zero();
    Vector3d force = Vector3d::Zero();
    for (int side = 0; side < GAITD_MAX_FEET; ++side) {
      const Load l = load(side, posture, x);
      const Vector3d sole = dynamics_.frame_position(model_.feet[side].body,
                                                     sdk::view(model_.feet[side].sole.origin));
      moment += l.moment + (sole - com).cross(l.force);
      force += l.force;
    }
    r.segment<2>(9) = (level.transpose() * moment).head<2>() / force.norm() / kBalanceSigma;
    return r / posture.unrest;
  }

  const GaitdModel model_;
  const daemon::Calibration known_;
  const Recording& recording_;
  const Layout layout_;
  dynamics::Dynamics dynamics_;
  std::vector<VectorXd> torques_;  // of each posture, N m
  VectorXd mean_, sigma_;
};

// Huber's weights of residuals in standard deviations.
VectorXd weights(const VectorXd& residuals) {
  return residuals.unaryExpr(
      [](double r) { return std::abs(r) <= kHuber ? 1.0 : kHuber / std::abs(r); });
}

// The priors alone would share out between zeros and all else what the recording says only of both
// together. Instead the sums of zeros of which nothing was learned are put back to what they were,
// and all else follows: what was seen of both together stays right.
std::vector<Unobservable> put_back_unobservable(int zeros, const VectorXd& before, double sigma,
                                                VectorXd* x, MatrixXd* covariance) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> split(covariance->topLeftCorner(zeros, zeros));
  const double known = std::pow(kShareToKnow * sigma, 2);
  std::vector<Unobservable> sums;
  MatrixXd change = MatrixXd::Zero(x->size(), x->size());
  for (Eigen::Index i = zeros; i-- > 0 && split.eigenvalues()[i] >= known;) {
    const double variance = split.eigenvalues()[i];
    const VectorXd v = split.eigenvectors().col(i);
    // By how much everything goes along with this sum; the eigenvectors do not with one another.
    const VectorXd along = covariance->leftCols(zeros) * v / variance;
    *x -= along * v.dot(x->head(zeros) - before.head(zeros));
    change += (sigma * sigma - variance) * along * along.transpose();
    sums.push_back({sigma, {v.data(), v.data() + v.size()}});
  }
  *covariance += change;
  return sums;
}

}  // namespace

Identified identify(const GaitdModel& model, const daemon::Calibration& known,
                    const Recording& recording, const Prior& prior) {
  Problem problem(model, known, recording, prior);
  const Layout& layout = problem.layout();
  const VectorXd information = problem.sigma().cwiseAbs2().cwiseInverse();
  VectorXd x = problem.start();
  Eigen::LLT<MatrixXd> normal;
  VectorXd weight;
  for (int i = 0; i < kIterations; ++i) {
    problem.balance(x);
    const VectorXd r = problem.residuals(x);
    weight = weights(r);
    const MatrixXd j = problem.jacobian(x);
    MatrixXd n = j.transpose() * weight.asDiagonal() * j;
    n.diagonal() += information;
    normal.compute(n);
    const VectorXd gradient =
        j.transpose() * weight.cwiseProduct(r) + information.cwiseProduct(x - problem.mean());
    x -= normal.solve(gradient);
  }
  const VectorXd r = problem.residuals(x);
  Identified result;
  result.postures = static_cast<int>(recording.postures.size());
  // Residuals larger than expected say that what was assumed of the sensors is too good.
  result.misfit = std::sqrt(weight.cwiseProduct(r.cwiseAbs2()).mean());
  const double inflation = std::max(1.0, result.misfit * result.misfit);
  MatrixXd covariance =
      normal.solve(MatrixXd::Identity(layout.count(), layout.count())) * inflation;
  const int n = layout.joint_count();
  result.unobservable = put_back_unobservable(n, problem.mean(), prior.zero, &x, &covariance);
  result.zeros.joints = layout.joints;
  result.zeros.value = x.head(n);
  result.zeros.covariance = covariance.topLeftCorner(n, n);
  for (int i = 0; i < n; ++i) {
    result.compliance.push_back(x[layout.compliance(i)]);
    result.compliance_sigma.push_back(
        std::sqrt(covariance(layout.compliance(i), layout.compliance(i))));
  }
  result.accelerometer = x.segment<3>(layout.accelerometer());
  result.chest_com = x.segment<3>(layout.chest());
  return result;
}

}  // namespace gaitd::calibrate
