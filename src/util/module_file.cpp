#include "util/module_file.h"

#include <elf.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

namespace alhazen::impl {

namespace {

/// A 64-bit ELF shared object. All offsets and sizes in it are checked before use.
class ElfFile {
 public:
  explicit ElfFile(const std::string& path) : file_(path, std::ios::binary) {
    std::error_code error;
    size_ = std::filesystem::file_size(path, error);
    if (error) size_ = 0;
  }

  bool read(uint64_t offset, void* to, uint64_t bytes) {
    if (!contains(offset, bytes)) return false;
    file_.seekg(static_cast<std::streamoff>(offset));
    file_.read(static_cast<char*>(to), static_cast<std::streamsize>(bytes));
    return file_.good();
  }

  bool read_header() {
    return read(0, &header_, sizeof(header_)) && std::memcmp(header_.e_ident, ELFMAG, SELFMAG) == 0 &&
           header_.e_ident[EI_CLASS] == ELFCLASS64 && header_.e_type == ET_DYN &&
           header_.e_phentsize == sizeof(Elf64_Phdr) && header_.e_shentsize == sizeof(Elf64_Shdr);
  }

  /// Returns whether the file contains all of its segments. The dynamic linker maps them, and an access beyond the end
  /// of the file would kill the process.
  bool holds_its_segments() {
    std::vector<Elf64_Phdr> segments(header_.e_phnum);
    if (!read(header_.e_phoff, segments.data(), segments.size() * sizeof(Elf64_Phdr))) return false;
    for (const Elf64_Phdr& segment : segments)
      if (!contains(segment.p_offset, segment.p_filesz)) return false;
    return true;
  }

  std::optional<Elf64_Shdr> find_section(const char* name) {
    std::vector<Elf64_Shdr> sections(header_.e_shnum);
    if (!read(header_.e_shoff, sections.data(), sections.size() * sizeof(Elf64_Shdr))) return std::nullopt;
    if (header_.e_shstrndx >= sections.size()) return std::nullopt;
    const Elf64_Shdr& names = sections[header_.e_shstrndx];
    const size_t length = std::strlen(name) + 1;
    std::vector<char> text(length);
    for (const Elf64_Shdr& section : sections)
      if (read(names.sh_offset + section.sh_name, text.data(), length) && std::memcmp(text.data(), name, length) == 0)
        return section;
    return std::nullopt;
  }

 private:
  bool contains(uint64_t offset, uint64_t bytes) const { return offset <= size_ && bytes <= size_ - offset; }

  std::ifstream file_;
  uint64_t size_ = 0;
  Elf64_Ehdr header_{};
};

template <size_t count>
bool is_text(const char (&field)[count]) {
  return std::memchr(field, 0, count) != nullptr;
}

}  // namespace

std::optional<ModuleIdentity> read_module_identity(const std::string& path) {
  ElfFile file(path);
  if (!file.read_header() || !file.holds_its_segments()) return std::nullopt;
  const std::optional<Elf64_Shdr> section = file.find_section(module_section);
  ModuleIdentity identity;
  if (!section || section->sh_size < sizeof(identity) || !file.read(section->sh_offset, &identity, sizeof(identity)))
    return std::nullopt;
  if (std::memcmp(identity.magic, module_magic, sizeof(module_magic)) != 0 || !is_text(identity.name) ||
      !is_text(identity.version) || !is_text(identity.interface))
    return std::nullopt;
  return identity;
}

}  // namespace alhazen::impl
