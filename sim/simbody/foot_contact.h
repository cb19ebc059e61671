// SPDX-License-Identifier: Apache-2.0
// Where a foot touches the terrain: points of its sole in the solids, and edges of boxes and ridges
// of the height map in it.
#ifndef GAITD_SIM_FOOT_CONTACT_H_
#define GAITD_SIM_FOOT_CONTACT_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "contact.h"
#include "contact_memory.h"
#include "gaitd/abi/types.h"
#include "gaitd/sim/terrain.h"
#include "multibody.h"

namespace gaitd::sim {

class FootContact {
 public:
  // `side` is GAITD_LEFT or GAITD_RIGHT. The outline must be convex and counter-clockwise with
  // three points or more; its edges are divided so that 8 to 12 points come out.
  // `stiffness` (N/m) of the ground under the whole sole; none: ContactLaw's at each point.
  FootContact(const GaitdFoot& foot, int side, std::optional<double> stiffness);

  // Appends every contact of the foot, `motion` being that of its body.
  void detect(const BodyMotion& motion, const Terrain& terrain, ContactMemory* memory,
              std::vector<Contact>* contacts);

  int point_count() const { return static_cast<int>(points_B_.size()); }
  const ContactLaw& law() const { return law_; }

 private:
  // The foot as a solid is the sole's outline, this thick.
  static constexpr double kThickness = 0.04;  // m

  struct Side {  // of the outline: outward normal n and n . p of its points, sole frame
    Eigen::Vector2d normal;
    double offset;
  };
  struct Interval {  // the part of a box edge inside the foot, sole frame
    Eigen::Vector3d ends[2];
  };

  void detect_points(const BodyMotion& motion, const Terrain& terrain, ContactMemory* memory,
                     std::vector<Contact>* contacts) const;
  void detect_edges(const BodyMotion& motion, const Terrain& terrain, int box,
                    ContactMemory* memory, std::vector<Contact>* contacts) const;
  void detect_ridges(const BodyMotion& motion, const HeightField& field, ContactMemory* memory,
                     std::vector<Contact>* contacts);
  bool clip(const Eigen::Vector3d& a, const Eigen::Vector3d& b, Interval* interval) const;
  // Direction (sole frame) in which a box edge pushes the foot that it leaves by `choice`.
  Eigen::Vector3d push(int choice) const;
  int choose_exit(const Eigen::Vector3d& p, const Eigen::Vector3d& velocity,
                  const Eigen::Vector3d (&faces)[2]) const;
  Contact make_contact(const BodyMotion& motion, const Eigen::Vector3d& p_W) const;

  int side_;
  int body_;
  ContactLaw law_;
  double deepest_edge_;   // m, that is still pushed out in proportion
  Eigen::Vector3d p_BS_;  // m, sole frame in the body
  Eigen::Matrix3d R_BS_;
  std::vector<Eigen::Vector3d> points_B_;  // m, body frame
  std::vector<Side> sides_;
  double radius_;  // m, of the sphere around the foot, about the sole origin
  std::vector<int> near_;
  std::vector<HeightField::Ridge> ridges_;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_FOOT_CONTACT_H_
