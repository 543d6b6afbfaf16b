#include "render/checkpoint.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/sampling/hash.h"
#include "io/images/atomic_file.h"

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
  // Arrays whose records have no padding; lights, which have, by their values.
  h.add_bytes(v.nodes, v.nodes_count * sizeof(*v.nodes));
  h.add_bytes(v.triangles, v.triangles_count * sizeof(*v.triangles));
  h.add_bytes(v.positions, v.positions_count * sizeof(*v.positions));
  h.add_bytes(v.normals, v.normals_count * sizeof(*v.normals));
  h.add_bytes(v.spheres, v.spheres_count * sizeof(*v.spheres));
  h.add_bytes(v.surfaces, v.surfaces_count * sizeof(*v.surfaces));
  h.add_bytes(v.textures, v.textures_count * sizeof(*v.textures));
  h.add_bytes(v.texel_bytes, v.texel_bytes_count);
  for (uint32_t i = 0; i < v.lights_count; ++i) h.add_bytes(&v.lights[i].radiance, sizeof(v.lights[i].radiance));
  h.add_bytes(&v.camera, sizeof(v.camera));
  h.add_bytes(v.filter_cdf, v.filter_cdf_count * sizeof(Real));
  h.add(static_cast<double>(v.filter.x_radius));
  h.add(static_cast<double>(v.filter.y_radius));
  return h.value();
}

CheckpointFile::CheckpointFile(const RenderSettings& settings, uint64_t scene_fingerprint)
    : path_(settings.checkpoint), fingerprint_(join_settings(settings, scene_fingerprint)) {}

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
    throw InputError({path_}, "the checkpoint is of another scene or of other settings: give those that it was made "
                              "with, or start anew without --resume");
  film.visit_planes([&](void* data, size_t size) {
    in.read(static_cast<char*>(data), static_cast<std::streamsize>(size));
  });
  if (!in || header.samples_done > (1u << 24)) throw InputError({path_}, "the checkpoint is damaged: it ends early");
  return static_cast<uint32_t>(header.samples_done);
}

template uint64_t scene_fingerprint(const FlatScene<float>&);
template uint64_t scene_fingerprint(const FlatScene<double>&);
template void CheckpointFile::save(Film<float>&, uint32_t) const;
template void CheckpointFile::save(Film<double>&, uint32_t) const;
template uint32_t CheckpointFile::load(Film<float>&) const;
template uint32_t CheckpointFile::load(Film<double>&) const;

}  // namespace alhazen
