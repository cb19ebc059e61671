// SPDX-License-Identifier: Apache-2.0
// One link or joint of a robot description, parsed by urdfdom. It stops at the first fault of what
// it is given and names no line, so each element is given to it alone.
#ifndef GAITD_DYNAMICS_SRC_URDFDOM_PIECE_H_
#define GAITD_DYNAMICS_SRC_URDFDOM_PIECE_H_

#include <tinyxml.h>
#include <urdf_model/joint.h>
#include <urdf_model/link.h>

#include <string>

namespace gaitd::dynamics {

// Without what is only looked at or bumped into. Null if urdfdom finds a fault; `reason` is then
// what it said.
urdf::LinkConstSharedPtr parse_link(const TiXmlElement& link, std::string* reason);

// The same, without the names of the two links.
urdf::JointConstSharedPtr parse_joint(const TiXmlElement& joint, std::string* reason);

}  // namespace gaitd::dynamics

#endif  // GAITD_DYNAMICS_SRC_URDFDOM_PIECE_H_
