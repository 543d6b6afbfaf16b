#include "cli/display_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "colour/white_point.h"
#include "images/display/tone_map.h"
#include "util/parse_numbers.h"

namespace alhazen::impl {

namespace {

void parse_exposure(const std::string& text, OutputOptions& output, Settings& settings) {
  if (text.empty()) return;
  if (text == "auto") {
    output.display.exposure = ExposureRule::automatic;
    settings.noise_auto_exposure = true;
    return;
  }
  if (!parse_number(text, output.how.exposure) || !std::isfinite(output.how.exposure))
    throw InputError("--exposure must be a finite number of stops, or auto, not '" + text + "'");
  settings.noise_exposure = output.how.exposure;
}

void check_exposure(const std::string& text) {
  OutputOptions output;
  Settings settings;
  parse_exposure(text, output, settings);
}

void parse_white_balance(const std::string& text, OutputOptions& output) {
  double& kelvin = output.how.white_temperature;
  if (text == "auto") output.display.estimates_white = true;
  if (text.empty() || text == "auto" || text == "off") return;
  if (!parse_number(text, kelvin) || !(kelvin >= min_white_temperature && kelvin <= max_white_temperature))
    throw InputError(
        fmt::format("--white-balance must be a colour temperature from {} to {} kelvin, auto or off, not '{}'",
                    min_white_temperature, max_white_temperature, text));
}

void check_white_balance(const std::string& text) {
  OutputOptions output;
  parse_white_balance(text, output);
}

void check_png_depth(const std::string& text) {
  if (text != "8" && text != "16") throw InputError("--png-depth must be 8 or 16 bits per channel, not '" + text + "'");
}

int parse_jpeg_quality(const std::string& text) {
  int quality = 0;
  if (!parse_number(text, quality) || quality < 1 || quality > 100)
    throw InputError("--jpeg-quality must be a whole number from 1 to 100, not '" + text + "'");
  return quality;
}

}  // namespace

void add_display_options(Command& command, DisplayOptions& o, const std::string& group) {
  command
      .add_option("--exposure", o.exposure,
                  "PNG, JPEG: brightness in stops, each of which doubles it; or auto, to expose for the surfaces seen")
      .checked(check_exposure)
      .value_name("STOPS")
      .group(group);
  command
      .add_option("--white-balance", o.white_balance,
                  "PNG, JPEG: make light of this colour temperature white; or auto; or off, the default")
      .checked(check_white_balance)
      .value_name("KELVIN")
      .group(group);
  command.add_option("--tone-map", o.tone_map, "PNG, JPEG: " + tone_map_names())
      .checked([](const std::string& text) { tone_map_named(text); })
      .value_name("NAME")
      .group(group);
  command.add_option("--png-depth", o.png_depth, "PNG: bits per channel, 8 or 16")
      .checked(check_png_depth)
      .value_name("BITS")
      .group(group);
  command.add_option("--jpeg-quality", o.jpeg_quality, "JPEG: 1 (smallest file) to 100 (best); 95 by default")
      .checked([](const std::string& text) { parse_jpeg_quality(text); })
      .value_name("N")
      .group(group);
}

void parse_display_options(const DisplayOptions& o, OutputOptions& output, Settings& settings) {
  parse_exposure(o.exposure, output, settings);
  parse_white_balance(o.white_balance, output);
  output.how.tone_map = tone_map_named(o.tone_map);
  settings.noise_tone_map = o.tone_map;
  if (o.png_depth == "16") output.how.png_depth = 16;
  if (!o.jpeg_quality.empty()) output.how.jpeg_quality = parse_jpeg_quality(o.jpeg_quality);
}

void warn_of_display_options(const DisplayOptions& o, const std::vector<std::string>& outputs, bool limits_noise,
                             const std::function<void(const std::string&, const std::string&)>& warn) {
  const auto writes = [&](const std::vector<std::string>& extensions) {
    return std::any_of(outputs.begin(), outputs.end(), [&](const std::string& path) {
      return std::find(extensions.begin(), extensions.end(), extension_of(path)) != extensions.end();
    });
  };
  const bool is_displayed = std::any_of(outputs.begin(), outputs.end(), is_displayed_format);
  const std::string reason = "it is for PNG and JPEG, and the other formats keep the radiance as it is";
  if (!is_displayed && !limits_noise && !o.exposure.empty()) warn("exposure", reason);
  if (!is_displayed && !o.white_balance.empty()) warn("white-balance", reason);
  if (!is_displayed && !limits_noise && !o.tone_map.empty()) warn("tone-map", reason);
  if (!writes({"png"}) && !o.png_depth.empty()) warn("png-depth", "no PNG is written");
  if (!writes({"jpg", "jpeg"}) && !o.jpeg_quality.empty()) warn("jpeg-quality", "no JPEG is written");
}

std::string display_lines(const DisplayStatistics& display) {
  std::string lines;
  if (display.exposure_is_metered) lines += fmt::format("exposure: auto chose {:+.1f} EV\n", display.exposure);
  if (display.white_is_estimated)
    lines += display.white_temperature > 0
                 ? fmt::format("white balance: auto chose {:.0f} K\n", display.white_temperature)
                 : "white balance: auto left the colours as they are, as the image is black\n";
  return lines;
}

}  // namespace alhazen::impl
