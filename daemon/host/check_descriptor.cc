// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <set>
#include <string_view>

#include "daemon/host/elf_descriptor.h"
#include "daemon/host/layers.h"
#include "daemon/host/parameters.h"

namespace gaitd::daemon {
namespace {

// Everything before the descriptor's own size: readable whatever version the rest is of.
constexpr std::size_t kPreambleSize = offsetof(GaitdPluginDescriptor, layer);
// The smallest descriptor of any version of this ABI major.
constexpr std::uint32_t kMinimumSize = sizeof(GaitdPluginDescriptor);

// The text in a fixed array; nothing if it is not terminated in there.
template <std::size_t N>
std::optional<std::string_view> text(const char (&array)[N]) {
  const void* end = std::memchr(array, 0, N);
  if (end == nullptr) return std::nullopt;
  return std::string_view(array, static_cast<const char*>(end) - array);
}

bool consists_of(std::string_view word, std::string_view extra) {
  for (const char c : word) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
    if (!plain && extra.find(c) == std::string_view::npos) return false;
  }
  return !word.empty();
}

bool is_printable(std::string_view word) {
  for (const char c : word) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) return false;
  }
  return true;
}

// For a message: what a bad text holds, with nothing that could upset a terminal.
template <std::size_t N>
std::string shown(const char (&array)[N]) {
  std::string out;
  for (std::size_t i = 0; i < N && array[i] != 0; ++i) {
    out += array[i] >= 0x20 && array[i] < 0x7f ? array[i] : '?';
  }
  return "\"" + out + "\"";
}

// MAJOR.MINOR.PATCH, with anything after - or +.
bool is_semantic(std::string_view version) {
  for (int part = 0; part < 3; ++part) {
    const std::size_t digits = std::min(version.find_first_not_of("0123456789"), version.size());
    if (digits == 0) return false;
    version.remove_prefix(digits);
    if (part == 2) break;
    if (!version.starts_with('.')) return false;
    version.remove_prefix(1);
  }
  return version.empty() || version[0] == '-' || version[0] == '+';
}

std::string version_text(std::uint32_t major, std::uint32_t minor) {
  return std::to_string(major) + "." + std::to_string(minor);
}

void check_layer(const GaitdPluginDescriptor& d, std::optional<int> layer, Refusal* refusal) {
  const std::string_view name = layer_name(d.layer);
  if (name == "unknown") {
    refusal->add("layer", std::to_string(d.layer), "a known layer (GAITD_LAYER_*)",
                 "set the layer of the descriptor, or use a gaitd that has this layer");
  } else if (layer && *layer != d.layer) {
    refusal->add("layer", std::string(name), std::string(layer_name(*layer)),
                 "use the library for its own layer");
  }
}

void check_names(const GaitdPluginDescriptor& d, Refusal* refusal) {
  const auto id = text(d.id);
  if (!id || !consists_of(*id, "")) {
    refusal->add("id", shown(d.id), "1 to 47 of a-z, 0-9, _", "rename the variant");
  }
  const auto version = text(d.version);
  if (!version || !is_semantic(*version) || !is_printable(*version)) {
    refusal->add("version", shown(d.version), "a semantic version, e.g. 1.2.0",
                 "set the version of the descriptor");
  }
  const auto build = text(d.build);
  if (!build || !is_printable(*build)) {
    refusal->add("build", shown(d.build), "printable text of at most 47 characters",
                 "shorten the build string of the descriptor");
  }
  const bool timed = d.layer != GAITD_LAYER_BACKEND;
  if (!std::isfinite(d.worst_case_us) || d.worst_case_us < 0.0 ||
      (timed && d.worst_case_us == 0.0)) {
    refusal->add("worst_case_us", std::to_string(d.worst_case_us), "a finite time > 0 µs",
                 "declare the worst case of process()");
  }
  const std::uint32_t known = d.layer == GAITD_LAYER_BACKEND ? GAITD_CAPABILITY_SIMULATION : 0;
  if ((d.capabilities & ~known) != 0) {
    refusal->add(
        "capabilities", std::to_string(d.capabilities),
        known != 0 ? "0 or GAITD_CAPABILITY_SIMULATION (1)" : "0, since this layer has none",
        "leave out what is not defined, or use a gaitd that knows it");
  }
}

