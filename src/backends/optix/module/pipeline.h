#pragma once

// The OptiX pipeline. The driver compiles its programs for the features of the scene.

#include <cstring>
#include <vector>

#include "backends/optix/module/acceleration.h"
#include "backends/optix/module/device_code.h"
#include "backends/optix/module/params.h"

namespace alhazen::impl::optix {

/// The device context. Messages of OptiX are kept for the next error.
class Context {
 public:
  explicit Context(const OptixFunctionTable& functions) : functions_(functions) {
    OptixDeviceContextOptions options{};
    options.logCallbackFunction = keep_message;
    options.logCallbackData = &log_;
    options.logCallbackLevel = 2;  // errors
#ifndef NDEBUG
    options.validationMode = OPTIX_DEVICE_CONTEXT_VALIDATION_MODE_ALL;
    options.logCallbackLevel = 3;  // warnings too
#endif
    check(functions_, functions_.optixDeviceContextCreate(nullptr, &options, &context_), "starting");
  }
  ~Context() { functions_.optixDeviceContextDestroy(context_); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  OptixDeviceContext get() const { return context_; }
  /// Returns `of_call`, followed by all messages so far.
  std::string log(const std::string& of_call = "") const {
    return of_call + (of_call.empty() || log_.empty() ? "" : "; ") + log_;
  }

 private:
  static void keep_message(unsigned, const char* tag, const char* message, void* log) {
    std::string& text = *static_cast<std::string*>(log);
    text += (text.empty() ? "" : "; ") + std::string(tag) + ": " + message;
  }

  const OptixFunctionTable& functions_;
  std::string log_;
  OptixDeviceContext context_ = nullptr;
};

/// A record of the shader binding table consists of its header.
struct alignas(OPTIX_SBT_RECORD_ALIGNMENT) SbtRecord {
  char header[OPTIX_SBT_RECORD_HEADER_SIZE];
};

/// The buffer for the messages of one OptiX call.
struct CallLog {
  char text[2048] = "";
  size_t size = sizeof(text);
};

class Pipeline {
 public:
  Pipeline(const OptixFunctionTable& functions, const Context& context, const DeviceCode& code,
           const SceneTraits& traits)
      : functions_(functions), context_(context) {
    describe(traits);
    try {
      make_modules(code, traits);
      make_groups(traits);
      link();
    } catch (...) {
      destroy();
      throw;
    }
  }
  ~Pipeline() { destroy(); }
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  OptixPipeline get() const { return pipeline_; }

  /// Returns the records of ray generation, misses and hits, in this order.
  std::vector<SbtRecord> records() const {
    std::vector<SbtRecord> records(groups_.size());
    for (size_t i = 0; i < groups_.size(); ++i)
      check(functions_, functions_.optixSbtRecordPackHeader(groups_[i], records[i].header), linking);
    return records;
  }

 private:
  void describe(const SceneTraits& traits) {
    constexpr unsigned caller = OPTIX_PAYLOAD_SEMANTICS_TRACE_CALLER_READ_WRITE;
    for (unsigned& word : closest_semantics_) word = caller | OPTIX_PAYLOAD_SEMANTICS_CH_WRITE;
    occlusion_semantics_[0] = caller | OPTIX_PAYLOAD_SEMANTICS_MS_WRITE;
    payloads_[0] = {closest_words, closest_semantics_};
    payloads_[1] = {occlusion_words, occlusion_semantics_};
    module_options_.numPayloadTypes = 2;
    module_options_.payloadTypes = payloads_;
#ifdef NDEBUG
    module_options_.optLevel = OPTIX_COMPILE_OPTIMIZATION_LEVEL_3;
    module_options_.debugLevel = OPTIX_COMPILE_DEBUG_LEVEL_MINIMAL;
#else
    module_options_.optLevel = OPTIX_COMPILE_OPTIMIZATION_LEVEL_0;
    module_options_.debugLevel = OPTIX_COMPILE_DEBUG_LEVEL_MODERATE;
    pipeline_options_.exceptionFlags = OPTIX_EXCEPTION_FLAG_TRACE_DEPTH | OPTIX_EXCEPTION_FLAG_STACK_OVERFLOW;
#endif
    pipeline_options_.usesMotionBlur = traits.moves();
    pipeline_options_.traversableGraphFlags =
        static_cast<unsigned>(traits.has_instances() ? OPTIX_TRAVERSABLE_GRAPH_FLAG_ALLOW_SINGLE_LEVEL_INSTANCING
                                                     : OPTIX_TRAVERSABLE_GRAPH_FLAG_ALLOW_SINGLE_GAS);
    pipeline_options_.numAttributeValues = 2;
    pipeline_options_.pipelineLaunchParamsVariableName = params_name;
    if (traits.has_kind(PrimitiveKind::triangle))
      pipeline_options_.usesPrimitiveTypeFlags |= static_cast<unsigned>(OPTIX_PRIMITIVE_TYPE_FLAGS_TRIANGLE);
    if (traits.has_spheres())
      pipeline_options_.usesPrimitiveTypeFlags |= static_cast<unsigned>(OPTIX_PRIMITIVE_TYPE_FLAGS_SPHERE);
    if (traits.has_custom())
      pipeline_options_.usesPrimitiveTypeFlags |= static_cast<unsigned>(OPTIX_PRIMITIVE_TYPE_FLAGS_CUSTOM);
  }

