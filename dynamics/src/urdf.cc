// SPDX-License-Identifier: Apache-2.0
// From the elements of the file to a tree of bodies: who hangs on whom, and what is merged.
#include "gaitd/dynamics/urdf.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "gaitd/dynamics/model_check.h"
#include "merged_mass.h"
#include "urdf_elements.h"
#include "xml_reader.h"

namespace gaitd::dynamics {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kStandardGravity = 9.81;
constexpr double kWater = 1000.0;  // kg/m^3
constexpr double kCross = 0.01;    // kg, of a link between two joints that was given no mass

void copy_rotation(const Matrix3d& from, double (&to)[4]) {
  Eigen::Vector4d::Map(to) = Eigen::Quaterniond(from).normalized().coeffs();
}

class TreeBuilder {
 public:
  TreeBuilder(const UrdfElements& elements, XmlReader* xml, UrdfResult* result)
      : elements_(elements), xml_(*xml), result_(*result) {}

  void build(const UrdfOptions& options) {
    const std::string& root_link = options.root_link;
    index_links();
    index_joints();
    std::string root = find_root();
    if (root.empty()) return;
    report_loops(root);
    root = without_world(root);
    Isometry3d X_BR = Isometry3d::Identity();
    if (!root_link.empty() && !place_root(root_link, &root, &X_BR)) return;
    X_BR = options.X_LB().inverse() * X_BR;
    walk(root, root_link.empty() ? root : root_link, X_BR);
    finish_bodies();
  }

 private:
  struct Visit {
    std::string link;
    int body;  // of the parent link, or of the link itself for the root
    Isometry3d X_BP;
    const UrdfJointElement* joint;  // by which it was reached; null for the first
  };

  void index_links() {
    for (const UrdfLinkElement& link : elements_.links) {
      if (link.name.empty()) continue;
      if (!links_.emplace(link.name, &link).second) {
        xml_.add_error(link.line, "link " + in_quotes(link.name) +
                                      " is there twice (first in line " +
                                      std::to_string(links_[link.name]->line) + "); rename one");
      }
    }
  }

  void index_joints() {
    std::map<std::string, int> first_line;
    for (const UrdfJointElement& joint : elements_.joints) {
      const std::string owner = "joint " + in_quotes(joint.name);
      const auto [at, is_new] = first_line.emplace(joint.name, joint.line);
      if (!is_new && !joint.name.empty()) {
        xml_.add_error(joint.line, owner + " is there twice (first in line " +
                                       std::to_string(at->second) + "); rename one");
      }
      if (!known_link(joint, "parent", joint.parent) || !known_link(joint, "child", joint.child)) {
        continue;
      }
      const auto [parent, is_first] = parent_joint_.emplace(joint.child, &joint);
      if (!is_first) {
        xml_.add_error(joint.line,
                       "link " + in_quotes(joint.child) + " has two parents, by joints " +
                           in_quotes(parent->second->name) + " and " + in_quotes(joint.name) +
                           ", expected a tree; open the loop by removing one of them");
        continue;
      }
      children_[joint.parent].push_back(&joint);
    }
    for (auto& [link, joints] : children_) {
      std::sort(joints.begin(), joints.end(),
                [](const auto* a, const auto* b) { return a->name < b->name; });
    }
  }

  bool known_link(const UrdfJointElement& joint, const char* role, const std::string& name) {
    if (links_.contains(name)) return true;
    unresolved_ = true;
    if (!name.empty()) {
      xml_.add_error(joint.line, "joint " + in_quotes(joint.name) + ": its " + role + " link " +
                                     in_quotes(name) + " does not exist; correct the name");
    }
    return false;
  }