void check_parameter_entry(const GaitdParameter& p, int index, std::set<std::string>* names,
                           Refusal* refusal) {
  const std::string what = "parameter " + std::to_string(index) + " " + shown(p.name);
  const char* remedy = "mend the parameter table";
  const auto name = text(p.name);
  if (!name || !consists_of(*name, ".")) {
    refusal->add(what, "an ill-formed name", "1 to 47 of a-z, 0-9, _ and .", remedy);
  } else if (!names->insert(std::string(*name)).second) {
    refusal->add(what, "the name of an earlier parameter", "a name of its own", remedy);
  }
  const auto unit = text(p.unit);
  const auto description = text(p.description);
  if (!unit || !description || !is_printable(*unit) || !is_printable(*description)) {
    refusal->add(what, "a unit or description that is unterminated or not printable",
                 "printable text that fits", remedy);
    return;
  }
  if (p.rank < GAITD_RANK_TUNING || p.rank > GAITD_RANK_EXPERT) {
    refusal->add(what, "rank " + std::to_string(p.rank), "GAITD_RANK_TUNING, _PORTING or _EXPERT",
                 remedy);
  }
  if (p.type != GAITD_PARAMETER_REAL && p.type != GAITD_PARAMETER_INTEGER &&
      p.type != GAITD_PARAMETER_BOOLEAN) {
    refusal->add(what, "type " + std::to_string(p.type), "real 0, integer 1 or boolean 2", remedy);
    return;
  }
  if (!std::isfinite(p.minimum) || !std::isfinite(p.maximum) || p.minimum > p.maximum) {
    refusal->add(what, "range " + std::to_string(p.minimum) + " to " + std::to_string(p.maximum),
                 "finite minimum <= maximum", remedy);
    return;
  }
  const std::string error = check_parameter(p, p.default_value);
  if (!error.empty()) refusal->add(what, "default: " + error, "a default in its range", remedy);
}

void check_parameter_table(const GaitdPluginDescriptor& d, Refusal* refusal) {
  if (d.parameter_count > GAITD_MAX_PARAMETERS) {
    refusal->add("parameter_count", std::to_string(d.parameter_count),
                 "at most " + std::to_string(GAITD_MAX_PARAMETERS), "mend the parameter table");
    return;
  }
  std::set<std::string> names;
  for (std::uint32_t i = 0; i < d.parameter_count; ++i) {
    check_parameter_entry(d.parameters[i], static_cast<int>(i), &names, refusal);
  }
}

// True if the rest of the descriptor means what we think it means.
bool check_preamble(const GaitdPluginDescriptor& d, std::size_t available, Refusal* refusal) {
  if (d.magic != GAITD_PLUGIN_MAGIC) {
    refusal->add("magic", std::to_string(d.magic), std::to_string(GAITD_PLUGIN_MAGIC),
                 "export the plugin with the macro of the SDK");
    return false;
  }
  if (d.abi_major != GAITD_ABI_MAJOR || d.abi_minor > GAITD_ABI_MINOR) {
    refusal->add(
        "abi", version_text(d.abi_major, d.abi_minor),
        std::to_string(GAITD_ABI_MAJOR) + ".0 to " + version_text(GAITD_ABI_MAJOR, GAITD_ABI_MINOR),
        "build the plugin against the gaitd-dev of this gaitd, or use the gaitd it was "
        "built for");
    return false;
  }
  if (d.struct_size < kMinimumSize || d.struct_size > available) {
    refusal->add(
        "struct_size",
        std::to_string(d.struct_size) + " (" + std::to_string(available) + " bytes in the section)",
        std::to_string(kMinimumSize) + " or more, all in the section",
        "build the plugin against the gaitd-dev of this gaitd");
    return false;
  }
  return true;
}

}  // namespace

void check_descriptor_values(const GaitdPluginDescriptor& descriptor, std::optional<int> layer,
                             Refusal* refusal) {
  check_layer(descriptor, layer, refusal);
  check_names(descriptor, refusal);
  check_parameter_table(descriptor, refusal);
}

std::optional<GaitdPluginDescriptor> check_descriptor(const ElfFacts& facts,
                                                      std::optional<int> layer, Refusal* refusal) {
  const std::size_t before = refusal->reasons.size();
  if (facts.descriptor.size() < kPreambleSize) {
    refusal->add("descriptor", std::to_string(facts.descriptor.size()) + " bytes",
                 std::to_string(kMinimumSize) + " or more",
                 "export the plugin with the macro of the SDK");
    return std::nullopt;
  }
  GaitdPluginDescriptor descriptor{};
  std::memcpy(&descriptor, facts.descriptor.data(),
              std::min(facts.descriptor.size(), sizeof(descriptor)));
  if (!check_preamble(descriptor, facts.descriptor.size(), refusal)) return std::nullopt;
  check_descriptor_values(descriptor, layer, refusal);

  const bool backend = descriptor.layer == GAITD_LAYER_BACKEND;
  if (backend ? !facts.exports_create_backend : !facts.exports_create) {
    const char* name = backend ? GAITD_CREATE_BACKEND_SYMBOL : GAITD_CREATE_SYMBOL;
    refusal->add("symbols", std::string("no exported ") + name, std::string(name) + "()",
                 "export the plugin with the macro of the SDK");
  }
  if (facts.has_thread_local && !backend) {
    refusal->add("thread-local storage", "a PT_TLS segment",
                 "none: its first use allocates on the real-time thread",
                 "remove thread_local (and static libraries that use it) from the plugin");
  }
  if (refusal->reasons.size() != before) return std::nullopt;
  return descriptor;
}

}  // namespace gaitd::daemon
