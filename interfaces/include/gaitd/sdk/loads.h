// SPDX-License-Identifier: Apache-2.0
// What the robot carries: point masses on its bodies.
#pragma once

#include <Eigen/Core>

#include "gaitd/abi/types.h"
#include "gaitd/sdk/views.h"

namespace gaitd::sdk {

// nullptr: nothing is on this body.
inline const GaitdLoad* load_on(const GaitdLoads& loads, int body) {
  for (int i = 0; i < loads.count; ++i) {
    if (loads.loads[i].body == body) return &loads.loads[i];
  }
  return nullptr;
}

inline bool same(const GaitdLoads& a, const GaitdLoads& b) {
  if (a.count != b.count) return false;
  for (int i = 0; i < a.count; ++i) {
    const GaitdLoad& x = a.loads[i];
    const GaitdLoad& y = b.loads[i];
    if (x.body != y.body || x.mass != y.mass || view(x.com) != view(y.com)) return false;
  }
  return true;
}

// In place of what was on that body; mass 0: nothing. False: as many bodies as can be loaded are.
inline bool put_load(const GaitdLoad& load, GaitdLoads& loads) {
  int at = 0;
  while (at < loads.count && loads.loads[at].body != load.body) ++at;
  if (load.mass <= 0.0) {
    if (at == loads.count) return true;
    for (--loads.count; at < loads.count; ++at) loads.loads[at] = loads.loads[at + 1];
    loads.loads[loads.count] = {};
    return true;
  }
  if (at == GAITD_MAX_LOADS) return false;
  loads.loads[at] = load;
  if (at == loads.count) ++loads.count;
  return true;
}

inline double mass_of(const GaitdLoads& loads) {
  double sum = 0.0;
  for (int i = 0; i < loads.count; ++i) sum += loads.loads[i].mass;
  return sum;
}

// kg: of the robot and what it carries.
inline double total_mass(const GaitdModel& model, const GaitdLoads& loads) {
  return model.total_mass + mass_of(loads);
}

// The body and its load as one rigid body.
inline GaitdBody loaded(GaitdBody body, const GaitdLoad& load) {
  const double mass = body.mass + load.mass;
  const Eigen::Vector3d apart = view(load.com) - view(body.com);
  // Two masses about their common centre: the reduced mass at their distance.
  const double reduced = body.mass * load.mass / mass;
  const Eigen::Matrix3d added =
      reduced * (apart.squaredNorm() * Eigen::Matrix3d::Identity() - apart * apart.transpose());
  int k = 0;
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) body.inertia[k++] += added(row, column);
  }
  view(body.com) += load.mass / mass * apart;
  body.mass = mass;
  return body;
}

// The same robot, with what it carries.
inline GaitdModel loaded(GaitdModel model, const GaitdLoads& loads) {
  for (int i = 0; i < loads.count; ++i) {
    GaitdBody& body = model.bodies[loads.loads[i].body];
    body = loaded(body, loads.loads[i]);
  }
  model.total_mass = total_mass(model, loads);
  return model;
}

}  // namespace gaitd::sdk
