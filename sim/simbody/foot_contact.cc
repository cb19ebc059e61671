// SPDX-License-Identifier: Apache-2.0
#include "foot_contact.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace gaitd::sim {
namespace {

constexpr int kBottom = 0;               // exit of a box edge through the sole; 1 + i: side i
constexpr double kEntryTime = 0.005;     // s
constexpr double kStrongestEdge = 4000;  // N, up to which an edge is pushed out in proportion
constexpr double kBefore = 1e-3;         // m, how far in front of an edge is looked
constexpr double kCone = 0.1;            // sine, by which an edge may push beside its faces
constexpr double kProbe = 3e-3;          // m, above the sole
constexpr double kSameDirection = 0.99;  // cosine: two solids that push a point alike count once
constexpr double kCovered = 1e-4;        // m: an edge this deep in another solid is no edge
constexpr double kSameDepth = 1e-6;      // m: the first of two flush solids stays the one

}  // namespace

FootContact::FootContact(const GaitdFoot& foot, int side, std::optional<double> stiffness)
    : side_(side),
      body_(foot.body),
      p_BS_(foot.sole.origin),
      R_BS_(Eigen::Quaterniond(foot.sole.orientation).toRotationMatrix()) {
  const int n = foot.point_count;
  const int parts = std::max(1, 12 / n);
  double reach = 0;
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector2d a(foot.points[i]);
    const Eigen::Vector2d b(foot.points[(i + 1) % n]);
    for (int k = 0; k < parts; ++k) {
      const Eigen::Vector2d p = a + (b - a) * (static_cast<double>(k) / parts);
      points_B_.push_back(p_BS_ + R_BS_ * Eigen::Vector3d(p.x(), p.y(), 0));
    }
    const Eigen::Vector2d normal = Eigen::Vector2d(b.y() - a.y(), a.x() - b.x()).normalized();
    sides_.push_back({normal, normal.dot(a)});
    reach = std::max(reach, a.norm());
  }
  radius_ = Eigen::Vector2d(reach, kThickness).norm();
  if (stiffness) law_.stiffness = *stiffness / point_count();
  deepest_edge_ = kStrongestEdge / law_.stiffness;
}

Contact FootContact::make_contact(const BodyMotion& motion, const Eigen::Vector3d& p_W) const {
  Contact contact;
  contact.body = body_;
  contact.foot = side_;
  contact.law = law_;
  contact.p_W = p_W;
  contact.p_B = motion.R_WB.transpose() * (p_W - motion.p_WB);
  return contact;
}

void FootContact::detect(const BodyMotion& motion, const Terrain& terrain, ContactMemory* memory,
                         std::vector<Contact>* contacts) {
  terrain.find_near(motion.point(p_BS_), radius_, &near_);
  detect_points(motion, terrain, memory, contacts);
  for (const int box : near_) detect_edges(motion, terrain, box, memory, contacts);
  if (terrain.height_field() != nullptr) {
    detect_ridges(motion, *terrain.height_field(), memory, contacts);
  }
}

