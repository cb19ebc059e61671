// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/host/refusal.h"
#include "gaitd/abi/backend.h"
#include "gaitd/abi/plugin.h"

namespace gaitd::daemon {

/// What an ELF shared library says about itself, read from its bytes without loading it.
struct ElfFacts {
  bool has_thread_local = false;          ///< a PT_TLS segment with something in it
  bool exports_create = false;            ///< gaitd_create
  bool exports_create_backend = false;    ///< gaitd_create_backend
  bool binds_now = false;                 ///< linked with -z now
  std::vector<std::string> unique;        ///< symbols that all copies of the library share
  std::span<const std::byte> descriptor;  ///< from gaitd_plugin to the end of its section
};

/// Reads the facts from the bytes of a 64-bit little-endian shared library for this machine. Every
/// offset and count of the file is checked against its size: any bytes are safe to pass. Adds to
/// `refusal` and returns nothing if the bytes are no such library or hold no descriptor.
std::optional<ElfFacts> read_elf(std::span<const std::byte> file, Refusal* refusal);

/// Checks the descriptor and the facts against this gaitd: magic, ABI, sizes, layer, names,
/// parameter table, needed symbols, thread-local storage. `layer` is what the place that asks for
/// the plugin expects; nothing accepts any known layer. Adds every reason to `refusal`; returns the
/// descriptor if there was none.
std::optional<GaitdPluginDescriptor> check_descriptor(const ElfFacts& facts,
                                                      std::optional<int> layer, Refusal* refusal);

/// The checks of a descriptor alone, for one in memory.
void check_descriptor_values(const GaitdPluginDescriptor& descriptor, std::optional<int> layer,
                             Refusal* refusal);

}  // namespace gaitd::daemon
