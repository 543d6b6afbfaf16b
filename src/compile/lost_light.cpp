#include "compile/lost_light.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "core/bvh/bvh2/traversal.h"
#include "core/integrators/stages.h"

namespace alhazen::impl {

namespace {

constexpr uint32_t points_per_material = 32, max_materials = 64, max_lights = 16, rays_per_light = 256;
constexpr uint32_t directions_per_point = 8, max_receivers = 512;
constexpr int max_tries = 8;
/// Minimum fraction of the incident light that a material scatters into sharp lobes, above what varnish or glass
/// reflects, and minimum fraction that must then be lost.
constexpr double min_sharp = 0.15, min_lost = 0.005;
/// Density over solid angle above which a lobe counts as specular: that of GGX with an alpha of 0.009.
constexpr double sharp_pdf = 1000;

bool is_without_size(LightKind kind) { return !light_traits(kind).has_size; }

bool may_be_sharp(MaterialKind kind) { return has_trait<&MaterialTraits::may_be_sharp>(kind); }

constexpr uint32_t no_object = 0xffffffffu;

/// A point of a primitive, for testing light from any direction.
struct Candidate {
  PrimitiveId primitive;
  uint32_t instance = no_instance;
};

template <class Real>
class LostLightSearch {
 public:
  LostLightSearch(const SceneView<Real>& view, uint32_t max_segments)
      : view_(view), intersector_(view), max_segments_(max_segments) {}

  std::optional<LostLight> run() {
    std::vector<uint32_t> lights;
    for (uint32_t i = 0; i < view_.lights_count; ++i)
      if (is_without_size(view_.lights[i].kind)) lights.push_back(i);
    if (lights.empty()) return {};
    candidates_ = collect(points_per_material * max_materials, max_materials, may_be_sharp);
    if (candidates_.empty()) return {};
    receivers_ = collect(max_receivers, max_receivers, [](MaterialKind kind) { return !may_be_sharp(kind); });
    std::optional<LostLight> lost;
    for (uint32_t i = 0; i < lights.size() && i < max_lights; ++i) {
      std::optional<LostLight> of_this = lost_of(view_.lights[lights[i]]);
      if (of_this) of_this->light = i;
      if (!of_this) continue;
      if (lost)
        ++lost->others;
      else
        lost = of_this;
    }
    if (lost) lost->others_may_be_more = lights.size() > max_lights;
    return lost;
  }

 private:
  /// The instances, sorted by object.
  struct Uses {
    std::vector<uint32_t> first;      ///< by object, and one past the last: index into `instances`
    std::vector<uint32_t> instances;  ///< indices into `instances` of the scene
    uint32_t count(uint32_t object) const { return first[object + 1] - first[object]; }
  };

  Uses uses_of_objects() const {
    Uses uses;
    uses.first.assign(size_t{view_.objects_count} + 1, 0);
    for (uint32_t k = 0; k < view_.instances_count; ++k) ++uses.first[view_.instances[k].object + 1];
    std::partial_sum(uses.first.begin(), uses.first.end(), uses.first.begin());
    uses.instances.resize(view_.instances_count);
    std::vector<uint32_t> next = uses.first;
    for (uint32_t k = 0; k < view_.instances_count; ++k) uses.instances[next[view_.instances[k].object]++] = k;
    return uses;
  }

  /// Visits each primitive once, with the object that contains it, or `no_object`.
  template <class Visit>
  void for_each_primitive(const Visit& visit) const {
    const auto visit_kind = [&](PrimitiveKind kind, uint32_t count) {
      if (kind == PrimitiveKind::triangle && view_.objects_count > 0) count = view_.objects[0].first_triangle;
      for (uint32_t i = 0; i < count; ++i) visit(PrimitiveId(kind, i), no_object);
    };
#define ALHAZEN_VISIT(X, kind, Record, records, Block, blocks) visit_kind(PrimitiveKind::kind, view_.records##_count);
    ALHAZEN_PRIMITIVES(ALHAZEN_VISIT, )
#undef ALHAZEN_VISIT
    for (uint32_t k = 0; k < view_.objects_count; ++k)
      for (uint32_t i = 0; i < view_.objects[k].triangle_count; ++i)
        visit(PrimitiveId(PrimitiveKind::triangle, view_.objects[k].first_triangle + i), k);
  }

