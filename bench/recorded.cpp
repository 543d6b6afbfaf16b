#include "recorded.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <random>

#include "compile/compile_scene.h"
#include "core/bvh/bvh8/intersector.h"
#include "core/integrators/camera_sample.h"
#include "core/sampling/sobol.h"
#include "io/pbrt/pbrt.h"

namespace alhazen::impl {

namespace {

/// Sorts the rays of a path by kind of query.
template <class Real>
struct Recorder {
  const Bvh8Intersector<Real>& inner;
  std::array<std::vector<Query<Real>>, 4>& sets;
  mutable bool is_camera_ray = true;

  bool closest_hit(const Ray<Real>& ray, Real t_max, Hit<Real>& hit) const {
    sets[is_camera_ray ? primary : bounce].push_back({ray, t_max});
    is_camera_ray = false;
    return inner.closest_hit(ray, t_max, hit);
  }
  bool occluded(const Ray<Real>& ray, Real t_max) const {
    sets[shadow].push_back({ray, t_max});
    return inner.occluded(ray, t_max);
  }
};

std::string mesh_file() {
  const char* mesh = std::getenv("ALHAZEN_BENCH_MESH");
  return mesh ? mesh : ALHAZEN_SOURCE_DIR "/scenes/knot.ply.gz";
}

std::string knot_text() {
  return R"(Integrator "path" "integer maxdepth" 8
Scale -1 1 1
LookAt 0.8 4.7 10.8  0.1 1.35 0  0 1 0
Camera "perspective" "float fov" 33
WorldBegin
LightSource "infinite" "rgb L" [ 0.26 0.34 0.46 ]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 15 12.6 9.6 ]
  Translate -4.5 8 3.5
  Rotate -32 0 0 1
  Shape "trianglemesh" "point3 P" [ -1.5 0 -1.5  1.5 0 -1.5  -1.5 0 1.5  1.5 0 1.5 ] "integer indices" [ 0 1 2 1 3 2 ]
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.6 0.6 0.6 ]
Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3 ]
  "point3 P" [ -120 0 -120  -120 0 120  120 0 120  120 0 -120 ]
Translate 0 2.1 -0.6
Rotate 14 0 1 0
Rotate -16 1 0 0
Shape "plymesh" "string filename" ")" +
         mesh_file() + "\"\n";
}

}  // namespace

Scene read_bench_scene(const std::string& name) {
  Diagnostics diagnostics;
  if (name == "mesh") return read_scene(mesh_file(), diagnostics);
  if (name == "knot") return parse_pbrt(knot_text(), "knot.pbrt", "", diagnostics);
  return read_scene(ALHAZEN_SOURCE_DIR "/scenes/" + name + ".pbrt", diagnostics);
}

template <class Real>
Recorded<Real>::Recorded(const std::string& name) {
  Diagnostics diagnostics;
  flat = compile_scene<Real>(read_bench_scene(name), CompileOptions{bench_width, bench_height, 0, {BvhLayout::bvh8}},
                             diagnostics);
  const Bvh8Intersector<Real> intersector(flat.view);
  for (uint32_t y = 0; y < bench_height; ++y)
    for (uint32_t x = 0; x < bench_width; ++x)
      for (uint32_t i = 0; i < bench_samples; ++i) {
        const SobolSampler sampler(0, x, y, i);
        const Recorder<Real> recorder{intersector, sets};
        integrate<IntegratorKind::path>(flat.view, recorder, sampler, sample_camera(flat.view, sampler, x, y).ray,
                                        bench_segments);
      }
  sets[shuffled] = sets[bounce];
  std::shuffle(sets[shuffled].begin(), sets[shuffled].end(), std::mt19937(1));
#if defined(ALHAZEN_WITH_EMBREE)
  if constexpr (sizeof(Real) == sizeof(float)) {
    plain_embree = std::make_unique<PlainEmbree>(flat.view, 2);
    embree = std::make_unique<EmbreeScene>(flat.view, 2);
  }
#endif
}

template <class Real>
const Recorded<Real>& Recorded<Real>::of(const std::string& name) {
  static std::map<std::string, std::unique_ptr<Recorded>> all;
  std::unique_ptr<Recorded>& recorded = all[name];
  if (!recorded) recorded = std::make_unique<Recorded>(name);
  return *recorded;
}

template struct Recorded<float>;
template struct Recorded<double>;

}  // namespace alhazen::impl
