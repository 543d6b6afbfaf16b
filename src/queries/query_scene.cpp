#include "queries/query_scene.h"

#include <omp.h>

#include <algorithm>
#include <utility>

#include "compile/compile_scene.h"
#include "queries/kernels/request.h"
#include "util/thread_limit.h"

namespace alhazen::impl {

ALHAZEN_DECLARE_KERNEL(RayQueryKernel<float> select_float_queries(bool scene_in_double, bool any_hit))
ALHAZEN_DECLARE_KERNEL(RayQueryKernel<double> select_double_queries(bool scene_in_double, bool any_hit))

namespace {

template <class Number>
RayQueryKernel<Number> kernel_of(InstructionSet set, bool scene_in_double, bool any_hit) {
  if constexpr (sizeof(Number) == sizeof(double))
    return ALHAZEN_KERNEL_OF(set, select_double_queries)(scene_in_double, any_hit);
  else
    return ALHAZEN_KERNEL_OF(set, select_float_queries)(scene_in_double, any_hit);
}

/// Removes all but the geometry. The camera remains at its place, where the scene is to be resolved best
/// (compile/render_space.h), and its shutter is what times of rays refer to.
void keep_geometry(Scene& scene) {
  for (ShapeGroup& group : scene.groups)
    for (Shape& shape : group.shapes) {
      shape.material = no_index;
      shape.emission.reset();
    }
  scene.materials.clear();
  scene.textures.clear();
  scene.images.clear();
  scene.lights.clear();
  scene.environments.clear();
  scene.light_images.clear();
  const Camera camera = std::exchange(scene.camera, {});
  scene.camera.world_from_camera = {camera.world_from_camera.start, camera.world_from_camera.start};
  scene.camera.shutter_open = camera.shutter_open;
  scene.camera.shutter_close = camera.shutter_close;
  scene.film = {};
  scene.filter = {};
}

/// Numbers of rays that a thread takes at a time: not so few that starting a kernel costs time, nor so many that
/// threads wait for the last.
constexpr size_t min_piece = 256, max_piece = 16'384, pieces_per_thread = 8;

}  // namespace

QueryScene::QueryScene(Scene&& scene, Precision precision, int threads, Diagnostics& diagnostics) {
  const ThreadDefaults defaults;
  keep_geometry(scene);
  if (threads > 0) threads = threads_available(threads);
  if (precision == Precision::double_)
    compile<double>(std::move(scene), threads, diagnostics);
  else
    compile<float>(std::move(scene), threads, diagnostics);
  warnings_ = diagnostics.public_warnings();
}

template <class Real>
void QueryScene::compile(Scene&& scene, int threads, Diagnostics& diagnostics) {
  CompileOptions options;
  options.threads = threads;
  options.layouts = {BvhLayout::bvh8};
  options.keeps_origins = true;
  CompiledScene<Real>& compiled =
      compiled_.emplace<CompiledScene<Real>>(compile_scene<Real>(std::move(scene), options, diagnostics));
  const Bounds3<Real>& box = compiled.view.bounds;
  const auto in_world = [&](const Vec3<Real>& p) {
    const Vec3d q = convert<double>(p) + compiled.world_origin;
    return alhazen::Vec3{q.x, q.y, q.z};
  };
  bounds_ = {in_world(box.low), in_world(box.high)};
  origins_ = primitive_origins(compiled.view, compiled.origins);
  compiled.origins.triangles = {};
  compiled.origins.surfaces = {};
}

template <class Number>
void QueryScene::answer(const RayArrays<Number>& rays, const HitArrays<Number>& hits, uint8_t* occluded, int threads,
                        InstructionSet set) const {
  if (threads < 0) throw InputError("the number of threads must not be negative");
  if (rays.count == 0) return;
  if (!rays.origins) throw InputError("the array of the rays' origins is null");
  if (!rays.directions) throw InputError("the array of the rays' directions is null");
  const bool any_hit = occluded != nullptr;
  const RayQueryKernel<Number> kernel = kernel_of<Number>(set, compiled_.index() == 1, any_hit);
  const RayQueryRequest<Number> whole = std::visit(
      [&](const auto& compiled) {
        const Vec3d& origin = compiled.world_origin;
        return RayQueryRequest<Number>{&compiled.view, {origin.x, origin.y, origin.z},
                                       &origins_,      compiled.origins.instances.data(),
                                       rays,           hits,
                                       occluded,       0,
                                       rays.count};
      },
      compiled_);
  const size_t wanted = static_cast<size_t>(threads == 0 ? omp_get_max_threads() : threads);
  const size_t useful = std::min(wanted, (rays.count + min_piece - 1) / min_piece);
  const int team = threads_available(static_cast<int>(useful));
  if (team == 1) return kernel(whole);
  // Multiples of the rays of a packet.
  const size_t piece =
      std::clamp(rays.count / (static_cast<size_t>(team) * pieces_per_thread), min_piece, max_piece) / 16 * 16;
  const size_t pieces = (rays.count + piece - 1) / piece;
#pragma omp parallel for num_threads(team) schedule(dynamic, 1)
  for (size_t i = 0; i < pieces; ++i) {
    RayQueryRequest<Number> part = whole;
    part.first = i * piece;
    part.count = std::min(piece, rays.count - part.first);
    kernel(part);
  }
}

template <class Number>
void QueryScene::closest_hits(const RayArrays<Number>& rays, const HitArrays<Number>& hits, int threads,
                              InstructionSet set) const {
  answer(rays, hits, nullptr, threads, set);
}

template <class Number>
void QueryScene::occluded(const RayArrays<Number>& rays, uint8_t* occluded, int threads, InstructionSet set) const {
  if (!occluded && rays.count > 0) throw InputError("the array for the results, occluded, is null");
  answer(rays, {}, occluded, threads, set);
}

template void QueryScene::closest_hits(const RayArrays<float>&, const HitArrays<float>&, int, InstructionSet) const;
template void QueryScene::closest_hits(const RayArrays<double>&, const HitArrays<double>&, int, InstructionSet) const;
template void QueryScene::occluded(const RayArrays<float>&, uint8_t*, int, InstructionSet) const;
template void QueryScene::occluded(const RayArrays<double>&, uint8_t*, int, InstructionSet) const;

}  // namespace alhazen::impl
