#include "study/build_id.h"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <cstring>

namespace alhazen::impl::study {

namespace {

constexpr size_t aligned(size_t size) { return (size + 3) & ~size_t{3}; }

/// The build id in a segment of notes; empty if it has none.
std::string find_build_id(const char* notes, size_t size) {
  for (size_t at = 0; at + sizeof(ElfW(Nhdr)) <= size;) {
    ElfW(Nhdr) note;
    std::memcpy(&note, notes + at, sizeof(note));
    const size_t name = at + sizeof(note), value = name + aligned(note.n_namesz), end = value + aligned(note.n_descsz);
    if (end > size) break;
    if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == 4 && std::memcmp(notes + name, "GNU", 4) == 0) {
      std::string id;
      for (size_t i = 0; i < note.n_descsz; ++i) id += fmt::format("{:02x}", static_cast<uint8_t>(notes[value + i]));
      return id;
    }
    at = end;
  }
  return {};
}

struct Search {
  uintptr_t address;
  std::string id;
};

/// Called for every loaded object: looks at the one that holds the address.
int look_at(dl_phdr_info* object, size_t, void* data) {
  Search& search = *static_cast<Search*>(data);
  bool holds_address = false;
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = object->dlpi_phdr[i];
    const uintptr_t start = object->dlpi_addr + segment.p_vaddr;
    holds_address |= segment.p_type == PT_LOAD && search.address >= start && search.address - start < segment.p_memsz;
  }
  if (!holds_address) return 0;
  for (int i = 0; i < object->dlpi_phnum && search.id.empty(); ++i) {
    const ElfW(Phdr)& segment = object->dlpi_phdr[i];
    if (segment.p_type != PT_NOTE) continue;
    const uintptr_t start = object->dlpi_addr + segment.p_vaddr;
    search.id = find_build_id(reinterpret_cast<const char*>(start), segment.p_memsz);
  }
  return 1;
}

}  // namespace

std::string build_id() {
  Search search{reinterpret_cast<uintptr_t>(&build_id), {}};
  dl_iterate_phdr(look_at, &search);
  return search.id;
}

}  // namespace alhazen::impl::study