void FootContact::detect_points(const BodyMotion& motion, const Terrain& terrain,
                                ContactMemory* memory, std::vector<Contact>* contacts) const {
  const Eigen::Vector3d up = motion.R_WB * R_BS_.col(2);
  for (int i = 0; i < point_count(); ++i) {
    const Eigen::Vector3d p = motion.point(points_B_[static_cast<size_t>(i)]);
    const size_t first = contacts->size();
    const auto add = [&](const Eigen::Vector3d& at, const Eigen::Vector3d& normal, double depth,
                         double friction, int entry) {
      for (size_t k = first; k < contacts->size(); ++k) {
        Contact& other = (*contacts)[k];
        if (other.normal.dot(normal) < kSameDirection) continue;
        if (other.depth > depth - kSameDepth) return;
        other = contacts->back();
        contacts->pop_back();
        break;
      }
      Contact contact = make_contact(motion, at);
      contact.normal = normal;
      contact.depth = depth;
      contact.friction = friction;
      contact.memory = entry;
      contacts->push_back(contact);
    };
    const int owner = side_ * 64 + i;
    if (terrain.has_ground() && p.z() < terrain.ground_z()) {
      const int entry = memory->touch(contact_key(ContactKind::kPoint, owner, Terrain::kGround, 0));
      add(p, Eigen::Vector3d::UnitZ(), terrain.ground_z() - p.z(), terrain.ground_friction(),
          entry);
    }
    if (const HeightField* field = terrain.height_field()) {
      const HeightField::Depth below = field->depth(p);
      if (below.depth > 0) {
        add(p, below.normal, below.depth, field->friction(),
            memory->touch(contact_key(ContactKind::kPoint, owner, Terrain::kHeightField, 0)));
      }
    }
    for (const int index : near_) {
      const Box& box = terrain.boxes()[static_cast<size_t>(index)];
      // A point that has sunk into what a box stands on is below that box: look for its side
      // faces a little higher.
      Eigen::Vector3d at = p;
      auto depth = box.depths(at);
      const bool below = *std::min_element(depth.begin(), depth.end()) <= 0;
      if (below) {
        at += kProbe * up;
        depth = box.depths(at);
        if (*std::min_element(depth.begin(), depth.end()) <= 0) continue;
      }
      const int entry = memory->touch(contact_key(ContactKind::kPoint, owner, index, 0));
      int& face = memory->entry(entry).choice;
      face = terrain.exit_face(index, at, motion.velocity(at), face);
      const Eigen::Vector3d normal = box.normal(face);
      if (below && std::abs(normal.dot(up)) > 0.5) continue;
      add(at, normal, depth[static_cast<size_t>(face)], box.friction, entry);
    }
  }
}

bool FootContact::clip(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                       Interval* interval) const {
  double from = 0, to = 1;
  const auto keep = [&](double at_a, double at_b) {  // the part where the value is positive
    if (at_a <= 0 && at_b <= 0) return false;
    if (at_a < 0) from = std::max(from, at_a / (at_a - at_b));
    if (at_b < 0) to = std::min(to, at_a / (at_a - at_b));
    return from < to;
  };
  if (!keep(a.z(), b.z()) || !keep(kThickness - a.z(), kThickness - b.z())) return false;
  for (const Side& side : sides_) {
    if (!keep(side.offset - side.normal.dot(a.head<2>()),
              side.offset - side.normal.dot(b.head<2>()))) {
      return false;
    }
  }
  interval->ends[0] = a + from * (b - a);
  interval->ends[1] = a + to * (b - a);
  return true;
}

Eigen::Vector3d FootContact::push(int choice) const {
  if (choice == kBottom) return Eigen::Vector3d::UnitZ();
  const Eigen::Vector2d& normal = sides_[static_cast<size_t>(choice) - 1].normal;
  return Eigen::Vector3d(-normal.x(), -normal.y(), 0);
}

// By which way a point of a box edge at `p`, moving with `velocity` in the sole frame, came into
// the foot: the one it crossed within the last few milliseconds, else the nearest. An edge pushes
// only between the normals of its two faces (`faces`, sole frame); -1 if that is nowhere.
int FootContact::choose_exit(const Eigen::Vector3d& p, const Eigen::Vector3d& velocity,
                             const Eigen::Vector3d (&faces)[2]) const {
  double best_depth = std::numeric_limits<double>::infinity(), best_time = kEntryTime;
  int by_depth = kBottom, by_time = -1;
  for (int choice = kBottom; choice <= static_cast<int>(sides_.size()); ++choice) {
    const Eigen::Vector3d direction = push(choice);
    double depth = p.z();
    if (choice != kBottom) {
      const Side& side = sides_[static_cast<size_t>(choice) - 1];
      depth = side.offset - side.normal.dot(p.head<2>());
    }
    if (depth < best_depth) {
      best_depth = depth;
      by_depth = choice;
    }
    const double speed = direction.dot(velocity);
    if (speed > 0 && depth < best_time * speed) {
      best_time = depth / speed;
      by_time = choice;
    }
  }
  const int choice = by_time >= 0 ? by_time : by_depth;
  const double along[2] = {push(choice).dot(faces[0]), push(choice).dot(faces[1])};
  const bool between =
      std::min(along[0], along[1]) > -kCone && std::max(along[0], along[1]) > kCone;
  return between ? choice : -1;
}

