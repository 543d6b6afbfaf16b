#include "backends/embree/module/scene.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "core/shapes/instance.h"
#include "core/shapes/primitives.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

namespace {

/// Returns the box, padded by the rounding error of Embree's arithmetic.
Bounds3<float> padded(const Bounds3<float>& box) {
  const Vec3<float> slack = max(abs(box.low), abs(box.high)) * 4e-7f;
  return {box.low - slack, box.high + slack};
}

// Kinds of primitives that Embree does not know are its user geometry: it finds the boxes that a ray enters, and our
// own test finds the hit.

template <PrimitiveKind kind>
void bounds_of_user_geometry(const RTCBoundsFunctionArguments* arguments) {
  const SceneView<float>& scene = *static_cast<const SceneView<float>*>(arguments->geometryUserPtr);
  const Bounds3<float> padded_box =
      padded(bounds_at(scene, records_of<kind>(scene)[arguments->primID], static_cast<float>(arguments->timeStep)));
  RTCBounds& box = *arguments->bounds_o;
  box.lower_x = padded_box.low.x;
  box.lower_y = padded_box.low.y;
  box.lower_z = padded_box.low.z;
  box.upper_x = padded_box.high.x;
  box.upper_y = padded_box.high.y;
  box.upper_z = padded_box.high.z;
}

template <PrimitiveKind kind>
bool intersect(const void* view, uint32_t index, const RTCRay& query, float& t) {
  const SceneView<float>& scene = *static_cast<const SceneView<float>*>(view);
  const Ray<float> ray{{query.org_x, query.org_y, query.org_z}, {query.dir_x, query.dir_y, query.dir_z}, query.time};
  Hit<float> hit;
  if (!intersect_record(scene, records_of<kind>(scene)[index], {kind, index}, ray, ShearedRay<float>{}, query.tfar,
                        hit))
    return false;
  t = hit.t;
  return true;
}

template <PrimitiveKind kind>
void intersect_user_geometry(const RTCIntersectFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;
  RTCRayHit& query = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);  // all queries are single rays
  float t;
  if (!intersect<kind>(arguments->geometryUserPtr, arguments->primID, query.ray, t)) return;
  query.ray.tfar = t;
  query.hit.u = query.hit.v = 0;
  query.hit.geomID = arguments->geomID;
  query.hit.primID = arguments->primID;
}

template <PrimitiveKind kind>
void occluded_user_geometry(const RTCOccludedFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;
  RTCRay& query = *reinterpret_cast<RTCRay*>(arguments->ray);
  float t;
  if (intersect<kind>(arguments->geometryUserPtr, arguments->primID, query, t)) query.tfar = -infinity<float>;
}

/// Returns the distance to the triangle's plane along the ray, negative if behind. It is computed in double.
double plane_distance(const Ray<float>& ray, const Vec3<float>& a, const Vec3<float>& b, const Vec3<float>& c) {
  const Vec3d p = convert<double>(a);
  const Vec3d normal = cross(convert<double>(b) - p, convert<double>(c) - p);
  return dot(normal, p - convert<double>(ray.origin)) / dot(normal, convert<double>(ray.direction));
}

/// Returns the largest coordinate of the ray's origin, as a distance along the ray.
double reach_of_origin(const Ray<float>& ray) {
  return static_cast<double>(max_component(abs(ray.origin)) / length(ray.direction));
}

/// Distance beyond which a ray is clear of the surface that it starts on, relative to its origin's largest coordinate.
constexpr double min_relative_distance = 1e-6;

