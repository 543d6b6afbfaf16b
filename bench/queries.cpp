// The recorded rays of rays.cpp by the public interface (alhazen/rays.h), in the same groups: from arrays to arrays, on
// one thread and on all.

#include <benchmark/benchmark.h>

#include <map>

#include "queries/query_scene.h"
#include "recorded.h"

namespace alhazen::impl {

namespace {

/// What is asked for: t alone; t, the indices and barycentrics, as Embree gives them; everything; occlusion.
enum class Wanted { t, ids, all, occlusion };

template <class Real>
struct QueryArrays {
  std::vector<Real> origins, directions, t_max, times;
  std::vector<Real> t, positions, normals, shading_normals, offsets, uvs, barycentrics;
  std::vector<uint32_t> primitives, shapes, instances;
  std::vector<uint8_t> occluded;

  QueryArrays(const std::vector<Query<Real>>& queries, const Vec3d& world_origin) {
    const size_t n = queries.size();
    for (const Query<Real>& query : queries) {
      for (int axis = 0; axis < 3; ++axis) {
        origins.push_back(query.ray.origin[axis] + static_cast<Real>(world_origin[axis]));
        directions.push_back(query.ray.direction[axis]);
      }
      t_max.push_back(query.t_max);
      times.push_back(query.ray.time);
    }
    for (auto* of_rays : {&t, &offsets}) of_rays->resize(n);
    for (auto* vectors : {&positions, &normals, &shading_normals}) vectors->resize(3 * n);
    for (auto* pairs : {&uvs, &barycentrics}) pairs->resize(2 * n);
    for (auto* ids : {&primitives, &shapes, &instances}) ids->resize(n);
    occluded.resize(n);
  }

  RayArrays<Real> rays() const { return {origins.data(), directions.data(), t_max.size(), t_max.data(), times.data()}; }
  HitArrays<Real> hits(Wanted wanted) {
    HitArrays<Real> hits;
    hits.t = t.data();
    if (wanted == Wanted::t) return hits;
    hits.barycentrics = barycentrics.data();
    hits.primitives = primitives.data();
    hits.shapes = shapes.data();
    hits.instances = instances.data();
    if (wanted == Wanted::ids) return hits;
    hits.positions = positions.data();
    hits.normals = normals.data();
    hits.shading_normals = shading_normals.data();
    hits.offsets = offsets.data();
    hits.uvs = uvs.data();
    return hits;
  }
};

template <class Real>
QueryScene& scene_of(const std::string& name) {
  static std::map<std::string, std::unique_ptr<QueryScene>> all;
  std::unique_ptr<QueryScene>& scene = all[name];
  Diagnostics diagnostics;
  if (!scene)
    scene = std::make_unique<QueryScene>(read_bench_scene(name),
                                         sizeof(Real) == sizeof(double) ? Precision::double_ : Precision::single, 0,
                                         diagnostics);
  return *scene;
}

template <class Real>
void query(benchmark::State& state, const std::string& name, RaySet set, Wanted wanted, int threads) {
  const Recorded<Real>& recorded = Recorded<Real>::of(name);
  const QueryScene& scene = scene_of<Real>(name);
  QueryArrays<Real> arrays(recorded.sets[set], recorded.flat.world_origin);
  for (auto _ : state) {
    if (wanted == Wanted::occlusion)
      scene.occluded(arrays.rays(), arrays.occluded.data(), threads);
    else
      scene.closest_hits(arrays.rays(), arrays.hits(wanted), threads);
  }
  state.counters["rays"] =
      benchmark::Counter(static_cast<double>(recorded.sets[set].size()), benchmark::Counter::kIsIterationInvariantRate);
}

template <class Real>
void register_precision(const std::string& precision) {
  constexpr const char* names[] = {"primary", "bounce", "shuffled", "shadow"};
  for (const char* scene : bench_scenes)
    for (const RaySet set : {primary, bounce, shuffled, shadow})
      for (const int threads : {1, 0}) {
        const auto add = [&](const std::string& what, Wanted wanted) {
          const std::string name = std::string("rays/") + scene + "/" + names[set] + "/" + precision + " api " + what +
                                   (threads == 0 ? " all threads" : "");
          benchmark::RegisterBenchmark(name.c_str(), query<Real>, scene, set, wanted, threads)
              ->Unit(benchmark::kMillisecond)
              ->UseRealTime();
        };
        if (set == shadow) {
          add("occluded", Wanted::occlusion);
        } else {
          add("t", Wanted::t);
          add("ids", Wanted::ids);
          add("everything", Wanted::all);
        }
      }
}

const bool is_registered = [] {
  register_precision<float>("float");
  register_precision<double>("double");
  return true;
}();

}  // namespace
}  // namespace alhazen::impl
