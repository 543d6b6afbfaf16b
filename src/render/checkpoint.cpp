#include "render/checkpoint.h"

#include <sys/stat.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>

#include "core/math/field_list.h"
#include "core/sampling/hash.h"
#include "files/atomic_file.h"
#include "render/sample_kernel.h"
#include "render/setting_table.h"

namespace alhazen::impl {

namespace {

/// The last character counts versions of the format.
constexpr char file_magic[8] = {'a', 'h', 'z', 'e', 'n', 'k', 't', '5'};

struct Header {
  char magic[8];
  char program_version[24];  ///< of the program that wrote the file, padded with zeros
  uint64_t fingerprint;
  uint64_t samples_done;
  uint64_t bytes;           ///< of the planes
  uint32_t settings_bytes;  ///< of the settings that follow as text; there are no bytes between the members
  uint32_t checksum;        ///< CRC-32 of the members above
};
static_assert(sizeof(Header) == 64);
constexpr size_t max_settings_bytes = size_t{1} << 20;

/// CRC-32 finds every flipped bit and every run of up to 32 damaged ones.
uint32_t crc(uint32_t before, const void* data, size_t size) {
  // zlib takes the null pointer of an absent plane as a request for a new checksum.
  return size == 0 ? before : static_cast<uint32_t>(crc32_z(before, static_cast<const Bytef*>(data), size));
}

uint32_t checksum_of(const Header& header) { return crc(0, &header, offsetof(Header, checksum)); }

bool is_intact(const Header& header) {
  return std::memcmp(header.magic, file_magic, sizeof(file_magic)) == 0 && header.checksum == checksum_of(header);
}

std::string program_version(const Header& header) {
  return {header.program_version, std::find(header.program_version, std::end(header.program_version), '\0')};
}

Header make_header(uint64_t fingerprint, uint64_t samples_done, uint64_t bytes, size_t settings_bytes) {
  Header header{{}, {}, fingerprint, samples_done, bytes, static_cast<uint32_t>(settings_bytes), 0};
  std::copy(std::begin(file_magic), std::end(file_magic), header.magic);
  std::strncpy(header.program_version, version(), sizeof(header.program_version) - 1);
  header.checksum = checksum_of(header);
  return header;
}

std::optional<Header> read_header(std::istream& in) {
  Header header{};
  in.read(reinterpret_cast<char*>(&header), sizeof(header));
  if (!in) return std::nullopt;
  return header;
}

class Hasher {
 public:
  void add(uint64_t value) { hash_ = mix64(hash_ ^ value) + 0x9e3779b97f4a7c15u; }
  void add(double value) {
    uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof(value));
    add(bits);
  }
  void add_bytes(const void* data, size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (; size >= 8; size -= 8, bytes += 8) {
      uint64_t word;
      std::memcpy(&word, bytes, 8);
      add(word);
    }
    uint64_t rest = size;
    std::memcpy(&rest, bytes, size);
    add(rest);
  }
  uint64_t value() const { return hash_; }