  /// Selects some primitives of each of some materials whose kind is wanted, evenly among all that have the material. A
  /// primitive of an object counts once per instance, and each point on it is on a different instance.
  template <class IsWanted>
  std::vector<Candidate> collect(uint32_t max_points, uint32_t max_count, const IsWanted& is_wanted) {
    std::vector<Candidate> found;
    std::vector<uint64_t> counts(view_.materials_count), seen(view_.materials_count);
    std::vector<bool> wanted(view_.materials_count);
    uint32_t materials = 0;
    for (uint32_t s = 0; s < view_.surfaces_count && materials < max_count; ++s) {
      const uint32_t m = view_.surfaces[s].material;
      if (!wanted[m] && is_wanted(view_.materials[m].kind)) wanted[m] = true, ++materials;
    }
    if (materials == 0) return found;
    const uint32_t points = std::min(points_per_material, max_points / materials);
    const Uses uses = uses_of_objects();
    const auto material_of = [&](PrimitiveId id) { return view_.surfaces[surface_of(view_, id)].material; };
    const auto uses_of = [&](uint32_t object) { return object == no_object ? 1 : uses.count(object); };
    for_each_primitive([&](PrimitiveId id, uint32_t object) { counts[material_of(id)] += uses_of(object); });
    for_each_primitive([&](PrimitiveId id, uint32_t object) {
      const uint32_t m = material_of(id);
      if (!wanted[m]) return;
      // Equally many points on each of few primitives, or one point each on some of many.
      const uint64_t before = seen[m] * points / counts[m];
      const uint64_t after = (seen[m] += uses_of(object)) * points / counts[m];
      for (uint64_t i = before; i < after; ++i)
        found.push_back({id, object == no_object ? no_instance : any_instance(uses, object)});
    });
    return found;
  }

  uint32_t any_instance(const Uses& uses, uint32_t object) {
    const uint32_t count = uses.count(object);
    const auto chosen = static_cast<uint32_t>(random() * static_cast<Real>(count));
    return uses.instances[uses.first[object] + std::min(chosen, count - 1)];
  }

  Real random() { return unit_interval<Real>(mix32(++random_count_)); }

  /// The candidate as the hit of a ray at the start of the shutter interval. Shapes other than triangles are hit from
  /// the middle of their box; there is no hit if a few rays in random directions miss, as they may miss shapes with
  /// holes.
  std::optional<SurfaceInteraction<Real>> point_on(const Candidate& candidate, Hit<Real>& hit) {
    const PrimitiveId primitive = candidate.primitive;
    hit = {Real(0), Real(0), Real(0), primitive, candidate.instance};
    Ray<Real> ray{};
    if (primitive.kind() == PrimitiveKind::triangle) {
      const Vec2<Real> b = sample_triangle(Vec2<Real>{random(), random()});
      hit.b1 = b.y;
      hit.b2 = 1 - b.x - b.y;
      return surface_interaction(view_, ray, hit);
    }
    ray.origin =
        visit_primitive(view_, primitive, [&](const auto& r) { return bounds_at(view_, r, ray.time); }).centre();
    for (int i = 0; i < max_tries; ++i) {
      ray.direction = sample_uniform_sphere(Vec2<Real>{random(), random()});
      hit.t = infinity<Real>;
      if (intersect_primitive(view_, primitive, ray, ShearedRay<Real>{}, hit))
        return surface_interaction(view_, ray, hit);
    }
    return {};
  }

