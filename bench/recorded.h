#pragma once

// The rays of a render, recorded in the order in which it traces them. Scenes: scenes/weekend.pbrt, scenes/cornell.pbrt
// and a mesh of a trefoil knot under a lamp and a sky, from scenes/knot.ply.gz or the file in ALHAZEN_BENCH_MESH.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "compile/compiled_scene.h"
#include "io/read_scene.h"
#include "kernels/query.h"
#if defined(ALHAZEN_WITH_EMBREE)
#include "backends/embree/module/scene.h"
#include "plain_embree.h"
#endif

namespace alhazen::impl {

/// Camera rays, 16 consecutive ones per pixel; bounces in the order of the paths; the same shuffled; shadow rays.
enum RaySet { primary, bounce, shuffled, shadow };

inline constexpr const char* bench_scenes[] = {"weekend", "cornell", "knot"};
inline constexpr uint32_t bench_width = 480, bench_height = 160, bench_samples = 16, bench_segments = 9;

/// One of these, or `mesh`: the mesh of `knot` alone.
Scene read_bench_scene(const std::string& name);

template <class Real>
struct Recorded {
  CompiledScene<Real> flat;
  std::array<std::vector<Query<Real>>, 4> sets;
#if defined(ALHAZEN_WITH_EMBREE)
  std::unique_ptr<PlainEmbree> plain_embree;  ///< float only
  std::unique_ptr<EmbreeScene> embree;
#endif

  explicit Recorded(const std::string& name);
  /// Recorded on first use.
  static const Recorded& of(const std::string& name);
};

}  // namespace alhazen::impl