  // The one link without a parent. With joints that name no link, more roots would be a
  // consequence only, so they are not reported then.
  std::string find_root() {
    std::vector<std::string> roots;
    for (const auto& [name, link] : links_) {
      if (!parent_joint_.contains(name)) roots.push_back(name);
    }
    if (roots.size() == 1) return roots[0];
    if (roots.empty() && !links_.empty()) report_loops("");
    if (roots.size() > 1 && !unresolved_) {
      std::string names;
      int line = 0;  // of the last one in the file: the first is the robot most of the time
      for (const std::string& root : roots) {
        names += (names.empty() ? "" : ", ") + in_quotes(root);
        line = std::max(line, links_[root]->line);
      }
      xml_.add_error(line, "has " + std::to_string(roots.size()) + " roots (" + names +
                               "), expected one; connect them with joints or remove the rest");
    }
    return {};
  }

  // The robot below an empty root on which it floats; a floating joint elsewhere is an error.
  std::string without_world(const std::string& root) {
    const auto& joints = children_[root];
    const bool world = joints.size() == 1 && joints[0]->kind == UrdfJointKind::kFloating &&
                       links_[root]->mass == 0;
    for (const UrdfJointElement& joint : elements_.joints) {
      if (joint.kind != UrdfJointKind::kFloating || (world && &joint == joints[0])) continue;
      xml_.add_error(joint.line, "joint " + in_quotes(joint.name) +
                                     ": type is 'floating', expected revolute, continuous, "
                                     "prismatic or fixed; the root of the tree floats by itself");
    }
    return world ? joints[0]->child : root;
  }

  // Each closed chain of parents once.
  void report_loops(const std::string& root) {
    std::set<std::string> done = {root};
    for (const UrdfLinkElement& start : elements_.links) {
      std::vector<std::string> path;
      std::string at = start.name;
      while (!done.contains(at)) {
        done.insert(at);
        path.push_back(at);
        const auto joint = parent_joint_.find(at);
        if (joint == parent_joint_.end()) break;
        at = joint->second->parent;
      }
      const auto first = std::find(path.begin(), path.end(), at);
      if (first == path.end() || !parent_joint_.contains(at)) continue;
      std::string names = in_quotes(at);
      for (auto it = path.end(); it != first;) names += " -> " + in_quotes(*--it);
      xml_.add_error(links_[at]->line,
                     "links form a loop: " + names + ", expected a tree; remove one of its joints");
    }
  }

  // From the root of the file to the uppermost link that is fixed to `name`, whose frame becomes
  // that of body 0, and the pose of that link there.
  bool place_root(const std::string& name, std::string* root, Isometry3d* X_BR) {
    if (!links_.contains(name)) {
      xml_.add_error(0,
                     "root link " + in_quotes(name) + " does not exist; name a link of the file");
      return false;
    }
    Isometry3d X_RB = Isometry3d::Identity();
    std::string top = name;  // of the links fixed to it
    std::set<std::string> passed;
    bool fixed = true;
    for (std::string at = name; at != *root;) {
      if (!passed.insert(at).second) return false;  // a loop, which was reported
      const auto found = parent_joint_.find(at);
      if (found == parent_joint_.end()) {
        xml_.add_error(links_[at]->line, "root link " + in_quotes(name) +
                                             " is the empty one on which the robot floats, "
                                             "expected " +
                                             in_quotes(*root) + " or a link of the robot");
        return false;
      }
      const UrdfJointElement& joint = *found->second;
      at = joint.parent;
      fixed = fixed && joint.kind == UrdfJointKind::kFixed;
      if (!fixed) continue;
      X_RB = joint.X_PJ * X_RB;
      top = at;
    }
    *X_BR = X_RB.inverse();
    *root = top;
    return true;
  }

  // Every joint of a link but the one by which it was reached.
  std::vector<const UrdfJointElement*> onward(const Visit& visit) {
    std::vector<const UrdfJointElement*> joints = children_[visit.link];
    const auto up = parent_joint_.find(visit.link);
    if (up != parent_joint_.end() && up->second->kind != UrdfJointKind::kFloating) {
      joints.push_back(up->second);
      std::sort(joints.begin(), joints.end(),
                [](const auto* a, const auto* b) { return a->name < b->name; });
    }
    std::erase(joints, visit.joint);
    return joints;
  }