 private:
  uint64_t hash_ = 0;
};

/// The settings that determine samples, each on a line: its name, a space, and its value.
std::string settings_text(const RenderSettings& s) {
  std::string text;
  for (const SettingEntry& entry : setting_table()) {
    const std::string value = entry.of_samples ? entry.of_samples(s) : "";
    const char* const name = *entry.of_samples_name ? entry.of_samples_name : entry.name;
    if (!value.empty()) text += name + (" " + value) + "\n";
  }
  return text;
}

uint64_t join_settings(const std::string& settings, uint64_t scene) {
  Hasher h;
  h.add(scene);
  h.add_bytes(version(), std::strlen(version()));
  h.add_bytes(settings.data(), settings.size());
  return h.value();
}

/// Returns the lines of `settings` that `others` lacks, separated by commas.
std::string lines_without(const std::string& settings, const std::string& others) {
  std::string different;
  std::istringstream lines(settings);
  for (std::string line; std::getline(lines, line);)
    if (("\n" + others).find("\n" + line + "\n") == std::string::npos)
      different += (different.empty() ? "" : ", ") + line;
  return different;
}

/// Why a checkpoint that was written with `settings` is not one of a render with `wanted`.
std::string mismatch(const std::string& settings, const std::string& wanted) {
  std::string has = lines_without(settings, wanted), lacks = lines_without(wanted, settings);
  const bool is_other_scene = has.empty() && lacks.empty();
  if (has.empty()) has = "none of the following";
  if (lacks.empty()) lacks = "none of that";
  return (is_other_scene
              ? "the checkpoint is of another scene, or of another camera or other lights: give what it was made with"
              : "the checkpoint is of other settings: it was written with " + has + ", and this render has " + lacks +
                    ": give those that it was made with") +
         ", or start anew with --overwrite instead of --resume";
}

template <class Record, auto... members>
void add_members(Hasher& h, const Record& record, FieldList<members...>) {
  (h.add_bytes(&(record.*members), sizeof(record.*members)), ...);
}

/// Records that may have padding, whose bytes are undefined, list their members; others have none.
template <class Record>
void add_records(Hasher& h, const Record* records, uint32_t count) {
  if constexpr (HasFields<Record>) {
    h.add(uint64_t{count});
    for (uint32_t i = 0; i < count; ++i) add_members(h, records[i], typename Record::Fields{});
  } else {
    h.add_bytes(records, count * sizeof(Record));
  }
}

uint64_t file_size(const std::string& path) {
  struct stat file = {};
  return ::stat(path.c_str(), &file) == 0 ? static_cast<uint64_t>(file.st_size) : 0;
}

template <class Real>
uint64_t plane_bytes(Film<Real>& film) {
  uint64_t bytes = 0;
  film.visit_planes([&](const void*, size_t size) { bytes += size; });
  return bytes;
}

}  // namespace

template <class Real>
uint64_t scene_fingerprint(const CompiledScene<Real>& scene) {
  const SceneView<Real>& v = scene.view;
  Hasher h;
#define ALHAZEN_ARRAY(type, name) add_records(h, v.name, v.name##_count);
  ALHAZEN_SCENE_ARRAYS(ALHAZEN_ARRAY)
#undef ALHAZEN_ARRAY
  h.add_bytes(&v.camera, sizeof(v.camera));
  h.add_bytes(&v.filter, sizeof(v.filter));
  h.add_bytes(&v.background, sizeof(v.background));
  h.add(uint64_t{v.background_group});
  h.add_bytes(&v.exposure, sizeof(v.exposure));
  h.add_bytes(&v.infinite_irradiance, sizeof(v.infinite_irradiance));
  return h.value();
}

CheckpointFile::CheckpointFile(const RenderSettings& settings, uint64_t scene_fingerprint)
    : path_(settings.asked.checkpoint),
      settings_(settings_text(settings)),
      fingerprint_(join_settings(settings_, scene_fingerprint)),
      samples_per_pixel_(settings.samples_per_pixel) {
  if (settings_.size() > max_settings_bytes)
    throw InputError({path_}, "the settings are too long for a checkpoint: shorten those of the light groups");
}

void check_checkpoint(const RenderSettings& settings) {
  const std::string& path = settings.asked.checkpoint;
  struct stat file = {};
  const bool exists = ::stat(path.c_str(), &file) == 0;
  if (exists && !S_ISDIR(file.st_mode) && !S_ISREG(file.st_mode))
    throw InputError({path},
                     "a checkpoint must be a file, since it is read again later: name a file, not a device or a pipe");
  check_target(path);
  if (!exists || file.st_size == 0 || settings.asked.resume || settings.asked.overwrite) return;
  std::ifstream in(path, std::ios::binary);
  const std::optional<Header> header = read_header(in);
  if (!header || !is_intact(*header))
    throw InputError({path},
                     "this file is not a checkpoint of this version of Alhazen, and would be overwritten: give "
                     "--checkpoint another name, or --overwrite to replace it");
  throw InputError({path}, "this file holds a render of " + std::to_string(header->samples_done) +
                               " samples per pixel already: give --resume to continue it, --overwrite to replace it, "
                               "or --checkpoint another name");
}