  bool is_cut_out(const Hit<Real>& hit, const SurfaceInteraction<Real>& si) const {
    const MaterialRecord<Real>& material = material_of_hit(view_, hit);
    return (material.features & MaterialFeatures::cutout) &&
           opacity(view_, material, Ray<Real>{}, hit, si, RayKind::scattered) < Real(0.5);
  }

  /// Fractions of the light incident on a material.
  struct Tally {
    double incident = 0, sharp = 0, lost = 0;
    LostLight where;
  };

  std::optional<LostLight> lost_of(const LightRecord<Real>& light) {
    tallies_.assign(view_.materials_count, {});
    for (const Candidate& candidate : candidates_) light_candidate(light, candidate);
    if (!light_traits(light.kind).is_at_infinity)
      for (uint32_t i = 0; i < rays_per_light; ++i) send_ray(light);
    for (const Tally& tally : tallies_)
      if (tally.lost > min_lost * tally.incident && tally.sharp > min_sharp * tally.incident) return tally.where;
    return lost_straight(light);
  }

  /// Returns whether light that shines straight through glass is lost. Few of the rays through a large pane may reach a
  /// small surface behind it, so points of that surface are looked at.
  std::optional<LostLight> lost_straight(const LightRecord<Real>& light) {
    uint32_t lost = 0;
    LostLight where;
    for (const Candidate& receiver : receivers_)
      if (const std::optional<uint32_t> glass = glass_before(light, receiver)) {
        where.surface = *glass;
        ++lost;
      }
    if (lost > min_lost * static_cast<double>(receivers_.size())) return where;
    return {};
  }

  /// Returns the surface of the glass next to a point that would be lit, and not be black, if only glass were not in
  /// the way.
  std::optional<uint32_t> glass_before(const LightRecord<Real>& light, const Candidate& receiver) {
    Hit<Real> hit;
    const std::optional<SurfaceInteraction<Real>> si = point_on(receiver, hit);
    if (!si || is_cut_out(hit, *si)) return {};
    const LightSample<Real> s =
        sample_chosen_light(view_, light, si->position, Vec3<Real>{}, false, Real(0), Vec2<Real>{});
    if (!(s.pdf > 0) || is_zero(s.radiance)) return {};
    const ShadowRay<Real> shadow = shadow_ray(*si, s);
    if (visibility_of(view_, intersector_, shadow) > 0) return {};
    const ShadingPoint<Real> point = shading_point(view_, ray_from_light(s, *si, hit), hit);
    const BsdfSample<Real> scattered = sample_bsdf(point.bsdf, point.wo, random(), Vec2<Real>{random(), random()});
    if (!(scattered.pdf > 0) || is_zero(scattered.weight)) return {};
    return first_glass(shadow);
  }

  /// Returns the first of the surfaces that a shadow ray meets if all of them transmit light sharply, else nothing. The
  /// path has the segment from the camera before, and one more than there are surfaces.
  std::optional<uint32_t> first_glass(const ShadowRay<Real>& shadow) {
    std::optional<uint32_t> first;
    Ray<Real> ray = shadow.ray;
    Real left = shadow.t_max;
    for (uint32_t segments = 2; segments <= max_segments_; ++segments) {
      Hit<Real> hit;
      Real travelled = 0;
      if (!closest_stop(view_, intersector_, RayKind::scattered, ray, hit, travelled)) return first;
      left -= travelled + hit.t;
      if (!(left > 0)) return first;
      const ShadingPoint<Real> point = shading_point(view_, ray, hit);
      if (!transmits_sharply(point)) return {};
      if (!first) first = point.si.surface;
      ray = spawn_ray(point.si, ray.direction);
    }
    return {};
  }

