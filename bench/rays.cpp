// Closest-hit and any-hit queries on the rays of a render, recorded in the order in which it traces them: camera rays,
// bounces in path order, the same shuffled, and shadow rays; by our trees and, where it is built in, by Embree, one ray
// a call or many. scripts/bench-rays.py runs it and prints ratios. Scenes: scenes/weekend.pbrt and a mesh of a trefoil
// knot under a lamp and a sky, scenes/knot.ply.gz or what ALHAZEN_BENCH_MESH names.

#include <benchmark/benchmark.h>

#include <array>
#include <cstdlib>
#include <memory>
#include <random>

#include "core/bvh/simd_traversal.h"
#include "core/integrators/camera_sample.h"
#include "core/sampling/sobol.h"
#include "io/pbrt/pbrt.h"
#include "io/read_scene.h"
#include "scene/flatten.h"
#if defined(ALHAZEN_WITH_EMBREE)
#include "backends/embree/scene.h"
#include "plain_embree.h"
#endif
#include "kernels/query.h"
#include "render/sample_kernel.h"

namespace alhazen {

namespace baseline {
TraceQueries select_trace(Call call, bool is_double);
}
#if defined(__x86_64__)
namespace avx2 {
TraceQueries select_trace(Call call, bool is_double);
}
namespace avx512 {
TraceQueries select_trace(Call call, bool is_double);
}
#endif

namespace {

enum RaySet { primary, bounce, shuffled, shadow };

template <class Real>
using RaySets = std::array<std::vector<Query<Real>>, 4>;

/// Sorts the rays of a render by what they are asked for.
template <class Real>
struct Recorder {
  const SimdBvhIntersector<Real>& inner;
  RaySets<Real>& sets;
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

std::string knot_text() {
  const char* mesh = std::getenv("ALHAZEN_BENCH_MESH");
  const std::string file = mesh ? mesh : ALHAZEN_SOURCE_DIR "/scenes/knot.ply.gz";
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
         file + "\"\n";
}

template <class Real>
struct Recorded {
  FlatScene<Real> flat;
  RaySets<Real> sets;
#if defined(ALHAZEN_WITH_EMBREE)
  std::unique_ptr<PlainEmbree> plain_embree;
  std::unique_ptr<EmbreeScene> embree;
#endif

  explicit Recorded(const std::string& name) {
    constexpr uint32_t width = 480, height = 160, samples = 16;
    Diagnostics diagnostics;
    Scene scene = name == "weekend" ? read_scene(ALHAZEN_SOURCE_DIR "/scenes/weekend.pbrt", diagnostics)
                                    : parse_pbrt(knot_text(), "knot.pbrt", "", diagnostics);
    flat =
        flatten<Real>(std::move(scene), FlattenOptions{width, height, 0, {.binary = false, .simd = true}}, diagnostics);
    const SimdBvhIntersector<Real> intersector(flat.view);
    for (uint32_t y = 0; y < height; ++y)
      for (uint32_t x = 0; x < width; ++x)
        for (uint32_t i = 0; i < samples; ++i) {
          const SobolSampler sampler(0, x, y, i);
          const Recorder<Real> recorder{intersector, sets};
          integrate<IntegratorKind::path>(flat.view, recorder, sampler, sample_camera(flat.view, sampler, x, y).ray,
                                          9u);
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

  static const Recorded& get(const std::string& name) {
    static const Recorded weekend("weekend"), knot("knot");
    return name == "weekend" ? weekend : knot;
  }
};

template <class Real>
void trace(benchmark::State& state, const std::string& scene, RaySet set, TraceQueries function, Call call) {
  const Recorded<Real>& recorded = Recorded<Real>::get(scene);
  const std::vector<Query<Real>>& queries = recorded.sets[set];
  const void* tracer = nullptr;
#if defined(ALHAZEN_WITH_EMBREE)
  if (call == Call::plain_embree) tracer = &recorded.plain_embree->tracer();
  if (call == Call::embree_backend) tracer = &recorded.embree->tracer();
#else
  (void)call;
#endif
  uint64_t hits = 0;
  for (auto _ : state)
    hits = function(&recorded.flat.view, tracer, queries.data(), static_cast<uint32_t>(queries.size()), set == shadow);
  state.counters["rays"] =
      benchmark::Counter(static_cast<double>(queries.size()), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["hit %"] = 100.0 * static_cast<double>(hits) / static_cast<double>(queries.size());
}

template <class Real>
void register_precision(const std::string& precision) {
  constexpr const char* names[] = {"primary", "bounce", "shuffled", "shadow"};
  const auto select = [](InstructionSet set, Call call) {
    return ALHAZEN_KERNEL_OF(set, select_trace)(call, sizeof(Real) == sizeof(double));
  };
  for (const char* scene : {"weekend", "knot"})
    for (const RaySet set : {primary, bounce, shuffled, shadow}) {
      const auto add = [&](const std::string& engine, TraceQueries function, Call call) {
        const std::string name = "rays/" + std::string(scene) + "/" + names[set] + "/" + precision + " " + engine;
        benchmark::RegisterBenchmark(name.c_str(), trace<Real>, scene, set, function, call)
            ->Unit(benchmark::kMillisecond);
      };
      for (const InstructionSet isa : instruction_sets()) {
        add("one " + to_string(isa), select(isa, Call::one), Call::one);
        add("many " + to_string(isa), select(isa, Call::many), Call::many);
        if (set == primary) add("coherent " + to_string(isa), select(isa, Call::coherent), Call::coherent);
      }
#if defined(ALHAZEN_WITH_EMBREE)
      if constexpr (sizeof(Real) == sizeof(float)) {
        const InstructionSet best = instruction_sets().back();
        add("embree", select(best, Call::plain_embree), Call::plain_embree);
        add("embree backend", select(best, Call::embree_backend), Call::embree_backend);
      }
#endif
    }
}

const bool is_registered = [] {
  register_precision<float>("float");
  register_precision<double>("double");
  return true;
}();

}  // namespace
}  // namespace alhazen
