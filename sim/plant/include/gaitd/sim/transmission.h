// SPDX-License-Identifier: Apache-2.0
// What lies between the rotor of a drive and the link that it moves: a spring with a damper, and
// the gap of the gear's teeth (backlash).
//
//   B dw/dt = M - T              w: rate of the rotor; M: torque on it, friction included
//   T = K x + D dx/dt            T: torque on the link; x: deflection of the spring
//   d = x + g,  |g| <= b/2       d: rotor minus link; T > 0 only at g = b/2, < 0 only at -b/2
//
// The step is backward Euler in all of it and eliminates the rotor, so that the physics engine sees
// T as an affine law of the rate of the link after the step, however stiff the spring is. T grows
// with d, so for a given rate of the link exactly one of the laws "a flank carries" and "none does"
// holds; and no step creates energy. A rigid gear (K = 0 here) is the limit of a stiff one: while a
// flank carries, the rotor is inertia of the link.
#ifndef GAITD_SIM_TRANSMISSION_H_
#define GAITD_SIM_TRANSMISSION_H_

namespace gaitd::sim {

struct TransmissionFigures {
  double inertia = 0;    // kg m^2, B
  double stiffness = 0;  // N m/rad, K; 0: rigid
  double damping = 0;    // N m s/rad, D of the spring
  double backlash = 0;   // rad, b, from flank to flank
};

class Transmission {
 public:
  explicit Transmission(const TransmissionFigures& figures) : figures_(figures) {}

  // At rest, the spring relaxed, in the middle of the gap.
  void reset() { deflection_ = spring_ = slip_ = 0; }

  // rad/s, of the rotor, if that of the link is `u`; between two steps.
  double rotor_rate(double u) const { return u + slip_; }
  // Prepares a step of `h` seconds that begins with the rate `u` of the link.
  void begin_step(double h, double u);
  // The torque on the rotor is constant - slope w for its rate w after the step. Call it before
  // touch(), again whenever it changes.
  void drive(double constant, double slope);
  // Which flank carries if the rate of the link after the step is `u`. True: another one than
  // before, so that the law below changed.
  bool touch(double u);

  // T = constant - slope u, for the rate u of the link after the step.
  double constant() const { return constant_; }
  double slope() const { return slope_; }
  // rad/s, of the rotor after the step.
  double rotor_rate_after(double u) const;
  // Closes the step with the rate `u` of the link that came out.
  void end_step(double u);

  double deflection() const { return deflection_; }  // rad, d
  double energy() const {                            // J, in the spring
    return 0.5 * figures_.stiffness * spring_ * spring_;
  }

 private:
  double deflection_after(double u) const;
  void set_law();

  TransmissionFigures figures_;
  double deflection_ = 0;  // rad
  double spring_ = 0;      // rad, x
  double slip_ = 0;        // rad/s, of the rotor relative to the link

  // Of the step.
  double h_ = 0;
  double rotor_ = 0;       // rad/s, at its beginning
  double relaxed_ = 0;     // rad, x at its end if no flank carries
  double compliance_ = 0;  // 1 / (h K + D); 0: rigid
  double push_ = 0;        // N m: B w / h + the constant of the torque on the rotor
  double mass_ = 0;        // N m s/rad: B / h + its slope
  int flank_ = 1;          // that carries: 1, -1; 0: none
  double constant_ = 0;
  double slope_ = 0;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_TRANSMISSION_H_
