// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/transmission.h"

#include <algorithm>

namespace gaitd::sim {
namespace {

constexpr double kLightest = 1e-9;  // N m s/rad; a rotor that weighs nothing crosses at once

}  // namespace

void Transmission::begin_step(double h, double u) {
  h_ = h;
  rotor_ = rotor_rate(u);
  const double stiff = h * figures_.stiffness + figures_.damping;
  compliance_ = figures_.stiffness > 0 ? 1 / stiff : 0;
  relaxed_ = figures_.damping * compliance_ * spring_;
}

void Transmission::drive(double constant, double slope) {
  push_ = figures_.inertia / h_ * rotor_ + constant;
  mass_ = std::max(figures_.inertia / h_ + slope, kLightest);
  set_law();
}

void Transmission::set_law() {
  constant_ = slope_ = 0;
  if (flank_ == 0) return;
  const double pressed = deflection_ - relaxed_ - 0.5 * flank_ * figures_.backlash;
  const double divisor = 1 + mass_ * compliance_;
  constant_ = (push_ + mass_ * pressed / h_) / divisor;
  slope_ = mass_ / divisor;
}

bool Transmission::touch(double u) {
  const int before = flank_;
  if (figures_.backlash > 0) {
    const double free = deflection_ + h_ * (push_ / mass_ - u) - relaxed_;
    flank_ = free > 0.5 * figures_.backlash ? 1 : (free < -0.5 * figures_.backlash ? -1 : 0);
  }
  if (flank_ == before) return false;
  set_law();
  return true;
}

double Transmission::deflection_after(double u) const {
  if (flank_ == 0) return deflection_ + h_ * (push_ / mass_ - u);
  const double torque = constant_ - slope_ * u;
  return relaxed_ + 0.5 * flank_ * figures_.backlash + h_ * compliance_ * torque;
}

double Transmission::rotor_rate_after(double u) const {
  if (flank_ == 0) return push_ / mass_;
  return u + (deflection_after(u) - deflection_) / h_;
}

void Transmission::end_step(double u) {
  const double half = 0.5 * figures_.backlash;
  const double after = deflection_after(u);
  slip_ = rotor_rate_after(u) - u;
  // A solver that gave up early may leave the rotor beyond a flank: a spring holds that, a rigid
  // flank must not push it back in a single step.
  deflection_ = figures_.stiffness > 0 ? after : std::clamp(after, -half, half);
  spring_ = figures_.stiffness > 0 ? after - std::clamp(after - relaxed_, -half, half) : 0;
}

}  // namespace gaitd::sim
