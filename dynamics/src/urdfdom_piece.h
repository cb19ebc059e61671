// SPDX-License-Identifier: Apache-2.0
// urdfdom stops at the first fault of what it is given and names no line. So it gets a link or a
// joint child by child, and each fault is told with the line of the child.
#ifndef GAITD_DYNAMICS_SRC_URDFDOM_PIECE_H_
#define GAITD_DYNAMICS_SRC_URDFDOM_PIECE_H_

#include <urdf_model/joint.h>
#include <urdf_model/link.h>

#include <initializer_list>
#include <string>

#include "xml_reader.h"

namespace gaitd::dynamics {

// What urdfdom reads in <inertial>. A child that it refuses goes to `xml` and is left out, which
// makes it that of a ball of 1 kg.
urdf::Inertial parse_inertial(const TiXmlElement& inertial, const std::string& owner,
                              XmlReader* xml);

// The same for children (origin, axis, limit, dynamics) of a <joint> of any type.
urdf::Joint parse_joint(const TiXmlElement& joint, std::initializer_list<const char*> children,
                        const std::string& owner, XmlReader* xml);

}  // namespace gaitd::dynamics

#endif  // GAITD_DYNAMICS_SRC_URDFDOM_PIECE_H_