  /// Looks from straight above the surface: light that is refracted leaves a pane as it came, but straight within the
  /// glass it might be reflected totally.
  bool transmits_sharply(const ShadingPoint<Real>& point) {
    const Vec3<Real> above = face_forward(point.si.normal, point.wo);
    double transmitted = 0;
    for (uint32_t i = 0; i < directions_per_point; ++i) {
      const Real u_lobe = (static_cast<Real>(i) + Real(0.5)) / directions_per_point;
      const BsdfSample<Real> s = sample_bsdf(point.bsdf, above, u_lobe, Vec2<Real>{random(), random()});
      if (is_sharp(s) && dot(s.direction, above) < 0)
        transmitted += static_cast<double>(max_component(s.weight)) / directions_per_point;
    }
    return transmitted > min_sharp;
  }

  /// Returns the shadow ray in reverse, and sets the distance of its hit.
  static Ray<Real> ray_from_light(const LightSample<Real>& s, const SurfaceInteraction<Real>& si, Hit<Real>& hit) {
    hit.t = s.is_finite ? length(s.point - si.position) : Real(1);
    return {si.position + s.direction * hit.t, -s.direction, Real(0)};
  }

  /// Tests light on a point of a surface that is known to be smooth, which may be small and far away.
  void light_candidate(const LightRecord<Real>& light, const Candidate& candidate) {
    Hit<Real> hit;
    const std::optional<SurfaceInteraction<Real>> found = point_on(candidate, hit);
    if (!found || is_cut_out(hit, *found)) return;
    const SurfaceInteraction<Real>& si = *found;
    const LightSample<Real> s =
        sample_chosen_light(view_, light, si.position, Vec3<Real>{}, false, Real(0), Vec2<Real>{});
    if (!(s.pdf > 0) || is_zero(s.radiance)) return;
    if (!(visibility_of(view_, intersector_, shadow_ray(si, s)) > 0)) return;
    follow(ray_from_light(s, si, hit), hit);
  }

  Vec3<Real> direction_from(const LightRecord<Real>& light, const Vec2<Real>& u) const {
    switch (light.kind) {
#define ALHAZEN_CASE(name, Name) \
  case LightKind::name:          \
    return Name##Light::sample_emission(view_, light, u);
      ALHAZEN_LIGHTS(ALHAZEN_CASE)
#undef ALHAZEN_CASE
      default:
        return {};
    }
  }

  /// Tests light on the first hit in a direction of emission, so that narrow cones on large surfaces count.
  void send_ray(const LightRecord<Real>& light) {
    const Vec2<Real> u{random(), random()};
    Ray<Real> ray{light.position, direction_from(light, u), Real(0)};
    Hit<Real> hit;
    Real travelled = 0;
    if (!closest_stop(view_, intersector_, RayKind::scattered, ray, hit, travelled)) return;
    const SurfaceInteraction<Real> si = surface_interaction(view_, ray, hit);
    if (is_zero(sample_chosen_light(view_, light, si.position, Vec3<Real>{}, false, Real(0), u).radiance)) return;
    if (may_be_sharp(view_.materials[view_.surfaces[si.surface].material].kind)) follow(ray, hit);
  }

  /// Follows light arriving along `ray` at `hit` in all directions into which it is scattered.
  void follow(const Ray<Real>& ray, const Hit<Real>& hit) {
    const ShadingPoint<Real> point = shading_point(view_, ray, hit);
    Tally& tally = tallies_[view_.surfaces[point.si.surface].material];
    const double incident = static_cast<double>(abs_dot(point.si.normal, point.wo)), before = tally.lost;
    for (uint32_t i = 0; i < directions_per_point; ++i) {
      const Real u_lobe = (static_cast<Real>(i) + Real(0.5)) / directions_per_point;
      const BsdfSample<Real> s = sample_bsdf(point.bsdf, point.wo, u_lobe, Vec2<Real>{random(), random()});
      tally.incident += incident;
      if (!is_sharp(s)) continue;
      const double sent = incident * static_cast<double>(max_component(s.weight));
      tally.sharp += sent;
      if (is_lost(spawn_ray(point.si, s.direction))) tally.lost += sent;
    }
    if (before > 0 || !(tally.lost > 0)) return;
    tally.where.surface = point.si.surface;
    tally.where.is_mirror = has_trait<&MaterialTraits::is_bare_metal>(point.bsdf.kind);
  }