  void walk(const std::string& root, const std::string& base_name, const Isometry3d& X_BR) {
    begin_body(base_name, links_[root]->line, -1);
    std::vector<Visit> stack = {{root, 0, X_BR, nullptr}};
    while (!stack.empty()) {
      const Visit visit = stack.back();
      stack.pop_back();
      int body = visit.body;
      Isometry3d X_BL = visit.X_BP;
      if (const UrdfJointElement* joint = visit.joint; joint != nullptr) {
        // Above the pelvis joints are passed from their child to their parent: the same positions
        // turn about the opposite axis.
        const bool down = joint->child == visit.link;
        if (down) X_BL = X_BL * joint->X_PJ;
        if (joint->kind != UrdfJointKind::kFixed) {
          body = add_joint(*joint, down, visit.body, X_BL);
          X_BL = Isometry3d::Identity();
        }
        if (!down) X_BL = X_BL * joint->X_PJ.inverse();
      }
      add_link(*links_[visit.link], body, X_BL);
      const auto joints = onward(visit);
      for (auto it = joints.rbegin(); it != joints.rend(); ++it) {
        stack.push_back(
            {(*it)->parent == visit.link ? (*it)->child : (*it)->parent, body, X_BL, *it});
      }
    }
  }

  void take_name(const std::string& kind, const std::string& from, int line,
                 char (&to)[GAITD_NAME_SIZE]) {
    if (from.size() >= GAITD_NAME_SIZE) {
      xml_.add_error(line, kind + ": name " + in_quotes(from) + " has " +
                               std::to_string(from.size()) + " characters, expected " +
                               std::to_string(GAITD_NAME_SIZE - 1) + " at most; shorten it");
    }
    std::strncpy(to, from.c_str(), GAITD_NAME_SIZE - 1);
  }

  void begin_body(const std::string& name, int line, int parent) {
    const int index = static_cast<int>(merged_.size());
    merged_.emplace_back();
    body_names_.push_back(name);
    body_lines_.push_back(line);
    if (index >= GAITD_MAX_BODIES) return;
    GaitdBody& body = result_.model.bodies[index];
    take_name("link", name, line, body.name);
    body.parent = parent;
    body.joint = index - 1;
  }

  int add_joint(const UrdfJointElement& from, bool down, int parent, const Isometry3d& X_PJ) {
    const int body = static_cast<int>(merged_.size());
    const std::string& carried = down ? from.child : from.parent;
    begin_body(carried, links_[carried]->line, parent);
    if (body >= GAITD_MAX_BODIES) return body;
    GaitdJoint& joint = result_.model.joints[body - 1];
    take_name("joint", from.name, from.line, joint.name);
    joint.type =
        from.kind == UrdfJointKind::kPrismatic ? GAITD_JOINT_PRISMATIC : GAITD_JOINT_REVOLUTE;
    joint.parent_body = parent;
    joint.child_body = body;
    Vector3d::Map(joint.origin) = X_PJ.translation();
    copy_rotation(X_PJ.linear(), joint.orientation);
    Vector3d::Map(joint.axis) = down ? from.axis : Vector3d(-from.axis);
    if (from.lacks_range) result_.joints_without_range.push_back(from.name);
    joint.position_min = from.lower;
    joint.position_max = from.upper;
    joint.velocity_limit = from.velocity;
    joint.effort_limit = from.effort;
    joint.damping = from.damping;
    return body;
  }

  void add_link(const UrdfLinkElement& link, int body, const Isometry3d& X_BL) {
    const Matrix3d R_BL = X_BL.linear();
    merged_[body].add(link.mass, X_BL * link.com, R_BL * link.inertia * R_BL.transpose());
    result_.links.push_back(
        {link.name, body, X_BL.translation(), Eigen::Quaterniond(R_BL).normalized()});
  }

