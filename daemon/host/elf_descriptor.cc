// SPDX-License-Identifier: Apache-2.0
#include "daemon/host/elf_descriptor.h"

#include <elf.h>

#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

namespace gaitd::daemon {
namespace {

using Bytes = std::span<const std::byte>;

// The part of the file at [offset, offset + size), nothing if it is not all there.
std::optional<Bytes> part(Bytes file, std::uint64_t offset, std::uint64_t size) {
  if (offset > file.size() || size > file.size() - offset) return std::nullopt;
  return file.subspan(offset, size);
}

// Copies, since nothing in a file need be aligned.
template <typename T>
std::optional<T> read(Bytes file, std::uint64_t offset) {
  const std::optional<Bytes> bytes = part(file, offset, sizeof(T));
  if (!bytes) return std::nullopt;
  T value;
  std::memcpy(&value, bytes->data(), sizeof(T));
  return value;
}

// `count` entries of a table, at most 65535 by the type of the count in the file header.
template <typename T>
std::optional<std::vector<T>> read_table(Bytes file, std::uint64_t offset, std::uint64_t count) {
  const std::optional<Bytes> bytes = part(file, offset, count * sizeof(T));
  if (!bytes) return std::nullopt;
  std::vector<T> table(count);
  if (count > 0) std::memcpy(table.data(), bytes->data(), bytes->size());
  return table;
}

// The zero-terminated string at `offset` of a string table; empty if it does not end in there.
std::string_view string_at(Bytes strings, std::uint64_t offset) {
  if (offset >= strings.size()) return {};
  const auto* begin = reinterpret_cast<const char*>(strings.data() + offset);
  const void* end = std::memchr(begin, 0, strings.size() - offset);
  if (end == nullptr) return {};
  return {begin, static_cast<std::size_t>(static_cast<const char*>(end) - begin)};
}

std::optional<Elf64_Ehdr> read_header(Bytes file, Refusal* refusal) {
  const char* remedy = "build the plugin with gaitd_plugin() on this machine";
  const std::optional<Elf64_Ehdr> header = read<Elf64_Ehdr>(file, 0);
  if (!header || std::memcmp(header->e_ident, ELFMAG, SELFMAG) != 0) {
    refusal->add("file", std::to_string(file.size()) + " bytes that are no ELF file",
                 "a shared library", remedy);
    return std::nullopt;
  }
  const bool fits = header->e_ident[EI_CLASS] == ELFCLASS64 &&
                    header->e_ident[EI_DATA] == ELFDATA2LSB && header->e_machine == EM_X86_64 &&
                    header->e_type == ET_DYN;
  if (!fits) {
    refusal->add("file",
                 "ELF class " + std::to_string(header->e_ident[EI_CLASS]) + ", machine " +
                     std::to_string(header->e_machine) + ", type " + std::to_string(header->e_type),
                 "a 64-bit little-endian x86-64 shared library (2, 62, 3)", remedy);
    return std::nullopt;
  }
  return header;
}

struct DynamicSymbols {
  std::optional<Elf64_Sym> plugin;
  bool create = false;
  bool create_backend = false;
  std::vector<std::string> unique;
};

bool binds_now(Bytes dynamic) {
  for (std::uint64_t i = 0; i < dynamic.size() / sizeof(Elf64_Dyn); ++i) {
    const Elf64_Dyn entry = *read<Elf64_Dyn>(dynamic, i * sizeof(Elf64_Dyn));
    if (entry.d_tag == DT_BIND_NOW || (entry.d_tag == DT_FLAGS && entry.d_un.d_val & DF_BIND_NOW) ||
        (entry.d_tag == DT_FLAGS_1 && entry.d_un.d_val & DF_1_NOW)) {
      return true;
    }
  }
  return false;
}

// Defined, global symbols among those that dlsym would find.
DynamicSymbols read_symbols(Bytes table, Bytes strings) {
  DynamicSymbols found;
  for (std::uint64_t i = 0; i < table.size() / sizeof(Elf64_Sym); ++i) {
    const Elf64_Sym symbol = *read<Elf64_Sym>(table, i * sizeof(Elf64_Sym));
    const int binding = ELF64_ST_BIND(symbol.st_info);
    if (symbol.st_shndx == SHN_UNDEF) continue;
    const std::string_view name = string_at(strings, symbol.st_name);
    if (binding == STB_GNU_UNIQUE) found.unique.emplace_back(name);
    if (binding != STB_GLOBAL && binding != STB_WEAK) continue;
    if (name == GAITD_PLUGIN_SYMBOL) found.plugin = symbol;
    found.create |= name == GAITD_CREATE_SYMBOL;
    found.create_backend |= name == GAITD_CREATE_BACKEND_SYMBOL;
  }
  return found;
}

void refuse_truncated(Bytes file, const char* what, Refusal* refusal) {
  refusal->add(what,
               "a place behind the end of the file (" + std::to_string(file.size()) + " bytes)",
               "a complete file", "copy or build the library again, it is cut off or damaged");
}

}  // namespace

std::optional<ElfFacts> read_elf(Bytes file, Refusal* refusal) {
  const std::optional<Elf64_Ehdr> header = read_header(file, refusal);
  if (!header) return std::nullopt;
  if (header->e_phentsize != sizeof(Elf64_Phdr) || header->e_shentsize != sizeof(Elf64_Shdr)) {
    refusal->add("file", "header tables with entries of another size", "an ELF-64 file",
                 "build the library again, it is damaged");
    return std::nullopt;
  }

  ElfFacts facts;
  const auto segments = read_table<Elf64_Phdr>(file, header->e_phoff, header->e_phnum);
  if (!segments) {
    refuse_truncated(file, "program headers", refusal);
    return std::nullopt;
  }
  for (const Elf64_Phdr& segment : *segments) {
    facts.has_thread_local |= segment.p_type == PT_TLS && segment.p_memsz > 0;
    if (segment.p_type == PT_LOAD && !part(file, segment.p_offset, segment.p_filesz)) {
      refuse_truncated(file, "a loaded segment", refusal);
      return std::nullopt;
    }
    if (segment.p_type == PT_DYNAMIC) {
      if (const auto dynamic = part(file, segment.p_offset, segment.p_filesz)) {
        facts.binds_now = binds_now(*dynamic);
      }
    }
  }

  const auto sections = read_table<Elf64_Shdr>(file, header->e_shoff, header->e_shnum);
  if (!sections || header->e_shstrndx >= sections->size()) {
    refuse_truncated(file, "section headers", refusal);
    return std::nullopt;
  }
  const Elf64_Shdr& name_section = (*sections)[header->e_shstrndx];
  const auto names = part(file, name_section.sh_offset, name_section.sh_size);
  if (!names) {
    refuse_truncated(file, "section names", refusal);
    return std::nullopt;
  }

  const Elf64_Shdr* descriptor = nullptr;
  DynamicSymbols symbols;
  for (const Elf64_Shdr& section : *sections) {
    if (section.sh_type != SHT_NOBITS && string_at(*names, section.sh_name) == GAITD_PLUGIN_SECTION)
      descriptor = &section;
    if (section.sh_type != SHT_DYNSYM || section.sh_link >= sections->size()) continue;
    const Elf64_Shdr& string_section = (*sections)[section.sh_link];
    const auto table = part(file, section.sh_offset, section.sh_size);
    const auto strings = part(file, string_section.sh_offset, string_section.sh_size);
    if (!table || !strings) {
      refuse_truncated(file, "dynamic symbols", refusal);
      return std::nullopt;
    }
    symbols = read_symbols(*table, *strings);
  }
  facts.exports_create = symbols.create;
  facts.exports_create_backend = symbols.create_backend;
  facts.unique = std::move(symbols.unique);

  const char* remedy = "export the plugin with the macro of the SDK";
  if (descriptor == nullptr || !symbols.plugin) {
    refusal->add("descriptor",
                 descriptor == nullptr ? "no section " GAITD_PLUGIN_SECTION
                                       : "no exported symbol " GAITD_PLUGIN_SYMBOL,
                 GAITD_PLUGIN_SYMBOL " in the section " GAITD_PLUGIN_SECTION, remedy);
    return std::nullopt;
  }
  const auto content = part(file, descriptor->sh_offset, descriptor->sh_size);
  if (!content) {
    refuse_truncated(file, "the section " GAITD_PLUGIN_SECTION, refusal);
    return std::nullopt;
  }
  // Unsigned: an address before the section wraps to a huge offset and is refused as well.
  const std::uint64_t offset = symbols.plugin->st_value - descriptor->sh_addr;
  if (offset >= content->size()) {
    refusal->add("descriptor", GAITD_PLUGIN_SYMBOL " outside of the section " GAITD_PLUGIN_SECTION,
                 GAITD_PLUGIN_SYMBOL " inside of it", remedy);
    return std::nullopt;
  }
  facts.descriptor = content->subspan(offset);
  return facts;
}

}  // namespace gaitd::daemon
