// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "daemon/usage/man_page.h"

namespace gaitd::cli {

/// The prose of gaitctl(1).
usage::ManText man_text();

}  // namespace gaitd::cli
