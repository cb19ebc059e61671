// SPDX-License-Identifier: Apache-2.0
#include "simbody_oracle.h"

#include <Simbody.h>

#include <vector>

#ifdef NDEBUG
#error "Simbody's headers need NDEBUG undefined, as its library was built"
#endif

namespace gaitd::dynamics {
namespace {

SimTK::Vec3 to_simbody(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }
SimTK::Vec3 vec3(const double* v) { return {v[0], v[1], v[2]}; }
Eigen::Vector3d to_eigen(const SimTK::Vec3& v) { return {v[0], v[1], v[2]}; }

Vector6d to_eigen(const SimTK::SpatialVec& v) {
  Vector6d result;
  result.head<3>() = to_eigen(v[0]);
  result.tail<3>() = to_eigen(v[1]);
  return result;
}

SimTK::Rotation to_rotation(const double* xyzw) {
  return SimTK::Rotation(SimTK::Quaternion(xyzw[3], xyzw[0], xyzw[1], xyzw[2]));
}

}  // namespace

// Simbody's u of the free pelvis holds its twist in world axes: u = T v, T = diag(R_WP, R_WP, 1),
// with its own numbering of the joints. So udot = T vdot + Tdot v.
struct SimbodyOracle::Impl {
  explicit Impl(const GaitdModel& from) : model(from), matter(system) {
    const SimTK::Transform identity;
    bodies.push_back(SimTK::MobilizedBody::Free(matter.Ground(), identity, make_body(0), identity));
    for (int i = 0; i < model.joint_count; ++i) add_joint(i);
    state = system.realizeTopology();
    system.realizeModel(state);
  }

  SimTK::Body::Rigid make_body(int i) const {
    const GaitdBody& body = model.bodies[i];
    const double* v = body.inertia;
    const SimTK::Inertia central(v[0], v[3], v[5], v[1], v[2], v[4]);
    const SimTK::Vec3 com = vec3(body.com);
    return SimTK::Body::Rigid(
        SimTK::MassProperties(body.mass, com, central.shiftFromMassCenter(com, body.mass)));
  }

  void add_joint(int i) {
    const GaitdJoint& joint = model.joints[i];
    const bool slides = joint.type == GAITD_JOINT_PRISMATIC;
    // A Pin turns about z and a Slider moves along x of both of its frames.
    const SimTK::CoordinateAxis along =
        slides ? SimTK::CoordinateAxis(SimTK::XAxis) : SimTK::CoordinateAxis(SimTK::ZAxis);
    const SimTK::Rotation align(SimTK::UnitVec3(vec3(joint.axis)), along);
    const SimTK::Transform X_PJ(to_rotation(joint.orientation), vec3(joint.origin));
    const SimTK::Transform inboard = X_PJ * SimTK::Transform(align);
    SimTK::MobilizedBody& parent = bodies[joint.parent_body];
    if (slides) {
      bodies.push_back(SimTK::MobilizedBody::Slider(parent, inboard, make_body(i + 1), align));
    } else {
      bodies.push_back(SimTK::MobilizedBody::Pin(parent, inboard, make_body(i + 1), align));
    }
  }

  int nv() const { return kBaseSize + model.joint_count; }

  int u_index(int entry) const {
    return entry < kBaseSize ? bodies[0].getFirstUIndex(state) + entry
                             : int{bodies[entry - kBaseSize + 1].getFirstUIndex(state)};
  }

  SimTK::Vector to_u(const Eigen::VectorXd& v) const {
    Eigen::VectorXd turned = v;
    turned.head<3>() = R_WP * v.head<3>();
    turned.segment<3>(3) = R_WP * v.segment<3>(3);
    SimTK::Vector u(nv());
    for (int i = 0; i < nv(); ++i) u[u_index(i)] = turned[i];
    return u;
  }