template <class Real>
void CheckpointFile::save(Film<Real>& film, uint32_t samples_done, const Guiding<Real>* guiding) const {
  AtomicFile file(path_);
  const Header header = make_header(fingerprint_, samples_done, plane_bytes(film), settings_.size());
  uint32_t checksum = 0;
  const auto write = [&](const void* data, size_t size) {
    file.write(data, size);
    checksum = crc(checksum, data, size);
  };
  write(&header, sizeof(header));
  write(settings_.data(), settings_.size());
  film.visit_planes(write);
  if (guiding) {
    const std::vector<std::byte> learned = guiding->bytes();
    const uint64_t size = learned.size();
    write(&size, sizeof(size));
    write(learned.data(), learned.size());
  }
  file.write(&checksum, sizeof(checksum));
  file.commit();
}

template <class Real>
uint32_t CheckpointFile::load(Film<Real>& film, Guiding<Real>* guiding) const {
  const InputError damaged({path_}, "the checkpoint is damaged: start anew with --overwrite instead of --resume");
  std::ifstream in(path_, std::ios::binary);
  if (!in) throw InputError({path_}, std::string("cannot open the checkpoint: ") + std::strerror(errno));
  const std::optional<Header> header = read_header(in);
  if (!header || std::memcmp(header->magic, file_magic, sizeof(file_magic) - 1) != 0)
    throw InputError({path_}, "this is not a checkpoint of Alhazen");
  if (header->magic[7] == file_magic[7] && !is_intact(*header)) throw damaged;
  if (header->magic[7] != file_magic[7] || program_version(*header) != version())
    throw InputError({path_}, std::string("the checkpoint is of another version of Alhazen than ") + version() +
                                  ": end the render with that one, or start anew with --overwrite");
  if (header->settings_bytes > max_settings_bytes) throw damaged;
  std::string settings(header->settings_bytes, ' ');
  in.read(settings.data(), static_cast<std::streamsize>(settings.size()));
  if (!in) throw damaged;
  if (header->fingerprint != fingerprint_ || header->bytes != plane_bytes(film))
    throw InputError({path_}, mismatch(settings, settings_));
  uint32_t checksum = crc(crc(0, &*header, sizeof(*header)), settings.data(), settings.size()), expected = 0;
  film.visit_planes([&](void* data, size_t size) {
    in.read(static_cast<char*>(data), static_cast<std::streamsize>(size));
    checksum = crc(checksum, data, size);
  });
  std::vector<std::byte> learned;
  if (guiding) {
    uint64_t size = 0;
    in.read(reinterpret_cast<char*>(&size), sizeof(size));
    if (!in || size > file_size(path_)) throw damaged;
    learned.resize(size);
    in.read(reinterpret_cast<char*>(learned.data()), static_cast<std::streamsize>(size));
    checksum = crc(crc(checksum, &size, sizeof(size)), learned.data(), learned.size());
  }
  in.read(reinterpret_cast<char*>(&expected), sizeof(expected));
  if (!in || in.peek() != std::ifstream::traits_type::eof() || checksum != expected) throw damaged;
  if (guiding && !guiding->restore(learned)) throw damaged;
  const uint32_t held = film.max_samples();
  if (header->samples_done > held || header->samples_done % samples_per_block != 0) throw damaged;
  if (held > samples_per_pixel_)
    throw InputError({path_}, "the checkpoint holds " + std::to_string(held) +
                                  " samples per pixel already: ask for at least as many with --spp");
  return static_cast<uint32_t>(header->samples_done);
}

template uint64_t scene_fingerprint(const CompiledScene<float>&);
template uint64_t scene_fingerprint(const CompiledScene<double>&);
template void CheckpointFile::save(Film<float>&, uint32_t, const Guiding<float>*) const;
template void CheckpointFile::save(Film<double>&, uint32_t, const Guiding<double>*) const;
template uint32_t CheckpointFile::load(Film<float>&, Guiding<float>*) const;
template uint32_t CheckpointFile::load(Film<double>&, Guiding<double>*) const;

}  // namespace alhazen::impl
