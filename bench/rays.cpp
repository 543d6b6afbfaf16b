// Closest-hit and any-hit queries with recorded rays: by our tree, as compiled for each instruction set, and by Embree
// if it is built in. scripts/bench-rays.py runs it and prints ratios.

#include <benchmark/benchmark.h>

#include "recorded.h"
#include "render/sample_kernel.h"

namespace alhazen::impl {

ALHAZEN_DECLARE_KERNEL(TraceQueries select_trace(Call call, bool is_double))

namespace {

template <class Real>
const ExternalTracer* tracer_of([[maybe_unused]] const Recorded<Real>& recorded, [[maybe_unused]] Call call) {
#if defined(ALHAZEN_WITH_EMBREE)
  if (call == Call::plain_embree) return &recorded.plain_embree->tracer();
  if (call == Call::embree_backend) return &recorded.embree->tracer();
#endif
  return nullptr;
}

template <class Real>
void trace(benchmark::State& state, const std::string& scene, std::vector<RaySet> sets, TraceQueries function,
           Call call) {
  const Recorded<Real>& recorded = Recorded<Real>::of(scene);
  const ExternalTracer* const tracer = tracer_of(recorded, call);
  uint64_t hits = 0, rays = 0;
  for (auto _ : state) {
    hits = rays = 0;
    for (const RaySet set : sets) {
      const std::vector<Query<Real>>& queries = recorded.sets[set];
      hits +=
          function(&recorded.flat.view, tracer, queries.data(), static_cast<uint32_t>(queries.size()), set == shadow);
      rays += queries.size();
    }
  }
  state.counters["rays"] = benchmark::Counter(static_cast<double>(rays), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["hit %"] = 100.0 * static_cast<double>(hits) / static_cast<double>(rays);
}

template <class Real>
void register_precision(const std::string& precision) {
  constexpr const char* names[] = {"primary", "bounce", "shuffled", "shadow"};
  const auto select = [](InstructionSet set, Call call) {
    return ALHAZEN_KERNEL_OF(set, select_trace)(call, sizeof(Real) == sizeof(double));
  };
  const InstructionSet best = instruction_sets().back();
  for (const char* scene : bench_scenes) {
    const auto add = [&](const std::string& group, const std::string& engine, std::vector<RaySet> sets,
                         TraceQueries function, Call call) {
      const std::string name = group + "/" + precision + " " + engine;
      benchmark::RegisterBenchmark(name.c_str(), trace<Real>, scene, std::move(sets), function, call)
          ->Unit(benchmark::kMillisecond);
    };
    for (const RaySet set : {primary, bounce, shuffled, shadow}) {
      const std::string group = std::string("rays/") + scene + "/" + names[set];
      for (const InstructionSet isa : instruction_sets()) {
        add(group, "one " + to_string(isa), {set}, select(isa, Call::one), Call::one);
        add(group, "many " + to_string(isa), {set}, select(isa, Call::many), Call::many);
        if (set == primary)
          add(group, "coherent " + to_string(isa), {set}, select(isa, Call::coherent), Call::coherent);
      }
#if defined(ALHAZEN_WITH_EMBREE)
      if constexpr (sizeof(Real) == sizeof(float)) {
        add(group, "embree", {set}, select(best, Call::plain_embree), Call::plain_embree);
        add(group, "embree backend", {set}, select(best, Call::embree_backend), Call::embree_backend);
      }
#endif
    }
#if defined(ALHAZEN_WITH_EMBREE)
    // The rays of whole.cpp's renders, without the shading.
    if constexpr (sizeof(Real) == sizeof(float))
      add(std::string("whole/") + scene, "embree", {primary, bounce, shadow}, select(best, Call::plain_embree),
          Call::plain_embree);
#endif
  }
}

const bool is_registered = [] {
  register_precision<float>("float");
  register_precision<double>("double");
  return true;
}();

}  // namespace
}  // namespace alhazen::impl