  // T' f for a force, T^-1 a for a velocity: the same, T being orthogonal.
  Eigen::VectorXd from_u(const SimTK::Vector& u) const {
    Eigen::VectorXd v(nv());
    for (int i = 0; i < nv(); ++i) v[i] = u[u_index(i)];
    v.head<3>() = (R_WP.transpose() * v.head<3>()).eval();
    v.segment<3>(3) = (R_WP.transpose() * v.segment<3>(3)).eval();
    return v;
  }

  SimTK::Vector transport() const {  // Tdot v
    const SimTK::SpatialVec V = bodies[0].getBodyVelocity(state);
    const SimTK::Vec3 rate = SimTK::cross(V[0], V[1]);
    SimTK::Vector result(nv(), 0.0);
    for (int k = 0; k < 3; ++k) result[u_index(3 + k)] = rate[k];
    return result;
  }

  SimTK::Vector udot(const Eigen::VectorXd& vdot) const { return to_u(vdot) + transport(); }

  SimTK::Vector_<SimTK::SpatialVec> weights(double gravity) const {
    SimTK::Vector_<SimTK::SpatialVec> result(model.body_count + 1,
                                             SimTK::SpatialVec(SimTK::Vec3(0), SimTK::Vec3(0)));
    for (int i = 0; i < model.body_count; ++i) {
      const SimTK::Vec3 force(0, 0, -model.bodies[i].mass * gravity);
      const SimTK::Vec3 arm = bodies[i].getBodyRotation(state) * vec3(model.bodies[i].com);
      result[bodies[i].getMobilizedBodyIndex()] =
          SimTK::SpatialVec(SimTK::cross(arm, force), force);
    }
    return result;
  }

  SimTK::Vector residual(const Eigen::VectorXd& vdot, double gravity) const {
    SimTK::Vector result;
    matter.calcResidualForceIgnoringConstraints(state, SimTK::Vector(nv(), 0.0), weights(gravity),
                                                udot(vdot), result);
    return result;
  }

