#pragma once

// Settings, validated and merged with those of the scene.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "alhazen/alhazen.h"
#include "compile/light_groups.h"
#include "core/integrators/camera_sample.h"
#include "images/display/display_error.h"
#include "images/display/exposure_meter.h"
#include "scene/scene.h"

namespace alhazen::impl {

enum class Precision { single, double_ };

enum class ScheduleKind { static_, dynamic, guided };

struct Schedule {
  ScheduleKind kind = ScheduleKind::dynamic;
  int chunk = 0;  ///< 0: OpenMP's default
};

/// The layers other than radiance. `noisy` is the radiance before denoising.
struct AovSet {
  bool alpha = false, albedo = false, normal = false, camera_normal = false, depth = false, distance = false,
       position = false, uv = false, motion = false, object = false, material = false, cryptomatte = false,
       components = false, light_groups = false, bounces = false, samples = false, variance = false, noisy = false;
};

/// The layers by name, all but `noisy` in the order of channels.
struct NamedLayer {
  const char* name;
  bool AovSet::*is_wanted;
};
std::span<const NamedLayer> layer_table();

/// Whether paths are guided; `automatic`: while it pays.
enum class GuidingMode { off, on, automatic };

/// Pixels x0 <= x < x1, y0 <= y < y1 of the whole image.
struct PixelWindow {
  int x0 = 0, x1 = 0, y0 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  int64_t pixels() const { return static_cast<int64_t>(width()) * height(); }
};

struct BlockSize {
  uint32_t x = 1, y = 1;
};

/// Values of RenderSettings::device that are not GPU numbers.
inline constexpr int all_devices = -1, host_device = -2;

/// What was asked, and what follows from it and from the scene.
struct RenderSettings {
  /// Checked, and with what its quality sets; what is resolved has a member of its own below, which counts.
  Settings asked;
  std::string backend;
  uint32_t strategy = 0;        ///< value of the backend's own enum
  bool runs_on_device = false;  ///< a GPU's backend
  int device = 0;               ///< if so: a GPU's number, all_devices or host_device
  BlockSize block = {16, 16};   ///< if the backend has them: threads per block
  BlockSize chunk = {4, 4};     ///< if the backend has them: chunks in each direction
  Schedule schedule;
  Precision precision = Precision::single;
  IntegratorKind integrator = IntegratorKind::path;
  SamplerType sampler = SamplerType::sobol;
  int threads = 1;
  uint32_t samples_per_pixel = 16;                    ///< with a noise target, the most
  std::optional<DisplayCurve> noise_curve;            ///< present: the noise target is of what is displayed
  ExposureRule noise_exposure = ExposureRule::given;  ///< if not given, the image so far decides on the curve's scale
  uint32_t max_segments = 6;                          ///< D, bounces + 1
  int width = 0, height = 0;
  PixelWindow window;
  uint32_t seed = 0;
  AovSet aovs;
  std::string denoiser;          ///< empty: none
  std::string denoiser_warning;  ///< why a better one that is here was not taken; empty otherwise
  uint64_t texture_budget = 0;   ///< bytes; 0: no limit
  GuidingMode guiding = GuidingMode::off;
  uint64_t guiding_memory = 0;  ///< bytes
  /// Albedo, normal and depth are of the first surface that is not perfectly specular.
  bool records_through_specular = false;
  std::vector<LightGroup> light_groups;  ///< empty: one for each name
  bool has_alpha = false;                ///< the background is transparent, and the image has a channel A
};

/// Replaces what settings replace in a scene: how much light its coats lose, and the pixel filter. Throws InputError
/// that names the setting and its valid values.
void apply_settings(const Settings& asked, Scene& scene);

/// Merges `asked` with `scene`. Throws InputError as above.
RenderSettings resolve_settings(const Settings& asked, const Scene& scene);

/// The seed, and for zsobol the order of its points, which depends on the number of samples per pixel.
SampleSeed sample_seed(const RenderSettings& settings);

std::string to_string(Precision precision);
std::string to_string(IntegratorKind integrator);
std::string to_string(SamplerType sampler);
std::string to_string(GuidingMode mode);
std::string to_string(const Schedule& schedule);

/// Parses `static`, `dynamic,4`, ... Throws InputError.
Schedule parse_schedule(const std::string& text);

}  // namespace alhazen::impl
