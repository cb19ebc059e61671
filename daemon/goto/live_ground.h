// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "daemon/control/plan_port.h"
#include "gaitd/abi/model.h"
#include "gaitd/dynamics/kinematics.h"
#include "gaitd/sim/range_sensor.h"
#include "gaitd/terrain/ground_memory.h"

namespace gaitd::daemon {

/// The ground as gaitd knows it: a map that was there from the beginning, what other processes tell
/// of it, and what a simulated sensor sees. Every method may be called by any thread.
class LiveGround {
 public:
  struct Eye {
    sim::RangeSensorFigures figures;
    sim::Terrain terrain;  ///< what there really is
    std::uint64_t seed = 1;
  };
  /// `base`: known from the beginning; null: nothing, or level ground. `eye`: none on a robot,
  /// whose perception is another process.
  LiveGround(const GaitdModel& model, std::shared_ptr<const terrain::HeightMap> base,
             std::optional<Eye> eye);

  /// What is seen from there, and where the robot stands.
  void look(const Sight& sight);
  /// What another process knows: GroundMemory::put.
  terrain::GroundMemory::Taken put(const terrain::HeightMap& tile, bool forget);
  /// Forgets everything but what was known from the beginning.
  void clear();

  /// Whether it changes: something sees, or has told something. What feet find out in a map that
  /// was known from the beginning counts for the next plan.
  bool live() const;
  struct Known {
    std::shared_ptr<const terrain::HeightMap> map;  ///< null: level ground
    std::uint64_t revision = 0;
    int cleared = 0;  ///< how often all that was seen has been forgotten
  };
  Known known() const;
  /// What to plan on: where a map that was known from the beginning changes all the time, as much
  /// of it as is remembered around the robot, around `goal` (m, W), if there is one, and between.
  Known known_towards(const std::optional<Eigen::Vector2d>& goal) const;

 private:
  // What was last asked for.
  struct Made {
    Known known;
    double time = 0.0;  // s
    std::optional<Eigen::AlignedBox2d> part;
  };
  const Known& made(Made* last, const std::optional<Eigen::AlignedBox2d>& part) const;
  // What was told still holds, except where something else was seen or felt since; what was seen
  // and felt was so from where the robot is no longer.
  void begin_anew();
  void stand_on_soles(const Sight& sight);
  // Of feet that stand half in the air.
  void feel(const Sight& sight);

  const GaitdModel model_;
  const std::shared_ptr<const terrain::HeightMap> base_;
  mutable std::mutex mutex_;
  bool told_ = false, felt_ = false;
  double time_ = 0.0;    // s, of the last sight
  double offset_ = 0.0;  // m, of W above the frame of commands, which base_ is in; likewise
  terrain::GroundMemory memory_;
  mutable Made whole_, planned_;
  int cleared_ = 0;
  // Of the simulated sensor.
  std::optional<Eye> eye_;
  std::optional<sim::RangeSensor> sensor_;
  dynamics::Kinematics kinematics_;
  std::vector<sim::RangeSensor::Point> points_;
  std::vector<terrain::SeenPoint> seen_;
};

}  // namespace gaitd::daemon
