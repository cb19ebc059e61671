/* SPDX-License-Identifier: Apache-2.0
 *
 * The layout as compile-time assertions, for any compiler and any standard from C99 and C++11 on:
 * compile_abi.sh compiles it as C and as C++.
 */
#include <stddef.h>

#include "abi_layout.h"
#include "gaitd/abi/backend.h"
#include "gaitd/abi/plugin.h"
#include "gaitd/abi/types.h"

/* C99 has no assertion of its own: an array of negative size is an error in every standard. */
#define CHECK_SIZE(type, size) char size_of_##type[sizeof(type) == (size) ? 1 : -1];
#define CHECK_OFFSET(type, field, offset) \
  char offset_of_##type##_##field[offsetof(type, field) == (offset) ? 1 : -1];

struct GaitdAbiLayout {
  GAITD_ABI_SIZES(CHECK_SIZE)
  GAITD_ABI_OFFSETS(CHECK_OFFSET)
};
