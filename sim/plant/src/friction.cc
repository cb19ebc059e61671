// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/friction.h"

#include <cmath>
#include <numbers>

namespace gaitd::sim {

FrictionLaw FrictionLaw::scaled(double factor) const {
  FrictionLaw law = *this;
  law.coulomb *= factor;
  law.viscous *= factor;
  law.load_share *= factor;
  return law;
}

Friction::Friction(const FrictionLaw& law)
    : law_(law),
      s0_(law.coulomb * law.static_ratio / law.presliding),
      s1_(2 * law.damping_ratio * std::sqrt(s0_ * law.inertia)),
      coulomb_(law.coulomb) {}

double Friction::sliding(double z, double v, double g) const {
  if (law_.break_share == 0) return 1;
  if (z * v <= 0) return 0;
  const double low = law_.break_share * coulomb_ / s0_;
  const double high = g / s0_;
  const double x = std::abs(z);
  if (x <= low) return 0;
  if (x >= high) return 1;
  return 0.5 + 0.5 * std::sin(std::numbers::pi * (x - 0.5 * (low + high)) / (high - low));
}

void Friction::begin_step(double h, double v, double load) {
  h_ = h;
  coulomb_ = law_.coulomb + law_.load_share * std::abs(load);
  denominator_ = 1;
  linearise(v);
}

void Friction::linearise(double u) {
  const double ratio = u / law_.stribeck_speed;
  const double taper = std::exp(-ratio * ratio);
  const double g = coulomb_ * (1 + (law_.static_ratio - 1) * taper);
  const double s1 = s1_ * taper;
  const double z = (z_ + h_ * u) / denominator_;
  const double k = g > 0 ? sliding(z, u, g) * s0_ / g : 0;
  denominator_ = 1 + h_ * k * std::abs(u);
  constant_ = ((s0_ + s1 / h_) / denominator_ - s1 / h_) * z_;
  slope_ = (s0_ * h_ + s1) / denominator_ + law_.viscous;
}

double Friction::end_step(double v) {
  z_ = (z_ + h_ * v) / denominator_;
  return constant_ + slope_ * v;
}

}  // namespace gaitd::sim
