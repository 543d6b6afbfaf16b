// The host code of the OptiX backend with a mock driver: a function table that records and checks its arguments, and
// runs launches on the CPU with our own BVH instead of optixTrace. The image has the bits of the serial backend.

#ifdef ALHAZEN_WITH_OPTIX

#include <algorithm>

#include "backends/cuda/device_render.h"
#include "backends/cuda/host_executor.h"
#include "backends/optix/module/denoiser.h"
#include "backends/optix/module/executor.h"
#include "compile/compile_scene.h"
#include "parity/scenes.h"

namespace alhazen::impl::optix {
namespace {

using namespace alhazen::impl::test;
using cuda::HostExecutor;

/// The calls to the driver, in order.
struct Calls {
  std::vector<OptixBuildInput> inputs;
  std::vector<OptixAccelBuildOptions> builds;
  std::vector<OptixInstance> instances;
  std::vector<Vec3<float>> first_centres, last_centres;  ///< of the moving spheres
  std::vector<OptixAabb> boxes;                          ///< of custom primitives
  std::vector<std::string> groups;                       ///< names of the programs
  std::vector<std::string> intersections;                ///< names of the intersection programs of our own
  std::vector<bool> sphere_modules_move;
  OptixPipelineCompileOptions pipeline{};
  std::vector<unsigned> payload_words;
  std::vector<Vec3<float>> corners;  ///< of all triangles, from vertex and index buffers
  int modules = 0, failures = 0, made = 0, destroyed = 0, launches = 0;
  OptixResult module_result = OPTIX_SUCCESS, build_result = OPTIX_SUCCESS, context_result = OPTIX_SUCCESS;
};
Calls calls;

template <class Handle>
Handle make_handle() {
  ++calls.made;
  return reinterpret_cast<Handle>(static_cast<uintptr_t>(calls.made));
}

template <class T>
T* pointer(CUdeviceptr address) {
  return reinterpret_cast<T*>(address);
}

/// An element of an array with a stride, at any address.
template <class T>
T element(CUdeviceptr base, unsigned stride, uint32_t index) {
  T value;
  std::memcpy(&value, pointer<const char>(base) + size_t{stride} * index, sizeof(T));
  return value;
}

void look_at(const OptixBuildInput& input) {
  if (input.type == OPTIX_BUILD_INPUT_TYPE_TRIANGLES) {
    const OptixBuildInputTriangleArray& t = input.triangleArray;
    for (uint32_t i = 0; i < t.numIndexTriplets; ++i)
      for (const uint32_t v : element<std::array<uint32_t, 3>>(t.indexBuffer, t.indexStrideInBytes, i)) {
        ASSERT_LT(v, t.numVertices);
        calls.corners.push_back(element<Vec3<float>>(t.vertexBuffers[0], t.vertexStrideInBytes, v));
      }
  } else if (input.type == OPTIX_BUILD_INPUT_TYPE_CUSTOM_PRIMITIVES) {
    const auto* first = pointer<const OptixAabb>(input.customPrimitiveArray.aabbBuffers[0]);
    calls.boxes.assign(first, first + input.customPrimitiveArray.numPrimitives);
  } else if (input.type == OPTIX_BUILD_INPUT_TYPE_INSTANCES) {
    const auto* first = pointer<const OptixInstance>(input.instanceArray.instances);
    calls.instances.assign(first, first + input.instanceArray.numInstances);
  }
}

void look_at_motion(const OptixBuildInputSphereArray& spheres) {
  for (uint32_t i = 0; i < spheres.numVertices; ++i) {
    calls.first_centres.push_back(element<Vec3<float>>(spheres.vertexBuffers[0], spheres.vertexStrideInBytes, i));
    calls.last_centres.push_back(element<Vec3<float>>(spheres.vertexBuffers[1], spheres.vertexStrideInBytes, i));
  }
}

OptixResult create_context(CUcontext, const OptixDeviceContextOptions* options, OptixDeviceContext* context) {
  if (calls.context_result != OPTIX_SUCCESS) return calls.context_result;
  options->logCallbackFunction(2, "MOCK", "a message", options->logCallbackData);
  *context = make_handle<OptixDeviceContext>();
  return OPTIX_SUCCESS;
}

OptixResult create_module(OptixDeviceContext, const OptixModuleCompileOptions* options,
                          const OptixPipelineCompileOptions* pipeline, const char*, size_t size, char* log, size_t*,
                          OptixModule* module) {
  ++calls.modules;
  std::strcpy(log, size == 1 ? "no IR" : "no PTX");
  if (calls.failures-- > 0) return calls.module_result;
  calls.pipeline = *pipeline;
  calls.payload_words.clear();
  for (unsigned i = 0; i < options->numPayloadTypes; ++i)
    calls.payload_words.push_back(options->payloadTypes[i].numPayloadValues);
  *module = make_handle<OptixModule>();
  return OPTIX_SUCCESS;
}

OptixResult get_spheres(OptixDeviceContext, const OptixModuleCompileOptions*, const OptixPipelineCompileOptions*,
                        const OptixBuiltinISOptions* options, OptixModule* module) {
  EXPECT_EQ(options->builtinISModuleType, OPTIX_PRIMITIVE_TYPE_SPHERE);
  EXPECT_EQ(options->buildFlags, build_flags);
  calls.sphere_modules_move.push_back(options->usesMotionBlur != 0);
  *module = make_handle<OptixModule>();
  return OPTIX_SUCCESS;
}

std::string name_of(const OptixProgramGroupDesc& group) {
  const char* name = group.kind == OPTIX_PROGRAM_GROUP_KIND_HITGROUP ? group.hitgroup.entryFunctionNameCH
                     : group.kind == OPTIX_PROGRAM_GROUP_KIND_MISS   ? group.miss.entryFunctionName
                                                                     : group.raygen.entryFunctionName;
  return name ? name : "";
}

OptixResult create_group(OptixDeviceContext, const OptixProgramGroupDesc* group, unsigned,
                         const OptixProgramGroupOptions*, char*, size_t*, OptixProgramGroup* made) {
  calls.groups.push_back(name_of(*group));
  if (group->kind == OPTIX_PROGRAM_GROUP_KIND_HITGROUP && group->hitgroup.entryFunctionNameIS)
    calls.intersections.emplace_back(group->hitgroup.entryFunctionNameIS);
  ++calls.made;
  *made = reinterpret_cast<OptixProgramGroup>(calls.groups.size());
  return OPTIX_SUCCESS;
}

/// The header is the number of the program group.
OptixResult pack_header(OptixProgramGroup group, void* header) {
  const size_t number = reinterpret_cast<size_t>(group);
  std::memcpy(header, &number, sizeof(number));
  return OPTIX_SUCCESS;
}

std::string program_at(CUdeviceptr base, unsigned stride, unsigned index) {
  return calls.groups[element<size_t>(base, stride, index) - 1];
}

OptixResult build(OptixDeviceContext, CUstream, const OptixAccelBuildOptions* options, const OptixBuildInput* inputs,
                  unsigned count, CUdeviceptr, size_t, CUdeviceptr, size_t, OptixTraversableHandle* handle,
                  const OptixAccelEmitDesc* emitted, unsigned) {
  if (calls.build_result != OPTIX_SUCCESS) return calls.build_result;
  EXPECT_EQ(count, 1u);
  calls.inputs.push_back(inputs[0]);
  calls.builds.push_back(*options);
  look_at(inputs[0]);
  if (options->motionOptions.numKeys > 1) look_at_motion(inputs[0].sphereArray);
  *pointer<uint64_t>(emitted->result) = 100;
  *handle = calls.inputs.size();
  return OPTIX_SUCCESS;
}

struct HostBvhStacks : LocalStacks {
  using Intersector = Bvh2Intersector<float>;
};

struct LaunchThread : cuda::HostThread {
  using HostThread::HostThread;
  HostBvhStacks stacks() const { return {}; }
};

template <IntegratorKind kind>
void run(const OptixParams& params, unsigned width, unsigned height) {
  const OptixKernel<kind> kernel{params.launch, 1, 1, params.sums};
  for (unsigned y = 0; y < height; ++y)
    for (unsigned x = 0; x < width; ++x) kernel(LaunchThread(x, y, width));
}

OptixResult launch(OptixPipeline, CUstream, CUdeviceptr params, size_t size, const OptixShaderBindingTable* table,
                   unsigned width, unsigned height, unsigned depth) {
  ++calls.launches;
  EXPECT_EQ(size, sizeof(OptixParams));
  EXPECT_EQ(depth, 1u);
  EXPECT_EQ(table->missRecordCount, 2u);
  EXPECT_EQ(table->hitgroupRecordCount, primitive_kinds);
  EXPECT_EQ(program_at(table->missRecordBase, table->missRecordStrideInBytes, 0), "");
  EXPECT_EQ(program_at(table->missRecordBase, table->missRecordStrideInBytes, 1), "__miss__occlusion");
  const std::string raygen = program_at(table->raygenRecord, 0, 0);
  const OptixParams& p = *pointer<const OptixParams>(params);
  const bool mixed = SceneTraits(p.launch.scene).has_instances();
  EXPECT_EQ(p.traversable, mixed || !calls.inputs.empty() ? calls.inputs.size() : 0);
  const std::string names[] = {"__closesthit__triangle", "__closesthit__sphere", "__closesthit__moving_sphere",
                               "__closesthit__cylinder", "__closesthit__disk"};
  for (unsigned kind = 0; kind < primitive_kinds; ++kind)
    EXPECT_EQ(program_at(table->hitgroupRecordBase, table->hitgroupRecordStrideInBytes, kind),
              SceneTraits(p.launch.scene).has[kind] ? names[kind] : "");
  if (raygen == "__raygen__path") run<IntegratorKind::path>(p, width, height);
  if (raygen == "__raygen__iterative") run<IntegratorKind::iterative>(p, width, height);
  return OPTIX_SUCCESS;
}

template <class Handle>
OptixResult destroy(Handle) {
  ++calls.destroyed;
  return OPTIX_SUCCESS;
}

/// Twice the radiance, plus albedo and normal.
OptixResult invoke_denoiser(OptixDenoiser, CUstream, const OptixDenoiserParams* params, CUdeviceptr, size_t,
                            const OptixDenoiserGuideLayer* guides, const OptixDenoiserLayer* layers, unsigned count,
                            unsigned, unsigned, CUdeviceptr, size_t) {
  EXPECT_EQ(count, 1u);
  EXPECT_EQ(params->blendFactor, 0);
  const OptixImage2D& in = layers[0].input;
  for (const OptixImage2D* image : {&in, &layers[0].output, &guides->albedo, &guides->normal}) {
    EXPECT_EQ(image->format, OPTIX_PIXEL_FORMAT_FLOAT3);
    EXPECT_EQ(image->rowStrideInBytes, image->width * 12);
    EXPECT_EQ(image->width * 1000 + image->height, in.width * 1000 + in.height);
  }
  for (size_t i = 0; i < size_t{3} * in.width * in.height; ++i)
    pointer<float>(layers[0].output.data)[i] = 2 * pointer<float>(in.data)[i] + pointer<float>(guides->albedo.data)[i] +
                                               pointer<float>(guides->normal.data)[i];
  return OPTIX_SUCCESS;
}

OptixFunctionTable mock_driver() {
  calls = {};
  OptixFunctionTable table{};
  table.optixGetErrorName = [](OptixResult) { return "OPTIX_ERROR_OF_THE_MOCK"; };
  table.optixDeviceContextCreate = create_context;
  table.optixDeviceContextDestroy = destroy<OptixDeviceContext>;
  table.optixModuleCreate = create_module;
  table.optixModuleDestroy = destroy<OptixModule>;
  table.optixBuiltinISModuleGet = get_spheres;
  table.optixProgramGroupCreate = create_group;
  table.optixProgramGroupDestroy = destroy<OptixProgramGroup>;
  table.optixPipelineCreate = [](OptixDeviceContext, const OptixPipelineCompileOptions*,
                                 const OptixPipelineLinkOptions*, const OptixProgramGroup*, unsigned count, char*,
                                 size_t*, OptixPipeline* pipeline) {
    EXPECT_EQ(count, raygen_records + miss_records + hit_records);
    *pipeline = make_handle<OptixPipeline>();
    return OPTIX_SUCCESS;
  };
  table.optixPipelineDestroy = destroy<OptixPipeline>;
  table.optixSbtRecordPackHeader = pack_header;
  table.optixAccelComputeMemoryUsage = [](OptixDeviceContext, const OptixAccelBuildOptions*, const OptixBuildInput*,
                                          unsigned, OptixAccelBufferSizes* sizes) {
    *sizes = {1000, 500, 0};
    return OPTIX_SUCCESS;
  };
  table.optixAccelBuild = build;
  table.optixAccelCompact = [](OptixDeviceContext, CUstream, OptixTraversableHandle from, CUdeviceptr, size_t size,
                               OptixTraversableHandle* to) {
    EXPECT_EQ(size, 100u);
    *to = from;
    return OPTIX_SUCCESS;
  };
  table.optixLaunch = launch;
  table.optixDenoiserCreate = [](OptixDeviceContext, OptixDenoiserModelKind kind, const OptixDenoiserOptions* options,
                                 OptixDenoiser* denoiser) {
    EXPECT_EQ(kind, OPTIX_DENOISER_MODEL_KIND_AOV) << "which takes normals in world space";
    EXPECT_TRUE(options->guideAlbedo && options->guideNormal);
    *denoiser = make_handle<OptixDenoiser>();
    return OPTIX_SUCCESS;
  };
  table.optixDenoiserDestroy = destroy<OptixDenoiser>;
  table.optixDenoiserComputeMemoryResources = [](OptixDenoiser, unsigned, unsigned, OptixDenoiserSizes* sizes) {
    sizes->stateSizeInBytes = sizes->withoutOverlapScratchSizeInBytes = 64;
    return OPTIX_SUCCESS;
  };
  table.optixDenoiserSetup = [](OptixDenoiser, CUstream, unsigned, unsigned, CUdeviceptr, size_t, CUdeviceptr, size_t) {
    return calls.build_result;
  };
  table.optixDenoiserInvoke = invoke_denoiser;
  return table;
}

class MockExecutor : public HostExecutor {
 public:
  CUstream stream() const { return nullptr; }
};

const unsigned char one_byte[] = {1}, two_bytes[] = {1, 2};
const DeviceCode code{one_byte, two_bytes};

/// Renders with the mock; the result and the recorded calls.
Outcome render(const OptixFunctionTable& table, Scene scene, Settings asked) {
  asked.backend = "serial";
  const RenderSettings settings = resolve_settings(asked, scene);
  Diagnostics diagnostics;
  const CompiledScene<float> flat =
      compile_scene<float>(std::move(scene), naming({settings.width, settings.height, 1, {}}), diagnostics);
  auto film =
      std::make_unique<Film<float>>(settings.window, settings.aovs, FilmExtras{flat.view.filter.has_negative != 0});
  film->set_scene(LayerScene(flat));
  RenderControl control(1);
  {
    OptixExecutor<MockExecutor> executor(table, code);
    cuda::DeviceRender<OptixExecutor<MockExecutor>, OptixTracing, float> device(executor, {});
    device.prepare(flat);
    const uint32_t whole = settings.samples_per_pixel / 4 * 4;
    device.render_pass({flat, SampleKernel<float>(nullptr), settings, *film, control, 0, whole}, control.thread(0));
    if (whole < settings.samples_per_pixel)
      device.render_pass(
          {flat, SampleKernel<float>(nullptr), settings, *film, control, whole, settings.samples_per_pixel - whole},
          control.thread(0));
  }
  Rendering rendering;
  rendering.film = std::move(film);
  return outcome_of(rendering);
}

Settings settings_of(const std::string& integrator) {
  Settings settings;
  settings.backend = "serial";
  settings.integrator = integrator;
  settings.samples_per_pixel = 18;
  settings.aovs = all_aovs;
  return settings;
}

TEST(OptixMock, LaunchesGiveTheSerialBits) {
  for (const std::string scene : {"cornell", "spheres", "instances", "cylinders", "disks"})
    for (const std::string integrator : {"path", "iterative"}) {
      const OptixFunctionTable table = mock_driver();
      const Settings settings = settings_of(integrator);
      EXPECT_TRUE(same_bits(render_bits(parity_scene(scene), settings), render(table, parity_scene(scene), settings)));
      EXPECT_GT(calls.launches, 1);
      EXPECT_EQ(calls.made, calls.destroyed) << "everything that was made is destroyed";
    }
}

TEST(OptixMock, EveryKindHasAStructureAndARecord) {
  const OptixFunctionTable table = mock_driver();
  render(table, parity_scene("spheres"), settings_of("path"));
  std::vector<OptixBuildInputType> types;
  for (const OptixBuildInput& input : calls.inputs) types.push_back(input.type);
  ASSERT_EQ(types.back(), OPTIX_BUILD_INPUT_TYPE_INSTANCES);
  ASSERT_EQ(calls.instances.size() + 1, types.size());
  for (const OptixInstance& instance : calls.instances) {
    const bool spheres = types[instance.traversableHandle - 1] == OPTIX_BUILD_INPUT_TYPE_SPHERES;
    const bool moves = calls.builds[instance.traversableHandle - 1].motionOptions.numKeys == 2;
    EXPECT_EQ(instance.sbtOffset, !spheres ? 0u : moves ? 2u : 1u);
    EXPECT_EQ(instance.transform[0] + instance.transform[5] + instance.transform[10], 3);
  }
  EXPECT_TRUE(calls.pipeline.usesMotionBlur);
  EXPECT_EQ(calls.pipeline.traversableGraphFlags,
            static_cast<unsigned>(OPTIX_TRAVERSABLE_GRAPH_FLAG_ALLOW_SINGLE_LEVEL_INSTANCING));
  EXPECT_EQ(calls.sphere_modules_move, (std::vector<bool>{false, true}));
  EXPECT_EQ(calls.payload_words, (std::vector<unsigned>{5, 1}));
  ASSERT_FALSE(calls.first_centres.empty());
  for (size_t i = 0; i < calls.first_centres.size(); ++i)
    EXPECT_GT(length_squared(calls.last_centres[i] - calls.first_centres[i]), 0);
}

TEST(OptixMock, KindsThatItDoesNotKnowAreBoxesWithAProgram) {
  const OptixFunctionTable table = mock_driver();
  render(table, parity_scene("cylinders"), settings_of("path"));
  ASSERT_EQ(calls.inputs.size(), 3u) << "triangles, cylinders and the instances of both";
  EXPECT_EQ(calls.inputs[1].type, OPTIX_BUILD_INPUT_TYPE_CUSTOM_PRIMITIVES);
  EXPECT_EQ(calls.boxes.size(), 6u);
  for (const OptixAabb& box : calls.boxes)
    EXPECT_TRUE(box.minX < box.maxX && box.minY < box.maxY && box.minZ < box.maxZ);
  EXPECT_EQ(calls.intersections, (std::vector<std::string>{"__intersection__cylinder"}));
  EXPECT_EQ(calls.instances.at(1).sbtOffset, static_cast<unsigned>(PrimitiveKind::cylinder));
  EXPECT_TRUE(calls.pipeline.usesPrimitiveTypeFlags & static_cast<unsigned>(OPTIX_PRIMITIVE_TYPE_FLAGS_CUSTOM));
  EXPECT_FALSE(calls.pipeline.usesMotionBlur);
}

TEST(OptixMock, ObjectsHaveAStructureAndInstancesOfIt) {
  const OptixFunctionTable table = mock_driver();
  render(table, parity_scene("instances"), settings_of("path"));
  ASSERT_EQ(calls.inputs.size(), 3u) << "the world's triangles, the ball and the instances";
  EXPECT_EQ(calls.inputs[0].triangleArray.numIndexTriplets, 4u);
  EXPECT_EQ(calls.inputs[1].triangleArray.numIndexTriplets, 20480u);
  ASSERT_EQ(calls.instances.size(), 9u);
  EXPECT_EQ(calls.instances[0].instanceId, 0u);
  for (unsigned i = 1; i < 9; ++i) {
    EXPECT_EQ(calls.instances[i].instanceId, first_instance_id + i - 1);
    EXPECT_EQ(calls.instances[i].traversableHandle, 2u);
    EXPECT_NE(calls.instances[i].transform[3], 0);
  }
}

TEST(OptixMock, TrianglesLieInTheArena) {
  const OptixFunctionTable table = mock_driver();
  const Scene scene = scene_of(
      "Film \"rgb\" \"integer xresolution\" 9 \"integer yresolution\" 7\n"
      "WorldBegin\nLightSource \"infinite\" \"rgb L\" [1 2 3]\n"
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 2 1 3] \"point3 P\" [0 0 5  1 0 5  0 1 5  1 1 6]\n");
  const Settings settings = settings_of("path");
  EXPECT_TRUE(same_bits(render_bits(scene, settings), render(table, scene, settings)));
  ASSERT_EQ(calls.inputs.size(), 1u) << "one kind needs no instances";
  EXPECT_EQ(calls.pipeline.traversableGraphFlags, static_cast<unsigned>(OPTIX_TRAVERSABLE_GRAPH_FLAG_ALLOW_SINGLE_GAS));
  EXPECT_FALSE(calls.pipeline.usesMotionBlur);
  ASSERT_EQ(calls.corners.size(), 6u);
  EXPECT_EQ(calls.corners[5].z, 6);
  EXPECT_EQ(calls.corners[3].y, 1);
}

TEST(OptixMock, NothingToHit) {
  const OptixFunctionTable table = mock_driver();
  const Scene scene = scene_of(
      "Film \"rgb\" \"integer xresolution\" 9 \"integer yresolution\" 7\n"
      "WorldBegin\nLightSource \"infinite\" \"rgb L\" [1 2 3]\n");
  const Settings settings = settings_of("path");
  EXPECT_TRUE(same_bits(render_bits(scene, settings), render(table, scene, settings)));
  EXPECT_TRUE(calls.inputs.empty());
}

TEST(OptixMock, PtxStandsInWhereIrIsRefused) {
  const OptixFunctionTable table = mock_driver();
  calls.failures = 1;
  calls.module_result = OPTIX_ERROR_INVALID_INPUT;
  render(table, parity_scene("cornell"), settings_of("path"));
  EXPECT_EQ(calls.modules, 2);
  EXPECT_GT(calls.launches, 0);
}

std::string error_of(const OptixFunctionTable& table) {
  try {
    render(table, parity_scene("cornell"), settings_of("path"));
  } catch (const OutOfMemoryError& error) {
    return std::string("out of memory: ") + error.what();
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "";
}

TEST(OptixMock, ErrorsSayWhatFailedAndLeaveNothing) {
  OptixFunctionTable table = mock_driver();
  calls.failures = 2;
  calls.module_result = OPTIX_ERROR_INVALID_INPUT;
  EXPECT_EQ(error_of(table),
            "OptiX failed while compiling its programs: OPTIX_ERROR_OF_THE_MOCK: no PTX; MOCK: a message");
  EXPECT_EQ(calls.made, calls.destroyed);
  table = mock_driver();
  calls.build_result = OPTIX_ERROR_DEVICE_OUT_OF_MEMORY;
  EXPECT_EQ(
      error_of(table).rfind("out of memory: OptiX is out of memory while building its acceleration structures: ", 0),
      0u);
  EXPECT_EQ(calls.made, calls.destroyed);
  table = mock_driver();
  calls.context_result = OPTIX_ERROR_CUDA_ERROR;
  EXPECT_EQ(error_of(table), "OptiX failed while starting: OPTIX_ERROR_OF_THE_MOCK");
}

TEST(OptixMock, DenoiserTakesAndGivesWholeImages) {
  const OptixFunctionTable table = mock_driver();
  Scene scene = parity_scene("spheres");
  Settings asked = settings_of("path");
  asked.aovs = {"distance", "normal", "albedo"};
  asked.denoiser = "builtin";  // renders what denoisers need
  const RenderSettings settings = resolve_settings(asked, scene);
  Diagnostics diagnostics;
  Rendering rendering = render_scene(std::move(scene), settings, 0, {}, diagnostics);
  rendering.denoised.clear();
  const Outcome noisy = outcome_of(rendering);
  {
    MockExecutor executor;
    const Context context(table);
    rendering.denoised = Denoiser(table, context, executor).denoise(rendering.noisy_image());
  }
  EXPECT_EQ(calls.made, calls.destroyed);
  const Outcome outcome = outcome_of(rendering);
  ASSERT_EQ(outcome.channels, noisy.channels);
  const size_t width = static_cast<size_t>(noisy.width);
  const auto value = [&](const Outcome& from, const std::string& name, size_t x, size_t y) {
    const auto at = std::find(from.channels.begin(), from.channels.end(), name) - from.channels.begin();
    return from.rows[(y * from.channels.size() + static_cast<size_t>(at)) * width + x];
  };
  for (size_t y = 0; y < static_cast<size_t>(noisy.height); ++y)
    for (size_t x = 0; x < width; ++x) {
      const char* names[][3] = {
          {"R", "albedo.R", "normal.X"}, {"G", "albedo.G", "normal.Y"}, {"B", "albedo.B", "normal.Z"}};
      for (const auto& [colour, albedo, normal] : names) {
        ASSERT_EQ(value(outcome, colour, x, y),
                  2 * value(noisy, colour, x, y) + value(noisy, albedo, x, y) + value(noisy, normal, x, y));
        ASSERT_EQ(value(outcome, normal, x, y), value(noisy, normal, x, y));
      }
    }
}

TEST(OptixMock, DenoiserThatFails) {
  const OptixFunctionTable table = mock_driver();
  calls.build_result = OPTIX_ERROR_CUDA_ERROR;
  MockExecutor executor;
  const Context context(table);
  Denoiser denoiser(table, context, executor);
  NoisyImage image;
  image.width = image.height = 1;
  for (NoisyBuffer* buffer : {&image.radiance, &image.albedo, &image.normal}) buffer->mean = {1, 2, 3};
  EXPECT_THROW(denoiser.denoise(image), DeviceError);
}

TEST(OptixLibraryFile, ThatIsMissingOrAnother) {
  EXPECT_EQ(load_optix("libnosuchlibrary.so.1").problem.rfind("libnosuchlibrary.so.1 is not here: install ", 0), 0u);
  EXPECT_EQ(load_optix("libm.so.6").problem.rfind("libm.so.6 is no library of OptiX: ", 0), 0u);
}

}  // namespace
}  // namespace alhazen::impl::optix

#endif
