// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "daemon/app/application.h"
#include "daemon/usage/completion.h"
#include "daemon/usage/man_page.h"

namespace gaitd::daemon {

// The options of gaitd, and what completion offers for them.
void add_options(CLI::App* app, Options* options, usage::ValueSources* values);

// The prose of gaitd(8).
usage::ManText man_text();

}  // namespace gaitd::daemon
