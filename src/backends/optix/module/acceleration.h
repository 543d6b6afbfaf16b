#pragma once

// Builds acceleration structures from the scene on the device: one geometry structure per kind of primitive and per
// object, compacted, and an instance structure above them if there is more than one.

#include <array>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <vector>

#include "backends/cuda/executor.h"
#include "backends/optix/module/library.h"
#include "backends/optix/module/params.h"
#include "core/scene_view.h"
#include "core/shapes/primitives.h"

namespace alhazen::impl::optix {

inline CUdeviceptr address(const void* pointer) { return reinterpret_cast<CUdeviceptr>(pointer); }

/// The features of a scene that decide how the programs are compiled.
struct SceneTraits {
  bool has[primitive_kinds];  ///< by PrimitiveKind, in the world or in objects
  bool has_objects;           ///< whether instances place objects

  explicit SceneTraits(const SceneView<float>& scene)
      : has{
#define ALHAZEN_HAS(X, kind, Record, records, Block, blocks) scene.records##_count > 0,
            ALHAZEN_PRIMITIVES(ALHAZEN_HAS, )
#undef ALHAZEN_HAS
        },
        has_objects(scene.instances_count > 0) {
  }
  bool has_kind(PrimitiveKind kind) const { return has[static_cast<unsigned>(kind)]; }
  bool moves() const { return has_kind(PrimitiveKind::moving_sphere); }
  bool has_spheres() const { return has_kind(PrimitiveKind::sphere) || moves(); }
  bool has_custom() const {
    for (unsigned kind = 0; kind < primitive_kinds; ++kind)
      if (has[kind] && !is_built_in(static_cast<PrimitiveKind>(kind))) return true;
    return false;
  }
  int kinds() const {
    int count = 0;
    for (const bool has_this : has) count += has_this;
    return count;
  }
  bool has_instances() const { return kinds() > 1 || has_objects; }
};

inline constexpr unsigned build_flags = OPTIX_BUILD_FLAG_ALLOW_COMPACTION | OPTIX_BUILD_FLAG_PREFER_FAST_TRACE;

template <cuda::KernelExecutor Executor>
class Acceleration {
 public:
  Acceleration(const OptixFunctionTable& functions, Executor& executor)
      : functions_(functions),
        executor_(executor),
        structures_{
#define ALHAZEN_STRUCTURE(X, kind, Record, records, Block, blocks) Bytes(executor),
            ALHAZEN_PRIMITIVES(ALHAZEN_STRUCTURE, )
#undef ALHAZEN_STRUCTURE
        },
        top_(executor) {
  }

