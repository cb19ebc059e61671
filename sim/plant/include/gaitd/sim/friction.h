// SPDX-License-Identifier: Apache-2.0
// Friction of one joint that sticks: LuGre (Canudas de Wit et al. 1995) with the elasto-plastic
// rule of Dupont et al. 2002, without which a stuck joint creeps under vibration.
//
//   dz/dt = v - a(z, v) s0 |v| / g(v) z         z: deflection of the bristles, rad
//   F     = s0 z + s1(v) dz/dt + s2 v
//   g(v)  = Fc + (Fs - Fc) exp(-(v/vs)^2),   s1(v) = s1 exp(-(v/vs)^2)
//
// The tapered s1 keeps it passive. The step is backward Euler in z and v, written as an affine law
// F = A + B v+ of the joint rate at the end of the step, around an iterate u of that rate: a solver
// puts h B on the diagonal of its mass matrix, -h A on the right side, and repeats with the rate
// that came out, twice at least. B is never negative and no step size is too long.
#ifndef GAITD_SIM_FRICTION_H_
#define GAITD_SIM_FRICTION_H_

namespace gaitd::sim {

struct FrictionLaw {
  double coulomb = 0;          // N m, Fc without load
  double static_ratio = 1;     // Fs / Fc, >= 1
  double stribeck_speed = 1;   // rad/s, vs > 0
  double viscous = 0;          // N m s/rad, s2
  double load_share = 0;       // by which Fc grows with the torque through the gear
  double presliding = 1e-3;    // rad, Fs / s0 > 0
  double damping_ratio = 0.5;  // of the bristles with `inertia`
  double inertia = 1;          // kg m^2 that the joint moves, > 0
  double break_share = 0.9;    // of Fc / s0: below it the deflection is elastic; 0: plain LuGre

  FrictionLaw scaled(double factor) const;  // all torques of it
};

class Friction {
 public:
  explicit Friction(const FrictionLaw& law);

  void reset() { z_ = 0; }
  // Prepares a step of `h` seconds that begins with the joint rate `v` (rad/s) and the torque
  // `load` (N m) through the gear.
  void begin_step(double h, double v, double load);
  // Takes the law around the iterate `u` (rad/s).
  void linearise(double u);
  double constant() const { return constant_; }  // N m, A; the torque on the joint is -A - B v+
  double slope() const { return slope_; }        // N m s/rad, B >= 0
  // Closes the step with the rate `v` (rad/s) that came out. Returns F, N m.
  double end_step(double v);

  double deflection() const { return z_; }               // rad
  double stiffness() const { return s0_; }               // N m/rad
  double energy() const { return 0.5 * s0_ * z_ * z_; }  // J, in the bristles

 private:
  double sliding(double z, double v, double g) const;  // a(z, v), 0..1

  FrictionLaw law_;
  double s0_ = 0;
  double s1_ = 0;
  double z_ = 0;
  double h_ = 0;
  double coulomb_ = 0;  // with load
  double denominator_ = 1;
  double constant_ = 0;
  double slope_ = 0;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_FRICTION_H_
