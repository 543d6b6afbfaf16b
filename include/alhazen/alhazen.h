#pragma once

// Alhazen as a library: render a scene file into memory.
//
//   alhazen::Settings settings;
//   settings.samples_per_pixel = 64;
//   alhazen::RenderedImage image = alhazen::render("scene.pbrt", settings);
//   const float* red = image.plane("R");
//
// Functions may be called by several threads at once, also on the same scene as long as none changes it. A render uses
// all processors unless Settings::threads says otherwise.

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "alhazen/error.h"
#include "alhazen/version.h"
#include "alhazen/warning.h"

namespace ALHAZEN_NAMESPACE {

/// How to render. What is left as it is comes from the scene, or is chosen automatically; of `max_depth`, any negative
/// value is left open. Values out of range are an InputError that names the setting: none is replaced silently.
struct Settings {
  std::string backend = "auto";  ///< auto, serial, openmp, embree (float only), cuda, optix (float only)
  /// openmp, embree: rows, collapse, rows+reduction, reduction, tiles; cuda: pixel, chunk, persistent, wavefront;
  /// optix: megakernel
  std::string strategy = "auto";
  std::string schedule{};           ///< openmp, embree: static, dynamic or guided, with an optional ",CHUNK"
  std::string precision = "float";  ///< float, double
  std::string integrator{};         ///< path, iterative, recursive, branching
  std::string sampler{};            ///< sobol, independent
  int threads = 0;                  ///< up to 4096; 0: all processors
  std::string device{};             ///< cuda, optix: number of the GPU, or all; cuda: host runs the kernels on the CPU
  std::string block{};              ///< cuda, pixel and chunk: threads per block, WxH
  std::string chunk{};              ///< cuda, chunk: chunks in each direction, WxH
  /// Environment map that replaces the infinite lights of the scene: twice as wide as high (equirectangular) or square
  /// (equal-area octahedral). The top of the image is towards +y, its centre towards -z.
  std::string environment{};
  /// Read no files outside the folder of the scene file; for untrusted scenes. Files that are linked or mounted into
  /// the folder count as inside, hard links included.
  bool confine = false;
  /// Folders in which files that the scene names are looked for after the scene's own. With `confine` they must be
  /// within it.
  std::vector<std::string> search_paths{};
  /// A texture image that is in none of them is an error, as other files are. Otherwise a warning names it, and magenta
  /// is shown in its place.
  bool strict = false;
  /// Pixel filter: box, triangle, gaussian, mitchell or sinc, with an optional radius in pixels: "box,0.5". Empty: that
  /// of the scene.
  std::string filter{};
  std::string coats{};      ///< pbrt: lossless, or pbrt to lose as much light as pbrt-v4 does; empty: lossless
  std::string camera{};     ///< glTF: a name, or a number from 0; empty: the first
  std::string variant{};    ///< glTF: a name or a number of KHR_materials_variants; empty: none
  std::string animation{};  ///< glTF: a name or a number; empty: the first if `animation_time` is given
  /// Seconds: the scene at this time of its animation (glTF), or of the motion that it describes (pbrt), when the
  /// shutter opens. Absent: no animation is applied, and the shutter opens when the scene says.
  std::optional<double> animation_time{};
  /// Motion blur: the fraction of the time of a frame for which the shutter is open, 0 to 1; there are
  /// `frames_per_second`. 0: moving things are sharp. Absent: as the scene says (pbrt), or 0 (glTF). Shapes are blurred
  /// as they are moved; a warning says which motion is not: of cameras, lights, skins and morph targets.
  std::optional<double> shutter{};
  double frames_per_second = 24;
  std::vector<std::string> definitions{};  ///< Mitsuba: NAME=VALUE, each replaces $NAME and the scene's default for it
  /// draft, good or final: sets those of `samples_per_pixel`, `noise` and `denoiser` that are left open
  /// (docs/noise.md has the values). Empty: good for a glTF file if all three are left open, otherwise none of them.
  std::string quality{};
  int64_t samples_per_pixel = 0;  ///< with a noise target, the most that a pixel gets (max samples)
  /// Noise target (noise threshold): a pixel gets no more samples once its estimated error is below it; above 0 and at
  /// most 1; 0: none. docs/noise.md says how the error is estimated.
  double noise = 0;
  /// What the noise target is of: relative (to the pixel's luminance; the default), or display: of the sRGB value from
  /// 0 to 1 that is shown at the exposure `noise_exposure` in stops, by the tone map `noise_tone_map` (none, reinhard,
  /// filmic, aces or agx; empty: none). Without an exposure it is 0, or, for a glTF file with lights, the one by which
  /// its image so far is not overexposed. none, with `noise` 0: no target, also if `quality` has one.
  std::string noise_measure{};
  std::optional<double> noise_exposure{};
  /// In the place of `noise_exposure`: the exposure is metered from the image so far, as by `--exposure auto`.
  bool noise_auto_exposure = false;
  std::string noise_tone_map{};
  /// Path guiding, for the integrator path: off, on, or auto to stop it where it does not pay; empty: off.
  /// docs/guiding.md says what it is good for.
  std::string guiding{};
  int64_t guiding_memory = 256;  ///< MiB that it may take
  /// Most that each vertex of a path may add of light that was scattered more than once, in any channel: bright dots
  /// disappear, and so does a part of caustics and reflections. 0: no limit, the right image. For the integrator path.
  double clamp_indirect = 0;
  int64_t max_depth = -1;  ///< bounces: a path has at most max_depth + 1 segments; negative: as the scene says
  /// Pixels, each from 1 to 100000. 0: as the scene says; if only one of them is given, the other follows from the
  /// aspect ratio of the scene.
  int64_t width = 0, height = 0;
  std::optional<uint32_t> seed{};
  /// Where the camera is: its position, what it looks at, and optionally a direction upwards, without which the axis of
  /// the scene that was upward stays so. Empty: as the scene says.
  std::vector<double> look_at{};
  /// Turns the camera about the middle of the scene: azimuth from the front, elevation (degrees), and optionally the
  /// distance, without which the whole scene is seen. Shapes far larger than all others, such as a ground, do not
  /// count.
  std::vector<double> orbit{};
  bool fit = false;             ///< moves the camera so that it sees the whole scene in the direction in which it looks
  std::optional<double> fov{};  ///< degrees over the shorter axis of the image
  std::optional<double> aperture{};  ///< radius of the lens, in scene units; 0: all is sharp
  /// Distance of what is sharp. Absent: of what the camera was placed for by the settings above, else as in the scene.
  std::optional<double> focus{};
  double environment_rotation = 0;  ///< of maps about their zeniths: degrees, counter-clockwise from above
  double environment_strength = 1;  ///< factor on infinite lights
  double light_scale = 1;           ///< factor on all other lights
  /// Part of the image to render: x0, x1, y0, y1 in [0, 1], or in pixels (half open). Give at most one of the two.
  std::optional<std::array<double, 4>> crop_window{};
  std::optional<std::array<int64_t, 4>> pixel_bounds{};
  /// Additional layers, by name; docs/layers.md says what each holds: alpha, albedo, normal, camera_normal, depth,
  /// distance, position, uv, motion, object, material, cryptomatte, components, light_groups, bounces, samples,
  /// variance; noisy (before denoising).
  std::vector<std::string> aovs{};
  /// Groups of lights, each with a layer of what its lights give: NAME=LIGHT,LIGHT, where * and ? stand for any
  /// characters and any one in the names of lights and emissive objects. At most 7; what they leave is in `rest`.
  /// Empty, with the layer light_groups: one for each name of the scene, of which there may be 8.
  std::vector<std::string> light_groups{};
  /// Leaves out the light of the background where the camera sees it directly. The image then has a channel A, and R,
  /// G and B are premultiplied by it.
  bool transparent_background = false;
  bool transparent_glass = false;  ///< also where it sees it through specular glass, whose tint is not transparent
  /// The surface that albedo, normals and distance are of: first, or diffuse for the first that is not perfectly
  /// specular, seen through glass and in mirrors. Empty: diffuse if the image is denoised and none of these layers is
  /// asked for.
  std::string aov_surface{};
  /// none; optix (on an NVIDIA GPU, with any backend), oidn (if its library is here), builtin (any machine); auto: the
  /// best of them that is here. Empty: none. R, G and B are then denoised.
  std::string denoiser{};
  /// Seconds of rendering: stops where the next pass would take longer, or else in the middle of a pass, so that some
  /// pixels have more samples than others. 0: none.
  double time_limit = 0;
  /// File in which to save the state, and from which `resume` continues. A failed save is a warning, and rendering
  /// continues.
  std::string checkpoint{};
  double checkpoint_seconds = 60;
  bool resume = false;
  /// An existing file is refused unless `resume` or this is set, whatever it contains.
  bool overwrite = false;
  /// MiB that texture images may take; larger ones are halved until they fit. 0: no limit.
  int64_t texture_budget = 16384;
};

/// How far a render is, or the reading or building of a scene.
struct Progress {
  /// What is being done: "rendering", and before it steps such as "reading textures" and "building the BVH", during
  /// which only `seconds` is known and all else is 0. A text that is never freed.
  const char* activity = "rendering";
  double fraction = 0;  ///< of the samples, 0 to 1; it does not decrease
  double seconds = 0;   ///< of rendering so far; before it, since the call
  /// With a noise target, `samples_total` is an estimate that changes while the image is rendered.
  uint64_t samples_done = 0, samples_total = 0;
  uint64_t samples_loaded = 0;  ///< of `samples_done`, from the checkpoint that is continued
  uint64_t pixels = 0;          ///< of the image
  double noise = 0;             ///< with a noise target, its estimate when pixels were last decided on; 0: none yet
};

/// While a scene is read and built, it is called before the first step and then before others, at most ten times a
/// second, by the thread that does them. While an image is rendered, it is called about ten times a second by another
/// thread, and once at the end. Calls never overlap.
///
/// Returning false ends the task: renders return the image so far, which is empty before the first sample; what has no
/// image to return throws Cancelled. An exception of any type ends it too: the state is saved if `checkpoint` names a
/// file and rendering had begun, the function is not called again, and the exception reaches the caller of the library.
using ProgressFunction = std::function<bool(const Progress&)>;

/// What a render with a noise target (adaptive sampling) reached.
struct ReachedNoise {
  double noise = 0;         ///< root mean square of the estimated errors of all pixels, in what the target measures
  double below = 0;         ///< fraction of the pixels whose estimated error is below the target
  double mean_samples = 0;  ///< per pixel
};

/// Planes of linear values, rows from the top down: R, G, B (radiance, linear sRGB), A if the background is
/// transparent, and the requested layers by the channels of docs/layers.md (albedo.R, .G, .B; normal.X, .Y, .Z;
/// depth.Z; ...). Stopped before any sample: none, 0 x 0.
struct RenderedImage {
  int width = 0, height = 0;            ///< pixels of what was rendered
  int x = 0, y = 0;                     ///< of its upper left pixel in the whole image; above 0 if it was cropped
  int full_width = 0, full_height = 0;  ///< pixels of the whole image; 0: as `width`, `height`
  std::vector<std::string> channels;
  std::vector<std::vector<float>> planes;
  bool complete = true;  ///< false if stopped before all samples were taken or the noise target was reached
  std::optional<ReachedNoise> noise;  ///< present if there was a noise target
  std::string denoiser;               ///< the one that denoised R, G and B; empty: they are not denoised
  std::string quality;                ///< the one that was rendered; empty: none
  double samples = 0;                 ///< per pixel, on average
  double seconds = 0;                 ///< of rendering, without reading and building the scene
  std::vector<Warning> warnings;      ///< of the scene reader and the renderer, each once
  /// What `save` writes into the headers of files, by its name there, as the program does: "scene", "samples", "seed",
  /// "seconds", "settings" as options of the command line, "denoiser", and of layers the names and numbers of objects
  /// and materials ("cryptomatte/...", "object", "material"). More may be added.
  std::map<std::string, std::string> metadata;

  /// The width * height values of a channel, or null. Valid as long as `planes` is not changed.
  const float* plane(const std::string& channel) const;
};

/// Renders a scene file. Throws InputError for bad input and settings, UnsupportedError, OutOfMemoryError, DeviceError,
/// Error for other failures, and anything that `progress` throws. Writes no file but the checkpoint. Until it returns,
/// threads that the process starts have a default stack of at least 8 MiB.
RenderedImage render(const std::string& scene_file, const Settings& settings = {},
                     const ProgressFunction& progress = {});

/// The version of the library that the program runs with: ALHAZEN_VERSION_STRING when it was built.
const char* version();

}  // namespace ALHAZEN_NAMESPACE
