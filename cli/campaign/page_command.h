// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/context.h"

namespace CLI {
class App;
}

namespace gaitd::cli {

/// `gaitctl campaign report`: a page of what a campaign has found.
void add_page_command(CLI::App* campaign, Context* context);

}  // namespace gaitd::cli