/// Rejects the triangle that the ray starts on. Near the ray's origin, it accepts only hits that our own test confirms,
/// so that rays do not hit adjacent triangles either. Farther away it accepts Embree's hits up to the end of the ray:
/// at a shared edge, our test and Embree may hit different triangles, and rejecting both would leave a hole. Within an
/// instance, the ray is transformed to object space again with our own arithmetic.
void filter_triangle(const RTCFilterFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;
  const SceneView<float>& scene = *static_cast<const SceneView<float>*>(arguments->geometryUserPtr);
  const EmbreeQuery& query = *reinterpret_cast<const EmbreeQuery*>(arguments->context);
  const uint32_t placed = query.context.instID[0];
  uint32_t index = reinterpret_cast<const RTCHit*>(arguments->hit)->primID;
  Ray<float> ray = *query.ray;
  if (placed != RTC_INVALID_GEOMETRY_ID) {
    const uint32_t instance = placed - embree_instances;
    ray = object_ray(scene, instance, ray);
    index += scene.objects[scene.instances[instance].object].first_triangle;
  }
  const uint32_t* v = scene.triangles[index].vertex;
  const Vec3<float>&a = scene.positions[v[0]], &b = scene.positions[v[1]], &c = scene.positions[v[2]];
  const ShearedRay<float> sheared = shear_ray(ray, scene.has_narrow_triangles);
  if (sheared.left == PrimitiveId(PrimitiveKind::triangle, index)) {
    arguments->valid[0] = 0;
    return;
  }
  float t, b1, b2;
  if (intersect_triangle(sheared, a, b, c, query.t_max, t, b1, b2)) return;
  const double distance = plane_distance(ray, a, b, c);
  const double reach = std::max(reach_of_origin(*query.ray), reach_of_origin(ray));
  if (!(distance > min_relative_distance * reach && distance <= static_cast<double>(query.t_max)))
    arguments->valid[0] = 0;
}

/// Returns half the extent of a box centred at the origin that holds these triangles.
Vec3<float> reach_of_triangles(const SceneView<float>& view, uint32_t first, uint32_t count) {
  Vec3<float> reach{};
  for (uint32_t i = first; i < first + count; ++i)
    for (const uint32_t vertex : view.triangles[i].vertex) reach = max(reach, abs(view.positions[vertex]));
  return reach;
}

/// Returns the same for the camera and the primitives of the world, not counting instances.
Vec3<float> reach_of_world(const SceneView<float>& view, uint32_t triangles) {
  const auto& camera = view.camera.world_from_camera;
  Vec3<float> reach =
      max(reach_of_triangles(view, 0, triangles), abs(Vec3<float>{camera[0][3], camera[1][3], camera[2][3]}));
  const auto add = [&](const auto& record) {
    const Bounds3<float> box = bounds_of(view, record);
    reach = max(reach, max(abs(box.low), abs(box.high)));
  };
#define ALHAZEN_REACH(X, kind, Record, records, Block, blocks)                                          \
  for (uint32_t i = 0; PrimitiveKind::kind != PrimitiveKind::triangle && i < view.records##_count; ++i) \
    add(view.records[i]);
  ALHAZEN_PRIMITIVES(ALHAZEN_REACH, )
#undef ALHAZEN_REACH
  return reach;
}

/// Extent below which Embree has been observed to lose triangles, due to the limited precision of its arithmetic.
constexpr float min_embree_extent = 1e-8f;

/// Returns whether triangles are too small for Embree. An empty set is not.
bool is_too_small(const Vec3<float>& reach) {
  const float extent = max_component(reach);
  return extent > 0 && extent < min_embree_extent;
}

/// Returns whether the whole scene is within Embree's range in world space and in each object space, with a margin for
/// rounding.
bool is_in_range(const SceneView<float>& view, uint32_t triangles_in_world) {
  const std::array<float, 2> ends{0.0f, 1.0f};
  Vec3<float> world = reach_of_world(view, triangles_in_world), inside{};
  if (is_too_small(reach_of_triangles(view, 0, triangles_in_world))) return false;
  std::vector<Vec3<float>> objects;
  for (uint32_t i = 0; i < view.objects_count; ++i) {
    objects.push_back(reach_of_triangles(view, view.objects[i].first_triangle, view.objects[i].triangle_count));
    if (is_too_small(objects.back())) return false;
    inside = max(inside, objects.back());
  }
  for (uint32_t i = 0; i < view.instances_count; ++i)
    for (const float time : ends)
      world = max(world, transformed_magnitude(instance_at(view, i, time).world_from_object,
                                               objects[view.instances[i].object]));
  for (uint32_t i = 0; i < view.instances_count; ++i)
    for (const float time : ends)
      inside = max(inside, transformed_magnitude(instance_at(view, i, time).object_from_world, world));
  return max_component(max(world, inside)) <= max_embree_coordinate / 2;
}

bool count_bytes(void* bytes, ssize_t change, bool) {
  // The threads of the builder call this concurrently.
  __atomic_fetch_add(static_cast<int64_t*>(bytes), static_cast<int64_t>(change), __ATOMIC_RELAXED);
  return true;
}

}  // namespace