  GaitdModel model;
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter;
  std::vector<SimTK::MobilizedBody> bodies;
  mutable SimTK::State state;
  Eigen::VectorXd v;
  Eigen::Matrix3d R_WP;
};

SimbodyOracle::SimbodyOracle(const GaitdModel& model) : impl_(std::make_unique<Impl>(model)) {}
SimbodyOracle::~SimbodyOracle() = default;

void SimbodyOracle::set_state(const RandomState& s) {
  Impl& m = *impl_;
  m.v = s.v();
  m.R_WP = s.R_WP.toRotationMatrix();
  m.bodies[0].setQToFitTransform(
      m.state, SimTK::Transform(to_rotation(s.R_WP.coeffs().data()), to_simbody(s.p_WP)));
  for (int i = 0; i < s.q.size(); ++i) m.bodies[i + 1].setOneQ(m.state, 0, s.q[i]);
  m.state.updU() = m.to_u(m.v);
  m.system.realize(m.state, SimTK::Stage::Velocity);
}

Eigen::MatrixXd SimbodyOracle::mass_matrix() const {
  const Impl& m = *impl_;
  SimTK::Matrix M;
  m.matter.calcM(m.state, M);
  Eigen::MatrixXd half(m.nv(), m.nv());
  Eigen::MatrixXd result(m.nv(), m.nv());
  for (int j = 0; j < m.nv(); ++j) half.col(j) = m.from_u(SimTK::Vector(M(m.u_index(j))));
  // Columns are in our order now but still in world axes.
  for (int k : {0, 3}) half.middleCols<3>(k) = (half.middleCols<3>(k) * m.R_WP).eval();
  result = half;
  return result;
}

Eigen::VectorXd SimbodyOracle::inverse_dynamics(const Eigen::VectorXd& vdot) const {
  return impl_->from_u(impl_->residual(vdot, impl_->model.gravity));
}

Eigen::VectorXd SimbodyOracle::forward_dynamics(const Eigen::VectorXd& tau) const {
  const Impl& m = *impl_;
  m.system.realize(m.state, SimTK::Stage::Dynamics);
  SimTK::Vector udot;
  SimTK::Vector_<SimTK::SpatialVec> accelerations;
  m.matter.calcAccelerationIgnoringConstraints(m.state, m.to_u(tau), m.weights(m.model.gravity),
                                               udot, accelerations);
  return m.from_u(udot - m.transport());
}

Eigen::Isometry3d SimbodyOracle::X_WB(int body) const {
  const SimTK::Transform& X = impl_->bodies[body].getBodyTransform(impl_->state);
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  for (int k = 0; k < 3; ++k) result.linear().col(k) = to_eigen(SimTK::Vec3(X.R().col(k)));
  result.translation() = to_eigen(X.p());
  return result;
}

Vector6d SimbodyOracle::frame_velocity(int body, const Eigen::Vector3d& p_BF) const {
  const SimTK::MobilizedBody& b = impl_->bodies[body];
  return to_eigen(SimTK::SpatialVec(b.getBodyAngularVelocity(impl_->state),
                                    b.findStationVelocityInGround(impl_->state, to_simbody(p_BF))));
}

Matrix6X SimbodyOracle::frame_jacobian(int body, const Eigen::Vector3d& p_BF) const {
  const Impl& m = *impl_;
  SimTK::Matrix J;
  m.matter.calcFrameJacobian(m.state, m.bodies[body].getMobilizedBodyIndex(), to_simbody(p_BF), J);
  Matrix6X result(6, m.nv());
  for (int row = 0; row < 6; ++row) {
    result.row(row) = m.from_u(SimTK::Vector(~J[row])).transpose();
  }
  return result;
}

Vector6d SimbodyOracle::frame_acceleration(int body, const Eigen::Vector3d& p_BF,
                                           const Eigen::VectorXd& vdot) const {
  const Impl& m = *impl_;
  SimTK::Vector_<SimTK::SpatialVec> accelerations;
  m.matter.calcBodyAccelerationFromUDot(m.state, m.udot(vdot), accelerations);
  const SimTK::SpatialVec& A = accelerations[m.bodies[body].getMobilizedBodyIndex()];
  const SimTK::Vec3 omega = m.bodies[body].getBodyAngularVelocity(m.state);
  const SimTK::Vec3 r = m.bodies[body].getBodyRotation(m.state) * to_simbody(p_BF);
  return to_eigen(SimTK::SpatialVec(
      A[0], A[1] + SimTK::cross(A[0], r) + SimTK::cross(omega, SimTK::cross(omega, r))));
}

Eigen::Vector3d SimbodyOracle::com() const {
  return to_eigen(impl_->matter.calcSystemMassCenterLocationInGround(impl_->state));
}

Eigen::Vector3d SimbodyOracle::com_velocity() const {
  return to_eigen(impl_->matter.calcSystemMassCenterVelocityInGround(impl_->state));
}

Vector6d SimbodyOracle::centroidal_momentum() const {
  return to_eigen(impl_->matter.calcSystemCentralMomentum(impl_->state));
}

Matrix6X SimbodyOracle::centroidal_momentum_matrix() const {
  const Impl& m = *impl_;
  Matrix6X A(6, m.nv());
  SimTK::State state = m.state;
  for (int j = 0; j < m.nv(); ++j) {
    state.updU() = m.to_u(Eigen::VectorXd::Unit(m.nv(), j));
    m.system.realize(state, SimTK::Stage::Velocity);
    A.col(j) = to_eigen(m.matter.calcSystemCentralMomentum(state));
  }
  return A;
}

Vector6d SimbodyOracle::centroidal_momentum_rate(const Eigen::VectorXd& vdot) const {
  const Impl& m = *impl_;
  // What the ground must apply to the pelvis without gravity, moved to the centre of mass.
  const SimTK::Vector residual = m.residual(vdot, 0);
  Vector6d rate;
  for (int k = 0; k < 6; ++k) rate[k] = residual[m.u_index(k)];
  const Eigen::Vector3d arm = com() - X_WB(0).translation();
  rate.head<3>() -= arm.cross(rate.tail<3>());
  return rate;
}

}  // namespace gaitd::dynamics
