#pragma once

// What an engine must do to be one: say whether it is here, and take samples of pixels.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "compile/compile_scene.h"
#include "compile/compiled_scene.h"
#include "render/control.h"
#include "render/film.h"
#include "render/guiding.h"
#include "render/sample_kernel.h"
#include "render/settings.h"

namespace alhazen::impl {

/// Samples [first_sample, first_sample + sample_count) of every pixel of the film. `first_sample` and, but for the last
/// pass, `sample_count` are multiples of samples_per_block; sample_count is at most what the backend asks for. What a
/// pixel holds of them already, by a pass that was stopped, is not taken again, and pixels that are finished are left
/// out.
template <class Real>
struct RenderPass {
  const CompiledScene<Real>& scene;
  SampleKernel<Real> kernel;
  const RenderSettings& settings;
  Film<Real>& film;
  RenderControl& control;
  uint32_t first_sample;
  uint32_t sample_count;
  IntegratorKind integrator;               ///< that of the settings, or with guiding that of this pass
  Guiding<Real>* guiding = nullptr;        ///< where the scene's `guide` comes from, if there is one
  const ExternalTracer* tracer = nullptr;  ///< what the kernel traces rays by, where that is not the scene's own BVH
};

inline constexpr uint32_t default_samples_per_pass = 64;

/// What a backend is on any machine; nothing is loaded or started to know it.
struct BackendTraits {
  std::string name;
  std::vector<std::string> strategies;  ///< names of the values of its own enum, in order; the first is the default
  std::string help;                     ///< what it runs on, in a few words
  bool runs_on_devices = false;         ///< GPUs, by the integrators path and iterative alone
  bool runs_on_host = false;            ///< whether `host` is a device too
  bool traces_double = true;            ///< whether there is double precision
};

/// What a backend is on this machine.
struct BackendStatus {
  bool available = true;
  std::string details = {};               ///< what it runs on; or why it cannot, and what to do
  std::vector<std::string> devices = {};  ///< where there may be several: each in a line
  std::string module = {};                ///< the file of its module (util/module.h), where there is one
};

/// A setting as statistics name it.
using NamedSetting = std::pair<std::string, std::string>;

class Backend {
 public:
  virtual ~Backend() = default;
  virtual BackendTraits traits() const = 0;
  /// Loads its module, where it has one, and looks at the machine.
  virtual BackendStatus status() const = 0;
  /// Checks what was asked of it, and sets what is its own: devices, threads and options. The strategy is chosen
  /// already. Throws InputError.
  virtual void configure(const Settings& asked, RenderSettings& settings) const;
  /// Those of its settings that statistics name.
  virtual std::vector<NamedSetting> named_settings(const RenderSettings& settings) const;
  /// What takes a moment and does not depend on the scene, such as starting a GPU. Called once, before the first pass.
  virtual void start(const RenderSettings&) {}
  /// What rays are traced by.
  virtual BvhLayouts wanted_layouts(const RenderSettings&) const { return {BvhLayout::bvh8}; }
  /// Builds what rays are traced by, where that is not our own BVH; counts as building it. Called after
  /// start(), and again when the arena of the scene has changed: what was built before is replaced.
  virtual void prepare(const CompiledScene<float>&) {}
  virtual void prepare(const CompiledScene<double>&) {}
  /// Passes are no larger than this.
  virtual uint32_t max_samples_per_pass() const { return default_samples_per_pass; }
  virtual void render_pass(const RenderPass<float>& pass) = 0;
  virtual void render_pass(const RenderPass<double>& pass) = 0;

 protected:
  /// Throws InputError where status() says that it cannot be used.
  void require_available() const;
  /// Throws InputError where a size of blocks, or a number of chunks, is asked for.
  void refuse_blocks(const Settings& asked) const;
  /// Throws InputError where a schedule is asked for.
  void refuse_schedule(const Settings& asked) const;
};

/// Every backend that this program knows, available or not, and the name of the one that `auto` is for so many threads
/// (backends/registry.cpp).
std::vector<std::unique_ptr<Backend>> all_backends();
std::string default_backend(int threads);

/// The one called `name`. Throws InputError where there is none.
std::unique_ptr<Backend> make_backend(const std::string& name);

/// The number of the strategy called `name`; of the default for `auto` and an empty name. Throws InputError.
uint32_t parse_strategy(const BackendTraits& backend, const std::string& name);
/// Empty for a backend without strategies.
std::string strategy_name(const RenderSettings& settings);

/// Sets backend, strategy, device and thread count of `settings`; `auto` becomes what measures fastest.
void choose_backend(const Settings& asked, RenderSettings& settings);

}  // namespace alhazen::impl
