// SPDX-License-Identifier: Apache-2.0
// One link or joint of a robot description, parsed by urdfdom. It stops at the first fault of what
// it is given, so each element is given to it alone.
#ifndef GAITD_DYNAMICS_SRC_URDFDOM_PIECE_H_
#define GAITD_DYNAMICS_SRC_URDFDOM_PIECE_H_

#include <tinyxml.h>
#include <urdf_model/joint.h>
#include <urdf_model/link.h>

#include <string>

namespace gaitd::dynamics {

// Null if urdfdom finds a fault; `reason` is then what it said.
urdf::LinkConstSharedPtr parse_link_alone(const TiXmlElement& link, std::string* reason);

// The same; the links that the joint names need not be there, and are not in the result.
urdf::JointConstSharedPtr parse_joint_alone(const TiXmlElement& joint, std::string* reason);

}  // namespace gaitd::dynamics

#endif  // GAITD_DYNAMICS_SRC_URDFDOM_PIECE_H_
