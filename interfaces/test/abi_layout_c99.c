/* SPDX-License-Identifier: Apache-2.0 */
#include <stddef.h>

#include "abi_layout.h"
#include "gaitd/abi/backend.h"
#include "gaitd/abi/plugin.h"
#include "gaitd/abi/types.h"

#define SIZE_ENTRY(type, size) {#type, sizeof(type), size},
#define OFFSET_ENTRY(type, field, offset) {#type "." #field, offsetof(type, field), offset},

const AbiEntry gaitd_abi_layout_in_c[] = {GAITD_ABI_SIZES(SIZE_ENTRY)
                                              GAITD_ABI_OFFSETS(OFFSET_ENTRY){NULL, 0, 0}};
