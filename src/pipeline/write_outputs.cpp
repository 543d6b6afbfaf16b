#include "pipeline/write_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "files/atomic_file.h"
#include "files/file_identity.h"
#include "images/display/tone_map.h"
#include "io/read_scene.h"
#include "render/backend.h"
#include "render/quality.h"
#include "render/setting_table.h"

namespace alhazen::impl {

namespace {

namespace fs = std::filesystem;

void check_output(const std::string& path) {
  if (path == standard_output_name) return;
  if (!has_written_extension(path))
    throw InputError({path},
                     "images are written as " + written_extensions() + ": give a name that ends in one of them");
  check_target(path);
}

std::map<std::string, std::string> metadata_of(const RenderStatistics& s) {
  const RenderSettings& settings = s.settings;
  const std::string strategy = strategy_name(settings);
  std::map<std::string, std::string> metadata{
      {"software", std::string("Alhazen ") + version()},
      {"scene", s.scene},
      {"samples", fmt::format("{:.10g}", s.mean_samples)},
      {"seed", std::to_string(settings.seed)},
      {"seconds", fmt::format("{:.3f}", s.render_seconds)},
      {"denoiser", s.denoiser.empty() ? "none" : s.denoiser},
      {"settings",
       fmt::format("--backend {}{}{} --precision {} --integrator {} --sampler {} --max-depth {} --threads {}",
                   settings.backend, strategy.empty() ? "" : " --strategy ", strategy, to_string(settings.precision),
                   to_string(settings.integrator), to_string(settings.sampler), settings.max_segments - 1,
                   settings.threads)}};
  // What changes the image, and is off unless asked for.
  if (settings.guiding != GuidingMode::off) metadata["settings"] += " --guiding " + to_string(settings.guiding);
  if (settings.asked.clamp_indirect > 0)
    metadata["settings"] += " --clamp-indirect " + setting_text(settings.asked, "clamp-indirect");
  if (settings.records_through_specular) metadata["settings"] += " --aov-surface diffuse";
  if (settings.has_alpha) metadata["settings"] += " --transparent-background";
  if (settings.asked.transparent_glass) metadata["settings"] += " --transparent-glass";
  for (const char* name : {"time", "animation", "shutter", "look-at", "orbit", "fit", "fov", "aperture", "focus",
                           "environment-rotate", "environment-strength", "light-scale"})
    if (const std::string text = setting_text(settings.asked, name); !text.empty())
      metadata["settings"] += std::string(" --") + name + (text == "true" ? "" : " " + text);
  if (!settings.asked.quality.empty())
    metadata["quality"] = settings.asked.quality + ": " + quality_options(settings.asked);
  if (settings.asked.noise > 0)
    metadata["noise"] =
        fmt::format("target {}; reached {:.3g}, {:.4g} % of the pixels; {:.5g} samples per pixel",
                    setting_text(settings.asked, "noise"), s.noise.noise, 100 * s.noise.below, s.noise.mean_samples);
  return metadata;
}

}  // namespace

std::string display_text(const WriteOptions& how) {
  return fmt::format("--exposure {:.10g}", how.exposure) +
         (how.white_temperature > 0 ? fmt::format(" --white-balance {:.10g}", how.white_temperature) : "") +
         " --tone-map " + to_string(how.tone_map);
}

std::map<std::string, std::string> image_metadata(const Rendering& rendering, bool has_layers) {
  std::map<std::string, std::string> metadata = metadata_of(rendering.statistics);
  if (has_layers) metadata.merge(rendering.layer_metadata());
  return metadata;
}

std::vector<std::string> choose_outputs(const std::vector<std::string>& asked, const std::string& film_filename,
                                        const std::string& scene_path, Diagnostics& diagnostics) {
  std::vector<std::string> paths = asked;
  if (paths.empty()) {
    const std::string name = fs::path(film_filename).filename().string();
    if (has_written_extension(name)) {
      paths = {name};
    } else {
      fs::path stem = scene_path == standard_input_name ? "stdin" : fs::path(scene_path).filename();
      while (stem.has_extension()) stem = stem.stem();
      paths = {stem.string() + ".exr"};
      if (!name.empty())
        diagnostics.warn({scene_path}, "the scene asks for '" + name + "', and images are written as " +
                                           written_extensions() + ": the image becomes '" + paths[0] + "'");
    }
  }
  for (const std::string& path : paths) check_output(path);
  return paths;
}

void check_sizes(const std::vector<std::string>& outputs, const PixelWindow& window) {
  for (const std::string& path : outputs)
    if ((extension_of(path) == "jpg" || extension_of(path) == "jpeg") &&
        std::max(window.width(), window.height()) > max_jpeg_side)
      throw InputError({path}, "a JPEG has at most " + std::to_string(max_jpeg_side) +
                                   " pixels in each direction: give a name that ends in .png, or a smaller --size");
}

void check_files(const std::vector<std::string>& outputs, const std::string& checkpoint,
                 const std::vector<NamedFile>& inputs, const InputRecord& record) {
  std::vector<NamedFile> taken = inputs;
  for (const std::string& path : outputs) {
    refuse_same_file({path, "the output"}, taken);
    record.refuse(path, "the output");
    taken.push_back({path, "another output"});
  }
  refuse_same_file({checkpoint, "the checkpoint"}, taken);
  record.refuse(checkpoint, "the checkpoint");
}

namespace {

std::string format_name(const std::string& path, const OutputOptions& options) {
  return path == standard_output_name ? "image." + options.standard_output_format : path;
}

void write_output(const std::string& path, const OutputOptions& options, const Rendering& rendering) {
  const std::string format = format_name(path, options);
  const RenderSettings& settings = rendering.statistics.settings;
  WriteOptions how = options.how;
  how.metadata = image_metadata(rendering, extension_of(format) == "exr");
  if (is_displayed_format(format)) how.metadata["display"] = display_text(how);
  how.x_offset = settings.window.x0;
  how.y_offset = settings.window.y0;
  how.full_width = settings.width;
  how.full_height = settings.height;
  if (path != standard_output_name) return write_image(path, rendering.source(), how);
#define ALHAZEN_WRITE(name) \
  if (extension_of(format) == #name) return write_##name(path, rendering.source(), how);
  ALHAZEN_WRITTEN_FORMATS(ALHAZEN_WRITE)
#undef ALHAZEN_WRITE
  throw RenderError("no image is written as ." + extension_of(format));
}

/// Pipes may wait for their reader for long, so files are written before them.
bool is_file(const std::string& path) {
  if (path == standard_output_name) return false;
  std::error_code ignored;
  return fs::status(path, ignored).type() != fs::file_type::fifo;
}

}  // namespace

std::vector<std::string> OutputOptions::format_names() const {
  std::vector<std::string> names;
  for (const std::string& path : paths) names.push_back(format_name(path, *this));
  return names;
}

OutputReport write_outputs(const OutputOptions& options, const Rendering& rendering) {
  std::vector<std::string> order = options.paths;
  std::stable_partition(order.begin(), order.end(), is_file);
  OutputReport report;
  for (const std::string& path : order) {
    try {
      write_output(path, options, rendering);
      report.written.push_back(path);
    } catch (const std::bad_alloc&) {
      report.failures.push_back("cannot write " + path +
                                ": out of memory; this machine, or a limit set on it, allows no more");
    } catch (const std::exception& failure) {
      report.failures.push_back(failure.what());
    }
  }
  return report;
}

}  // namespace alhazen::impl
