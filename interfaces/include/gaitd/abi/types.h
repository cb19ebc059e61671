/* SPDX-License-Identifier: Apache-2.0
 *
 * The plain structs that layers exchange. C99, no dependency, fixed-width types.
 *
 * Conventions, everywhere unless a field says otherwise:
 *   SI units, radians; world frame W: x forward, z up.
 *   Twists, momenta and Jacobian rows: angular first, then linear.
 *   Wrenches: moment first, then force, at the same point.
 *   Quaternions: x, y, z, w, rotating vectors of the named frame into its parent frame.
 *   Sole frame: origin at the middle of the sole, x towards the toe, y left, z up.
 *   Feet are indexed GAITD_LEFT, GAITD_RIGHT. Masks: bit i is row or joint i.
 * Structs are frozen: fields are only ever appended at the tail, `size` says how much is there.
 * Structs that stand in arrays or inside others have no `size`: they grow into their `reserve`.
 */
#ifndef GAITD_ABI_TYPES_H_
#define GAITD_ABI_TYPES_H_

#include "gaitd/abi/control.h"
#include "gaitd/abi/gait.h"
#include "gaitd/abi/model.h"
#include "gaitd/abi/motions.h"
#include "gaitd/abi/state.h"

#endif /* GAITD_ABI_TYPES_H_ */