void FootContact::detect_edges(const BodyMotion& motion, const Terrain& terrain, int box_index,
                               ContactMemory* memory, std::vector<Contact>* contacts) const {
  const Box& box = terrain.boxes()[static_cast<size_t>(box_index)];
  const Eigen::Matrix3d R_WS = motion.R_WB * R_BS_;
  const Eigen::Vector3d p_WS = motion.point(p_BS_);
  std::array<Eigen::Vector3d, 8> corner;
  for (size_t i = 0; i < 8; ++i) corner[i] = R_WS.transpose() * (box.corner[i] - p_WS);
  for (int e = 0; e < Box::kEdges; ++e) {
    const auto [a, b] = Box::edge(e);
    Interval interval;
    if (!clip(corner[static_cast<size_t>(a)], corner[static_cast<size_t>(b)], &interval)) continue;
    const Eigen::Vector3d middle = 0.5 * (interval.ends[0] + interval.ends[1]);
    const int owner = side_ * 64 + e;
    const int entry = memory->touch(contact_key(ContactKind::kEdge, owner, box_index, 0));
    if (memory->entry(entry).choice < 0) {
      const Eigen::Vector3d v_W = motion.velocity(p_WS + R_WS * middle);
      const auto faces = Box::edge_faces(e);
      memory->entry(entry).choice = choose_exit(
          middle, -(R_WS.transpose() * v_W),
          {R_WS.transpose() * box.normal(faces[0]), R_WS.transpose() * box.normal(faces[1])});
    }
    const int choice = memory->entry(entry).choice;
    if (choice < 0) continue;
    const auto add = [&](const Eigen::Vector3d& p_S, double depth, int part) {
      const Eigen::Vector3d p_W = p_WS + R_WS * p_S;
      const Eigen::Vector3d normal = R_WS * push(choice);
      // Where the edge is flush with another solid there is nothing to run into.
      const Eigen::Vector3d before = p_W + kBefore * normal - kCovered * R_WS.col(2);
      if (depth <= 0 || terrain.covered(p_W, box_index, kCovered) ||
          (choice != kBottom && terrain.covered(before, box_index, 0))) {
        return;
      }
      Contact contact = make_contact(motion, p_W);
      contact.normal = normal;
      contact.depth = std::min(depth, deepest_edge_);
      contact.friction = box.friction;
      contact.memory = memory->touch(contact_key(ContactKind::kEdgeEnd, owner, box_index, part));
      contacts->push_back(contact);
    };
    if (choice == kBottom) {
      for (int end = 0; end < 2; ++end) add(interval.ends[end], interval.ends[end].z(), end);
    } else {
      const Side& side = sides_[static_cast<size_t>(choice) - 1];
      add(middle, side.offset - side.normal.dot(middle.head<2>()), 2);
    }
  }
}

// A ridge inside the foot pushes it out by the way it came in: through the sole, or one of its
// sides.
void FootContact::detect_ridges(const BodyMotion& motion, const HeightField& field,
                                ContactMemory* memory, std::vector<Contact>* contacts) {
  const Eigen::Vector3d p_WS = motion.point(p_BS_);
  const Eigen::Matrix3d R_WS = motion.R_WB * R_BS_;
  field.find_ridges(p_WS, radius_, &ridges_);
  for (const HeightField::Ridge& ridge : ridges_) {
    const Eigen::Vector3d p = R_WS.transpose() * (ridge.p_W - p_WS);
    if (p.z() <= 0 || p.z() >= kThickness) continue;
    const auto depth_of = [&](int choice) {
      if (choice == kBottom) return p.z();
      const Side& side = sides_[static_cast<size_t>(choice) - 1];
      return side.offset - side.normal.dot(p.head<2>());
    };
    int nearest = kBottom;
    for (int choice = kBottom; choice <= static_cast<int>(sides_.size()); ++choice) {
      if (depth_of(choice) < depth_of(nearest)) nearest = choice;
    }
    if (depth_of(nearest) <= 0) continue;
    const int entry =
        memory->touch(contact_key(ContactKind::kEdge, side_,
                                  Terrain::kHeightField + 1 + (ridge.id >> 16), ridge.id & 0xffff));
    int& choice = memory->entry(entry).choice;
    if (choice < 0) choice = nearest;
    Contact contact = make_contact(motion, ridge.p_W);
    contact.normal = R_WS * push(choice);
    contact.depth = std::min(depth_of(choice), deepest_edge_);
    contact.friction = field.friction();
    contact.memory = entry;
    contacts->push_back(contact);
  }
}

}  // namespace gaitd::sim
