// SPDX-License-Identifier: Apache-2.0
// The figures of the sensors in their JSON form.
#ifndef GAITD_SIM_READ_SENSOR_FIGURES_H_
#define GAITD_SIM_READ_SENSOR_FIGURES_H_

#include <string>
#include <vector>

#include "gaitd/sim/sensor_figures.h"
#include "json_reader.h"

namespace gaitd::sim {

// Reads `value`, the name of a class or a map of figures, each a number or the two limits of a
// range. `path` is its key path, for the texts of `errors`.
void read_sensor_figures(const nlohmann::json& value, const std::string& path,
                         std::vector<std::string>* errors, SensorFigures* figures);

}  // namespace gaitd::sim

#endif  // GAITD_SIM_READ_SENSOR_FIGURES_H_