  void finish_bodies() {
    GaitdModel& model = result_.model;
    const int joints = static_cast<int>(merged_.size()) - 1;
    if (joints > GAITD_MAX_JOINTS) {
      xml_.add_error(body_lines_[GAITD_MAX_BODIES],
                     "has " + std::to_string(joints) + " moving joints, expected " +
                         std::to_string(GAITD_MAX_JOINTS) +
                         " at most; make some of them fixed (fingers, for example)");
      return;
    }
    model.joint_count = joints;
    model.body_count = joints + 1;
    for (int i = 0; i <= joints; ++i) finish_body(i);
  }

  bool carries_mass(int body) const {
    for (int i = body + 1; i < result_.model.body_count; ++i) {
      int at = i;
      while (at > body) at = result_.model.bodies[at].parent;
      if (at == body && merged_[i].mass > 0) return true;
    }
    return false;
  }

  void finish_body(int i) {
    MergedMass& merged = merged_[i];
    GaitdBody& body = result_.model.bodies[i];
    const std::string owner = "link " + in_quotes(body_names_[i]);
    const bool cross = merged.mass <= 0 && i > 0 && carries_mass(i);
    if (cross) merged.mass = kCross;
    body.mass = merged.mass;
    Vector3d::Map(body.com) = merged.com;
    Matrix3d m = merged.inertia;
    if (merged.mass > 0 && m.cwiseAbs().maxCoeff() < kNoInertia * merged.mass) {
      const double radius = std::cbrt(3.0 * merged.mass / (4.0 * M_PI * kWater));
      m = 0.4 * merged.mass * radius * radius * Matrix3d::Identity();
      xml_.add_warning(
          body_lines_[i],
          owner + (cross ? " moves without a mass; that of a ball of water of 10 g is taken"
                         : ": a mass without an inertia; that of a ball of water is taken"));
    }
    // A rod is possible as a part, but not as a body that moves by itself.
    if (!check_inertia(m, false).empty() && make_physical(&m)) {
      xml_.add_warning(body_lines_[i], owner +
                                           ": an inertia of zero about one axis; it is taken "
                                           "for a thin one");
    }
    const double inertia[6] = {m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2)};
    std::copy_n(inertia, 6, body.inertia);
    result_.model.total_mass += merged.mass;
    if (merged.mass <= 0) {
      xml_.add_error(body_lines_[i], owner +
                                         " moves but has no mass, nor has any link fixed to it; "
                                         "give it an <inertial> or make its joint fixed");
      return;
    }
    const std::string reason = check_inertia(m, false);
    if (!reason.empty()) {
      xml_.add_error(body_lines_[i],
                     owner + " with all links fixed to it: " + reason + "; correct <inertia>");
    }
  }

  const UrdfElements& elements_;
  XmlReader& xml_;
  UrdfResult& result_;
  std::map<std::string, const UrdfLinkElement*> links_;
  std::map<std::string, const UrdfJointElement*> parent_joint_;  // by child link
  std::map<std::string, std::vector<const UrdfJointElement*>> children_;
  std::vector<MergedMass> merged_;
  std::vector<std::string> body_names_;
  std::vector<int> body_lines_;
  bool unresolved_ = false;
};

}  // namespace

const UrdfLink* UrdfResult::find_link(const std::string& name) const {
  for (const UrdfLink& link : links) {
    if (link.name == name) return &link;
  }
  return nullptr;
}

UrdfResult load_urdf_text(const std::string& text, const std::string& source,
                          const UrdfOptions& options) {
  UrdfResult result;
  result.model.size = sizeof(GaitdModel);
  result.model.gravity = kStandardGravity;
  XmlReader xml(source, &result.errors, &result.warnings);
  const UrdfElements elements = read_urdf_elements(text, options, &xml, &result.unused_fixed);
  result.far_inertias = elements.far_inertias;
  std::strncpy(result.model.name, elements.robot_name.c_str(), GAITD_NAME_SIZE - 1);
  if (!elements.links.empty()) TreeBuilder(elements, &xml, &result).build(options);
  if (result.ok()) {
    for (const std::string& error : check_model(result.model)) xml.add_error(0, error);
  }
  return result;
}

}  // namespace gaitd::dynamics