template <PrimitiveKind kind>
void EmbreeScene::add_user_geometry(uint32_t count) {
  if constexpr (kind != PrimitiveKind::triangle) {
    if (count == 0) return;
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, count);
    rtcSetGeometryTimeStepCount(geometry, MovingRecord<decltype(records_of<kind>(view_)[0])> ? 2 : 1);
    rtcSetGeometryUserData(geometry, const_cast<SceneView<float>*>(&view_));
    rtcSetGeometryBoundsFunction(geometry, bounds_of_user_geometry<kind>, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect_user_geometry<kind>);
    rtcSetGeometryOccludedFunction(geometry, occluded_user_geometry<kind>);
    attach(tracer_.scene, geometry, kind);
  }
}

EmbreeScene::EmbreeScene(const SceneView<float>& view, int threads) : view_(view) {
  const uint32_t in_world = view.objects_count > 0 ? view.objects[0].first_triangle : view.triangles_count;
  if (!is_in_range(view, in_world))
    throw InputError(
        "the scene has points farther than 9e17 from the origin of the world or of an object in it, or all of them are "
        "within 1e-8, which Embree does not take: use another backend, such as --backend openmp");
  device_ = rtcNewDevice(threads > 0 ? ("threads=" + std::to_string(threads)).c_str() : nullptr);
  check();
  rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, &bytes_);
  tracer_.scene = new_scene();
  if (in_world > 0) add_triangles(tracer_.scene, 0, in_world);
  if (view.instances_count > 0) add_instances();
#define ALHAZEN_ADD(X, kind, Record, records, Block, blocks) \
  add_user_geometry<PrimitiveKind::kind>(view.records##_count);
  ALHAZEN_PRIMITIVES(ALHAZEN_ADD, )
#undef ALHAZEN_ADD
  rtcCommitScene(tracer_.scene);
  check();
}

RTCScene EmbreeScene::new_scene() {
  const RTCScene scene = rtcNewScene(device_);
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  return scene;
}

EmbreeScene::~EmbreeScene() {
  rtcReleaseScene(tracer_.scene);
  for (const RTCScene object : objects_) rtcReleaseScene(object);
  rtcReleaseDevice(device_);
}

void EmbreeScene::add_triangles(RTCScene to, uint32_t first, uint32_t count) {
  const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  // The vertex indices are the first words of a record. Embree reads 4 bytes beyond the last position, which are within
  // the arena.
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, view_.triangles + first, 0,
                             sizeof(TriangleRecord), count);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, view_.positions, 0,
                             sizeof(Vec3<float>), view_.positions_count);
  rtcSetGeometryUserData(geometry, const_cast<SceneView<float>*>(&view_));
  rtcSetGeometryIntersectFilterFunction(geometry, filter_triangle);
  rtcSetGeometryOccludedFilterFunction(geometry, filter_triangle);
  attach(to, geometry, PrimitiveKind::triangle);
}

void EmbreeScene::add_instances() {
  for (uint32_t i = 0; i < view_.objects_count; ++i) {
    objects_.push_back(new_scene());
    add_triangles(objects_.back(), view_.objects[i].first_triangle, view_.objects[i].triangle_count);
    rtcCommitScene(objects_.back());
  }
  for (uint32_t i = 0; i < view_.instances_count; ++i) {
    const InstanceRecord<float>& instance = view_.instances[i];
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, objects_[instance.object]);
    const InstanceRecord<float> closing = instance_at(view_, i, 1.0f);
    rtcSetGeometryTimeStepCount(geometry, instance.motion == no_motion ? 1 : 2);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, instance.world_from_object);
    if (instance.motion != no_motion)
      rtcSetGeometryTransform(geometry, 1, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, closing.world_from_object);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(tracer_.scene, geometry, embree_instances + i);
    rtcReleaseGeometry(geometry);
  }
}

void EmbreeScene::attach(RTCScene to, RTCGeometry geometry, PrimitiveKind kind) {
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(to, geometry, static_cast<unsigned int>(kind));
  rtcReleaseGeometry(geometry);
}

void EmbreeScene::check() const {
  const RTCError error = rtcGetDeviceError(device_);
  if (device_ && error == RTC_ERROR_NONE) return;
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw OutOfMemoryError("Embree is out of memory while it builds its BVH");
  if (error == RTC_ERROR_UNSUPPORTED_CPU)
    throw UnsupportedError("this processor lacks instructions that Embree needs: use the backend openmp");
  throw RenderError("Embree failed: error " + std::to_string(static_cast<int>(error)));
}

}  // namespace alhazen::impl