  void make_modules(const DeviceCode& code, const SceneTraits& traits) {
    CallLog log;
    OptixResult result = make_module(code.optix_ir, log);
    if (result != OPTIX_SUCCESS) result = make_module(code.ptx, log);
    check(functions_, result, "compiling its programs", context_.log(log.text));
    for (const PrimitiveKind kind : {PrimitiveKind::sphere, PrimitiveKind::moving_sphere}) {
      if (!traits.has_kind(kind)) continue;
      OptixBuiltinISOptions options{};
      options.builtinISModuleType = OPTIX_PRIMITIVE_TYPE_SPHERE;
      options.usesMotionBlur = kind == PrimitiveKind::moving_sphere;
      options.buildFlags = build_flags;
      check(functions_,
            functions_.optixBuiltinISModuleGet(context_.get(), &module_options_, &pipeline_options_, &options,
                                               &sphere_modules_[static_cast<unsigned>(kind)]),
            "getting its sphere intersection program", context_.log());
    }
  }

  OptixResult make_module(std::span<const unsigned char> code, CallLog& log) {
    log = {};
    return functions_.optixModuleCreate(context_.get(), &module_options_, &pipeline_options_,
                                        reinterpret_cast<const char*>(code.data()), code.size(), log.text, &log.size,
                                        &module_);
  }

  void make_groups(const SceneTraits& traits) {
    for (const char* name : raygen_names) {
      OptixProgramGroupDesc group{};
      group.kind = OPTIX_PROGRAM_GROUP_KIND_RAYGEN;
      group.raygen = {module_, name};
      add_group(group);
    }
    OptixProgramGroupDesc miss{};
    miss.kind = OPTIX_PROGRAM_GROUP_KIND_MISS;
    add_group(miss);  // for closest hits, no program runs and the payload keeps its initial values
    miss.miss = {module_, miss_occlusion_name};
    add_group(miss);
    for (unsigned kind = 0; kind < hit_records; ++kind) {
      OptixProgramGroupDesc group{};
      group.kind = OPTIX_PROGRAM_GROUP_KIND_HITGROUP;
      if (traits.has[kind]) {
        group.hitgroup.moduleCH = module_;
        group.hitgroup.entryFunctionNameCH = closest_hit_names[kind];
        group.hitgroup.moduleIS = sphere_modules_[kind];
        if (!is_built_in(static_cast<PrimitiveKind>(kind))) {
          group.hitgroup.moduleIS = module_;
          group.hitgroup.entryFunctionNameIS = intersection_names[kind];
        }
      }
      add_group(group);
    }
  }

  void add_group(const OptixProgramGroupDesc& description) {
    CallLog log;
    OptixProgramGroupOptions options{};
    OptixProgramGroup group = nullptr;
    const OptixResult result =
        functions_.optixProgramGroupCreate(context_.get(), &description, 1, &options, log.text, &log.size, &group);
    check(functions_, result, linking, context_.log(log.text));
    groups_.push_back(group);
  }

  void link() {
    CallLog log;
    OptixPipelineLinkOptions options{};
    options.maxTraceDepth = 1;
    const OptixResult result =
        functions_.optixPipelineCreate(context_.get(), &pipeline_options_, &options, groups_.data(),
                                       static_cast<unsigned>(groups_.size()), log.text, &log.size, &pipeline_);
    check(functions_, result, linking, context_.log(log.text));
  }

  void destroy() {
    if (pipeline_) functions_.optixPipelineDestroy(pipeline_);
    for (const OptixProgramGroup group : groups_) functions_.optixProgramGroupDestroy(group);
    for (const OptixModule module : sphere_modules_)
      if (module) functions_.optixModuleDestroy(module);
    if (module_) functions_.optixModuleDestroy(module_);
  }

  static constexpr const char* linking = "linking its programs";

  const OptixFunctionTable& functions_;
  const Context& context_;
  unsigned closest_semantics_[closest_words]{}, occlusion_semantics_[occlusion_words]{};
  OptixPayloadType payloads_[2]{};
  OptixModuleCompileOptions module_options_{};
  OptixPipelineCompileOptions pipeline_options_{};
  OptixModule module_ = nullptr;
  OptixModule sphere_modules_[hit_records]{};  ///< by PrimitiveKind
  std::vector<OptixProgramGroup> groups_;      ///< in the order of the records
  OptixPipeline pipeline_ = nullptr;
};

}  // namespace alhazen::impl::optix