  /// `host` and `device` are views of the same scene in host and device memory. Throws UnsupportedError if meshes
  /// move.
  void build(OptixDeviceContext context, const SceneView<float>& host, const SceneView<float>& device) {
    if (host.instance_motions_count > 0)
      throw UnsupportedError("OptiX: moving meshes are not supported; render with --backend cuda");
    context_ = context;
    traversable_ = 0;
    sbt_offset_ = 0;
    const SceneTraits traits(host);
    std::vector<OptixInstance> instances;
    for (unsigned kind = 0; kind < structures_.size(); ++kind) {
      if (!traits.has[kind] || (kind == 0 && triangles_in_world(host) == 0)) continue;
      traversable_ = build_kind(static_cast<PrimitiveKind>(kind), host, device);
      sbt_offset_ = kind;
      OptixInstance instance{
          {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, kind, kind, 0xff, OPTIX_INSTANCE_FLAG_NONE, traversable_, {}};
      instances.push_back(instance);
    }
    if (!traits.has_instances()) return;
    sbt_offset_ = 0;
    add_objects(host, device, instances);
    build_instances(instances);
  }

  OptixTraversableHandle traversable() const { return traversable_; }  ///< 0 if there is nothing to hit
  uint32_t sbt_offset() const { return sbt_offset_; }

 private:
  using Bytes = cuda::Buffer<Executor, std::byte>;

  OptixTraversableHandle build_kind(PrimitiveKind kind, const SceneView<float>& host, const SceneView<float>& device) {
    switch (kind) {
      case PrimitiveKind::triangle:
        return build_triangles(device, 0, triangles_in_world(host), structures_[0]);
      case PrimitiveKind::sphere:
        return build_spheres(device);
      case PrimitiveKind::moving_sphere:
        return build_moving_spheres(host, device);
      default:
        return build_custom(kind, host);
    }
  }

  static uint32_t triangles_in_world(const SceneView<float>& host) {
    return host.objects_count > 0 ? host.objects[0].first_triangle : host.triangles_count;
  }

  void add_objects(const SceneView<float>& host, const SceneView<float>& device,
                   std::vector<OptixInstance>& instances) {
    objects_.clear();
    std::vector<OptixTraversableHandle> handles;
    for (uint32_t i = 0; i < host.objects_count; ++i) {
      objects_.push_back(std::make_unique<Bytes>(executor_));
      const ObjectRecord& object = host.objects[i];
      handles.push_back(build_triangles(device, object.first_triangle, object.triangle_count, *objects_.back()));
    }
    for (uint32_t i = 0; i < host.instances_count; ++i) {
      OptixInstance instance{
          {}, first_instance_id + i, 0, 0xff, OPTIX_INSTANCE_FLAG_NONE, handles[host.instances[i].object], {}};
      std::memcpy(instance.transform, host.instances[i].world_from_object, sizeof(instance.transform));
      instances.push_back(instance);
    }
  }

  OptixTraversableHandle build_triangles(const SceneView<float>& device, uint32_t first, uint32_t count,
                                         Bytes& structure) {
    const CUdeviceptr positions = address(device.positions);
    OptixBuildInput input{};
    input.type = OPTIX_BUILD_INPUT_TYPE_TRIANGLES;
    OptixBuildInputTriangleArray& triangles = input.triangleArray;
    triangles.vertexBuffers = &positions;
    triangles.numVertices = device.positions_count;
    triangles.vertexFormat = OPTIX_VERTEX_FORMAT_FLOAT3;
    triangles.vertexStrideInBytes = sizeof(Vec3<float>);
    triangles.indexBuffer = address(device.triangles + first) + offsetof(TriangleRecord, vertex);
    triangles.numIndexTriplets = count;
    triangles.indexFormat = OPTIX_INDICES_FORMAT_UNSIGNED_INT3;
    triangles.indexStrideInBytes = sizeof(TriangleRecord);
    triangles.flags = &without_any_hit;
    triangles.numSbtRecords = 1;
    return build_structure(input, 1, structure);
  }

  OptixTraversableHandle build_spheres(const SceneView<float>& device) {
    using Record = SphereRecord<float>;
    const CUdeviceptr centres = address(device.spheres) + offsetof(Record, centre);
    const CUdeviceptr radii = address(device.spheres) + offsetof(Record, radius);
    return build_structure(sphere_input<Record>(&centres, &radii, device.spheres_count), 1, structures_[1]);
  }

  /// Uses two motion keys, at the ends of the shutter. The centres of the second key are displaced by the motion.
  OptixTraversableHandle build_moving_spheres(const SceneView<float>& host, const SceneView<float>& device) {
    using Record = MovingSphereRecord<float>;
    const uint32_t count = host.moving_spheres_count;
    // Both keys have the same stride, so the second key is an array of records too, although OptiX reads only the
    // centres.
    std::vector<Record> last(host.moving_spheres, host.moving_spheres + count);
    for (Record& sphere : last) sphere.centre += sphere.motion;
    cuda::Buffer<Executor, Record> memory(executor_);
    memory.reserve(count);
    executor_.upload(memory.data(), last.data(), count * sizeof(Record));
    const CUdeviceptr centres[2] = {address(device.moving_spheres) + offsetof(Record, centre),
                                    address(memory.data()) + offsetof(Record, centre)};
    const CUdeviceptr radius = address(device.moving_spheres) + offsetof(Record, radius);
    const CUdeviceptr radii[2] = {radius, radius};
    return build_structure(sphere_input<Record>(centres, radii, count), 2, structures_[2]);
  }

  /// Centres and radii are fields of records. There is one address of each per motion key.
  template <class Record>
  OptixBuildInput sphere_input(const CUdeviceptr* centres, const CUdeviceptr* radii, uint32_t count) const {
    OptixBuildInput input{};
    input.type = OPTIX_BUILD_INPUT_TYPE_SPHERES;
    OptixBuildInputSphereArray& spheres = input.sphereArray;
    spheres.vertexBuffers = centres;
    spheres.vertexStrideInBytes = sizeof(Record);
    spheres.numVertices = count;
    spheres.radiusBuffers = radii;
    spheres.radiusStrideInBytes = sizeof(Record);
    spheres.flags = &without_any_hit;
    spheres.numSbtRecords = 1;
    return input;
  }

  /// Boxes of the primitives of a kind that is not built in.
  OptixTraversableHandle build_custom(PrimitiveKind kind, const SceneView<float>& host) {
    std::vector<OptixAabb> boxes;
    const auto add = [&](const auto& record) {
      const Bounds3<float> box = bounds_of(host, record);
      boxes.push_back({box.low.x, box.low.y, box.low.z, box.high.x, box.high.y, box.high.z});
    };
#define ALHAZEN_BOXES(X, listed, Record, records, Block, blocks) \
  for (uint32_t i = 0; kind == PrimitiveKind::listed && i < host.records##_count; ++i) add(host.records[i]);
    ALHAZEN_PRIMITIVES(ALHAZEN_BOXES, )
#undef ALHAZEN_BOXES
    cuda::Buffer<Executor, OptixAabb> memory(executor_);
    memory.reserve(boxes.size());
    executor_.upload(memory.data(), boxes.data(), boxes.size() * sizeof(OptixAabb));
    const CUdeviceptr buffer = address(memory.data());
    OptixBuildInput input{};
    input.type = OPTIX_BUILD_INPUT_TYPE_CUSTOM_PRIMITIVES;
    input.customPrimitiveArray.aabbBuffers = &buffer;
    input.customPrimitiveArray.numPrimitives = static_cast<unsigned>(boxes.size());
    input.customPrimitiveArray.flags = &without_any_hit;
    input.customPrimitiveArray.numSbtRecords = 1;
    return build_structure(input, 1, structures_[static_cast<unsigned>(kind)]);
  }

  void build_instances(const std::vector<OptixInstance>& instances) {
    cuda::Buffer<Executor, OptixInstance> memory(executor_);
    memory.reserve(instances.size());
    executor_.upload(memory.data(), instances.data(), instances.size() * sizeof(OptixInstance));
    OptixBuildInput input{};
    input.type = OPTIX_BUILD_INPUT_TYPE_INSTANCES;
    input.instanceArray.instances = address(memory.data());
    input.instanceArray.numInstances = static_cast<unsigned>(instances.size());
    traversable_ = build_structure(input, 1, top_);
  }

  /// Builds a structure and compacts it. The input may be freed when the function returns.
  OptixTraversableHandle build_structure(const OptixBuildInput& input, unsigned motion_keys, Bytes& structure) {
    OptixAccelBuildOptions options{};
    options.buildFlags = build_flags;
    options.operation = OPTIX_BUILD_OPERATION_BUILD;
    options.motionOptions.numKeys = static_cast<unsigned short>(motion_keys);
    options.motionOptions.timeEnd = motion_keys > 1 ? 1.0f : 0.0f;
    OptixAccelBufferSizes sizes{};
    check(functions_, functions_.optixAccelComputeMemoryUsage(context_, &options, &input, 1, &sizes), building);
    Bytes scratch(executor_), first(executor_);
    cuda::Buffer<Executor, uint64_t> size_memory(executor_);
    scratch.reserve(sizes.tempSizeInBytes);
    first.reserve(sizes.outputSizeInBytes);
    size_memory.reserve(1);
    const OptixAccelEmitDesc emitted{address(size_memory.data()), OPTIX_PROPERTY_TYPE_COMPACTED_SIZE};
    OptixTraversableHandle handle = 0;
    check(functions_,
          functions_.optixAccelBuild(context_, executor_.stream(), &options, &input, 1, address(scratch.data()),
                                     sizes.tempSizeInBytes, address(first.data()), sizes.outputSizeInBytes, &handle,
                                     &emitted, 1),
          building);
    uint64_t compacted = 0;
    executor_.download(&compacted, size_memory.data(), sizeof(compacted));
    structure.reset();
    structure.reserve(compacted);
    check(functions_,
          functions_.optixAccelCompact(context_, executor_.stream(), handle, address(structure.data()), compacted,
                                       &handle),
          building);
    executor_.wait();
    return handle;
  }

  static constexpr const char* building = "building its acceleration structures";
  static constexpr unsigned without_any_hit = OPTIX_GEOMETRY_FLAG_DISABLE_ANYHIT;

  const OptixFunctionTable& functions_;
  Executor& executor_;
  OptixDeviceContext context_ = nullptr;
  std::array<Bytes, primitive_kinds> structures_;
  std::vector<std::unique_ptr<Bytes>> objects_;
  Bytes top_;
  OptixTraversableHandle traversable_ = 0;
  uint32_t sbt_offset_ = 0;
};

}  // namespace alhazen::impl::optix
