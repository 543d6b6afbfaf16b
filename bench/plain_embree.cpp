#include "plain_embree.h"

#include <stdexcept>
#include <string>

namespace alhazen::impl {

PlainEmbree::PlainEmbree(const SceneView<float>& view, int threads)
    : device_(rtcNewDevice(("threads=" + std::to_string(threads)).c_str())) {
  tracer_.scene = rtcNewScene(device_);
  rtcSetSceneBuildQuality(tracer_.scene, RTC_BUILD_QUALITY_HIGH);
  if (view.triangles_count > 0) add_triangles(view);
  if (view.spheres_count > 0)
    add_spheres(view.spheres, view.spheres_count, 1,
                [](const SphereRecord<float>& sphere, unsigned int) { return sphere.centre; });
  if (view.moving_spheres_count > 0)
    add_spheres(view.moving_spheres, view.moving_spheres_count, 2,
                [](const MovingSphereRecord<float>& sphere, unsigned int step) {
                  return sphere.centre + sphere.motion * static_cast<float>(step);
                });
  rtcCommitScene(tracer_.scene);
  if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
    throw std::runtime_error("Embree refuses the scene, error " + std::to_string(static_cast<int>(error)));
}

PlainEmbree::~PlainEmbree() {
  rtcReleaseScene(tracer_.scene);
  rtcReleaseDevice(device_);
}

void PlainEmbree::add_triangles(const SceneView<float>& view) {
  const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, view.triangles, 0,
                             sizeof(TriangleRecord), view.triangles_count);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, view.positions, 0,
                             sizeof(Vec3<float>), view.positions_count);
  attach(geometry);
}

template <class Record, class At>
void PlainEmbree::add_spheres(const Record* spheres, uint32_t count, unsigned int time_steps, const At& centre_at) {
  const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  rtcSetGeometryTimeStepCount(geometry, time_steps);
  for (unsigned int step = 0; step < time_steps; ++step) {
    float* const vertex = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, step, RTC_FORMAT_FLOAT4, 4 * sizeof(float), count));
    for (uint32_t i = 0; i < count; ++i) {
      const Vec3<float> centre = centre_at(spheres[i], step);
      for (int axis = 0; axis < 3; ++axis) vertex[4 * i + static_cast<uint32_t>(axis)] = centre[axis];
      vertex[4 * i + 3] = spheres[i].radius;
    }
  }
  attach(geometry);
}

void PlainEmbree::attach(RTCGeometry geometry) {
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(tracer_.scene, geometry);
  rtcReleaseGeometry(geometry);
}

}  // namespace alhazen::impl
