#include "render/checkpoint.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/sampling/hash.h"
#include "io/images/atomic_file.h"
#include "render/sample_kernel.h"

namespace alhazen {

namespace {

constexpr uint64_t file_magic = 0x31746b6e657a6861u;  // "ahzenkt1"

struct Header {
  uint64_t magic;
  uint64_t fingerprint;
  uint64_t samples_done;
  uint64_t bytes;
};

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

uint64_t join_settings(const RenderSettings& s, uint64_t scene) {
  Hasher h;
  h.add(scene);
  for (const int64_t value :
       {static_cast<int64_t>(s.precision), static_cast<int64_t>(s.integrator), static_cast<int64_t>(s.sampler),
        static_cast<int64_t>(s.max_segments), static_cast<int64_t>(s.width), static_cast<int64_t>(s.height),
        static_cast<int64_t>(s.window.x0), static_cast<int64_t>(s.window.x1), static_cast<int64_t>(s.window.y0),
        static_cast<int64_t>(s.window.y1), static_cast<int64_t>(s.seed)})
    h.add(static_cast<uint64_t>(value));
  for (const bool layer : {s.aovs.albedo, s.aovs.normal, s.aovs.depth, s.aovs.bounces, s.aovs.samples, s.aovs.variance})
    h.add(static_cast<uint64_t>(layer));
  return h.value();
}

/// Records without padding, which all but those below are.
template <class Record>
void add_records(Hasher& h, const Record* records, uint32_t count) {
  h.add_bytes(records, count * sizeof(Record));
}

template <class Real>
void add_records(Hasher& h, const LightRecord<Real>* lights, uint32_t count) {
  h.add(uint64_t{count});
  for (const LightRecord<Real>* light = lights; light != lights + count; ++light) {
    h.add(uint64_t{static_cast<uint32_t>(light->kind)});
    h.add(uint64_t{light->primitive});
    h.add(uint64_t{light->two_sided});
    for (const uint32_t value : {light->trail, light->texture.first, light->texture.count}) h.add(uint64_t{value});
    for (const Vec3<Real>& v : {light->radiance, light->position, light->direction}) h.add_bytes(&v, sizeof(v));
    for (const Real value : {light->pmf, light->cos_outer, light->cos_inner}) h.add(static_cast<double>(value));
  }
}

template <class Real>
uint64_t plane_bytes(Film<Real>& film) {
  uint64_t bytes = 0;
  film.visit_planes([&](const void*, size_t size) { bytes += size; });
  return bytes;
}

}  // namespace

template <class Real>
uint64_t scene_fingerprint(const FlatScene<Real>& scene) {
  const SceneView<Real>& v = scene.view;
  Hasher h;
#define ALHAZEN_ARRAY(type, name) add_records(h, v.name, v.name##_count);
  ALHAZEN_SCENE_ARRAYS(ALHAZEN_ARRAY)
#undef ALHAZEN_ARRAY
  h.add_bytes(&v.camera, sizeof(v.camera));
  h.add_bytes(&v.filter, sizeof(v.filter));
  h.add_bytes(&v.background, sizeof(v.background));
  h.add_bytes(&v.exposure, sizeof(v.exposure));
  h.add_bytes(&v.light_tree_share, sizeof(v.light_tree_share));
  return h.value();
}

CheckpointFile::CheckpointFile(const RenderSettings& settings, uint64_t scene_fingerprint)
    : path_(settings.checkpoint),
      fingerprint_(join_settings(settings, scene_fingerprint)),
      samples_per_pixel_(settings.samples_per_pixel) {}

template <class Real>
void CheckpointFile::save(Film<Real>& film, uint32_t samples_done) const {
  AtomicFile file(path_);
  const Header header{file_magic, fingerprint_, samples_done, plane_bytes(film)};
  file.write(&header, sizeof(header));
  film.visit_planes([&](const void* data, size_t size) { file.write(data, size); });
  file.commit();
}

template <class Real>
uint32_t CheckpointFile::load(Film<Real>& film) const {
  std::ifstream in(path_, std::ios::binary);
  if (!in) throw InputError({path_}, std::string("cannot open the checkpoint: ") + std::strerror(errno));
  Header header{};
  in.read(reinterpret_cast<char*>(&header), sizeof(header));
  if (!in || header.magic != file_magic) throw InputError({path_}, "this is not a checkpoint of Alhazen");
  if (header.fingerprint != fingerprint_ || header.bytes != plane_bytes(film))
    throw InputError({path_},
                     "the checkpoint is of another scene or of other settings: give those that it was made "
                     "with, or start anew without --resume");
  film.visit_planes(
      [&](void* data, size_t size) { in.read(static_cast<char*>(data), static_cast<std::streamsize>(size)); });
  const uint32_t held = film.most_samples();
  if (!in || in.peek() != std::ifstream::traits_type::eof() || header.samples_done > held ||
      header.samples_done % samples_per_block != 0)
    throw InputError({path_}, "the checkpoint is damaged: start anew without --resume");
  if (held > samples_per_pixel_)
    throw InputError({path_}, "the checkpoint holds " + std::to_string(held) +
                                  " samples per pixel already: ask for at least as many with --spp");
  return static_cast<uint32_t>(header.samples_done);
}

template uint64_t scene_fingerprint(const FlatScene<float>&);
template uint64_t scene_fingerprint(const FlatScene<double>&);
template void CheckpointFile::save(Film<float>&, uint32_t) const;
template void CheckpointFile::save(Film<double>&, uint32_t) const;
template uint32_t CheckpointFile::load(Film<float>&) const;
template uint32_t CheckpointFile::load(Film<double>&) const;

}  // namespace alhazen