  static bool is_sharp(const BsdfSample<Real>& s) {
    return s.pdf > 0 && !is_zero(s.weight) && (s.specular || static_cast<double>(s.pdf) > sharp_pdf);
  }

  /// Returns whether light along `ray`, scattered by one smooth surface, reaches a surface that scatters it diffusely.
  /// A path has a segment from the camera to that surface, one for each smooth surface and one to the light.
  bool is_lost(Ray<Real> ray) {
    for (uint32_t segments = 3; segments <= max_segments_; ++segments) {
      Hit<Real> hit;
      Real travelled = 0;
      if (!closest_stop(view_, intersector_, RayKind::scattered, ray, hit, travelled)) return false;
      const ShadingPoint<Real> point = shading_point(view_, ray, hit);
      const BsdfSample<Real> s = sample_bsdf(point.bsdf, point.wo, random(), Vec2<Real>{random(), random()});
      if (!(s.pdf > 0) || is_zero(s.weight)) return false;
      if (!is_sharp(s)) return true;
      ray = spawn_ray(point.si, s.direction);
    }
    return false;
  }

  const SceneView<Real>& view_;
  Bvh2Intersector<Real> intersector_;
  uint32_t max_segments_;
  std::vector<Candidate> candidates_;  ///< points of surfaces that may be smooth
  std::vector<Candidate> receivers_;   ///< points of others
  std::vector<Tally> tallies_;         ///< by material
  uint32_t random_count_ = 0;
};

bool has_no_size(const Light& light) { return is_without_size(light.kind) && !is_zero(light.radiance); }

}  // namespace

template <class Real>
bool may_lose_light(const SceneView<Real>& view) {
  const auto is_light = [](const LightRecord<Real>& light) { return is_without_size(light.kind); };
  const auto is_smooth = [&](const SurfaceRecord& s) { return may_be_sharp(view.materials[s.material].kind); };
  return std::any_of(view.lights, view.lights + view.lights_count, is_light) &&
         std::any_of(view.surfaces, view.surfaces + view.surfaces_count, is_smooth);
}

template bool may_lose_light(const SceneView<float>&);
template bool may_lose_light(const SceneView<double>&);

void warn_of_lost_light(const LostLight& lost, const Scene& scene, const SourceLocation& where,
                        Diagnostics& diagnostics) {
  uint32_t before = lost.light;
  const auto light = std::find_if(scene.lights.begin(), scene.lights.end(),
                                  [&](const Light& l) { return has_no_size(l) && before-- == 0; });
  if (light == scene.lights.end()) return;
  std::string message =
      std::string("light of this ") + light_traits(light->kind).name + " is lost at the " +
      (lost.is_mirror ? "mirror " : "glass ") + where.to_string() +
      ": 'path' connects lights without area to surfaces by straight shadow rays alone, not through glass or "
      "by mirrors";
  if (!scene.replaced_integrator.empty())
    message += ", as the \"" + scene.replaced_integrator + "\" that the file asks for would";
  message += light_traits(light->kind).is_at_infinity
                 ? "; one that has a size is found (in pbrt files \"float angle\" 0.53)"
                 : "; a small emissive shape in its place is found";
  if (lost.others > 0)
    message += std::string(" (as for ") + (lost.others_may_be_more ? "at least " : "") + std::to_string(lost.others) +
               (lost.others == 1 ? " other)" : " others)");
  diagnostics.warn(light->where, message);
}

template <class Real>
std::optional<LostLight> find_lost_light(const SceneView<Real>& view, uint32_t max_segments) {
  return LostLightSearch<Real>(view, max_segments).run();
}

template std::optional<LostLight> find_lost_light(const SceneView<float>&, uint32_t);
template std::optional<LostLight> find_lost_light(const SceneView<double>&, uint32_t);

}  // namespace alhazen::impl
