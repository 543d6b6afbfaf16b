// `alhazen compare`: measures the difference of two images.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/compare_limits.h"
#include "cli/compare_page.h"
#include "cli/console.h"
#include "cli/subcommands.h"
#include "files/atomic_file.h"
#include "files/file_identity.h"
#include "images/image.h"
#include "images/metrics/compare.h"
#include "images/metrics/image_parts.h"
#include "util/parse_numbers.h"
#include "util/printable.h"

namespace alhazen::impl {

namespace {

struct CompareOptions {
  std::string a, b;
  bool json = false;
  std::string diff, html;
  int reduce = 1;
  std::vector<std::string> layers;
  std::string region;
  std::vector<Limit> limits;
};

/// Numbers that are not finite (psnr of equal images) are null: JSON has no infinity.
nlohmann::ordered_json json_of(const ImageDifference& d) {
  nlohmann::ordered_json object;
  for (const auto& [name, value] : measures_of(d)) object[name] = value;
  object["nonfinite_a"] = d.nonfinite_a;
  object["nonfinite_b"] = d.nonfinite_b;
  object["nonfinite_in_one"] = d.nonfinite_in_one;
  object["compared"] = d.compared;
  return object;
}

std::string table_text(const ImageDifference& d) {
  std::string text;
  const auto line = [&](const char* name, double value, const char* meaning) {
    text += fmt::format("{:<8} {:>12.6g}   {}\n", name, value, meaning);
  };
  line("MSE", d.mse, "mean squared error, linear");
  line("RMSE", d.rmse, "its root");
  line("relMSE", d.relmse, "squared error over (B^2 + 0.01)");
  line("trimmed", d.relmse_trimmed, "relMSE without the 0.1 % of pixels of largest error");
  line("PSNR", d.psnr, "dB, sRGB-encoded");
  line("SSIM", d.ssim, "1 for equal images, encoded luminance");
  line("FLIP", d.flip, "0 for equal images, 67 pixels per degree");
  line("max", d.max_abs, "largest difference of a channel");
  line("mean A", d.mean_a, "luminance");
  line("mean B", d.mean_b, "luminance, of the reference");
  if (d.nonfinite_a + d.nonfinite_b > 0)
    text += fmt::format("excluded: pixels with NaN or infinity, {} in A and {} in B, {} of them in one alone{}\n",
                        d.nonfinite_a, d.nonfinite_b, d.nonfinite_in_one,
                        d.compared == 0 ? "; no pixel is left to compare" : "");
  return text;
}

std::array<int64_t, 4> parse_region(const std::string& text) {
  std::array<int64_t, 4> bounds{};
  if (!parse_numbers(text, ',', bounds))
    throw InputError("--region must be x0,y0,x1,y1, in pixels from the top left, not '" + text + "'");
  return bounds;
}

/// Those asked for; of "all", the layers that both images have.
std::vector<std::string> chosen_layers(const CompareOptions& options, const Image& a, const Image& b) {
  std::vector<std::string> layers;
  for (const std::string& layer : options.layers) {
    if (layer != "all") {
      layers.push_back(layer);
      continue;
    }
    const std::vector<std::string> in_a = layer_names(a), in_b = layer_names(b);
    const auto has = [](const std::vector<std::string>& names, const std::string& name) {
      return std::find(names.begin(), names.end(), name) != names.end();
    };
    for (const std::string& name : in_a)
      has(in_b, name) ? layers.push_back(name) : tell("warning: only A has the layer {}\n", printable(name));
    for (const std::string& name : in_b)
      if (!has(in_a, name)) tell("warning: only B has the layer {}\n", printable(name));
    if (layers.empty()) throw InputError("the images have no layer in common");
  }
  return layers;
}

std::vector<ComparedPart> compare_parts(const CompareOptions& options, const Image& a, const Image& b) {
  std::vector<ComparedPart> parts;
  const bool wants_map = !options.diff.empty() || !options.html.empty();
  const auto add = [&](const std::string& layer, Image&& part_a, Image&& part_b) {
    if (!options.region.empty()) {
      const std::array<int64_t, 4> bounds = parse_region(options.region);
      part_a = region_of(part_a, bounds);
      part_b = region_of(part_b, bounds);
    }
    if (options.reduce > 1) part_a = reduced(part_a, options.reduce), part_b = reduced(part_b, options.reduce);
    ComparedPart part{layer, std::move(part_a), std::move(part_b), {}, {}};
    part.difference = compare_images(part.a, part.b);
    if (wants_map) part.heat_map = difference_image(part.a, part.b);
    parts.push_back(std::move(part));
  };
  if (options.layers.empty()) add("", Image(a), Image(b));
  for (const std::string& layer : chosen_layers(options, a, b))
    add(layer, layer_of(a, layer, options.a), layer_of(b, layer, options.b));
  return parts;
}

std::string report_text(const CompareOptions& options, const std::vector<ComparedPart>& parts) {
  const auto name_of = [](const ComparedPart& part) { return part.layer.empty() ? "colours" : part.layer; };
  if (options.json) {
    nlohmann::ordered_json layers;
    for (const ComparedPart& part : parts) layers[name_of(part)] = json_of(part.difference);
    const nlohmann::ordered_json whole =
        options.layers.empty() ? json_of(parts[0].difference) : nlohmann::ordered_json{{"layers", layers}};
    return whole.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace) + "\n";
  }
  std::string text;
  for (const ComparedPart& part : parts) {
    if (!options.layers.empty()) text += (text.empty() ? "" : "\n") + printable(name_of(part)) + "\n";
    text += table_text(part.difference);
  }
  return text;
}

void write_text(const std::string& path, const std::string& text) {
  AtomicFile file(path);
  file.write(text.data(), text.size());
  file.commit();
}

void check_outputs(const CompareOptions& options) {
  if (!options.diff.empty() && !has_written_extension(options.diff))
    throw InputError("--heat-map " + options.diff + ": give a file name that ends in " + written_extensions());
  if (!options.diff.empty() &&
      (options.layers.size() > 1 || (options.layers.size() == 1 && options.layers[0] == "all")))
    throw InputError("--heat-map shows one layer: name one with --layer, or give --html, which shows all");
  if (!options.html.empty() && extension_of(options.html) != "html" && extension_of(options.html) != "htm")
    throw InputError("--html " + options.html + ": give a file name that ends in .html");
  const std::vector<NamedFile> inputs{{options.a, "the image"}, {options.b, "the reference"}};
  for (const auto& [path, role] :
       {std::pair{options.diff, "the image of --heat-map"}, std::pair{options.html, "the page of --html"}}) {
    if (path.empty()) continue;
    check_target(path);
    refuse_same_file({path, role}, inputs);
  }
  refuse_same_file({options.html, "the page of --html"}, {{options.diff, "the image of --heat-map"}});
}

int run_compare(const CompareOptions& options) {
  check_outputs(options);
  if (!options.region.empty()) parse_region(options.region);
  const Image a = read_image(options.a), b = read_image(options.b);
  const std::vector<ComparedPart> parts = compare_parts(options, a, b);
  print_out("{}", report_text(options, parts));
  int exit_code = exit_done;
  for (const ComparedPart& part : parts)
    for (const std::string& line : exceeded(options.limits, part.difference, part.layer)) {
      tell("alhazen: {}\n", printable(line));
      exit_code = exit_failed;
    }
  if (!options.diff.empty()) write_image(options.diff, source_of(parts[0].heat_map), {});
  if (!options.html.empty()) write_text(options.html, comparison_page(options.a, options.b, parts));
  return exit_code;
}

}  // namespace

void register_compare(Command& program, int& exit_code) {
  Command command = program.add_subcommand("compare", "Measure the difference of two images");
  const auto options = std::make_shared<CompareOptions>();
  command.add_option("A", options->a, "the image in question: EXR, PNG, JPEG, TGA, BMP, QOI, HDR, PFM or WebP")
      .required()
      .value_name("");
  command.add_option("B", options->b, "the reference, of the same size").required().value_name("");
  command.add_flag("--json", options->json, "print one JSON object");
  const auto add_limit = [&](const std::string& name, bool is_highest, const std::string& help) {
    const auto set = [options, name, is_highest](const std::string& text) {
      options->limits.push_back(parse_limit(text, name, is_highest));
    };
    command.add_repeatable_option(name, set, help).value_name("MEASURE=X");
  };
  add_limit("--fail-above", true,
            "exit code 1 if the measure is above X: flip=0.05; measures have the names of --json; may be given more "
            "than once");
  add_limit("--fail-below", false, "the same if it is below X: psnr=40");
  command
      .add_option("--layer", options->layers,
                  "compare this layer of two EXRs instead of their colours; may be given more "
                  "than once; all: every layer that both have")
      .repeatable()
      .value_name("NAME");
  command.add_option("--region", options->region, "compare these pixels only, from the top left")
      .value_name("X0,Y0,X1,Y1");
  command
      .add_option("--diff,--heat-map", options->diff,
                  "write an image of the differences (FLIP), " + written_extensions())
      .value_name("FILE");
  command
      .add_option("--html", options->html,
                  "write a page that shows both, with a slider, alternating, side by side, and their error")
      .value_name("FILE");
  command
      .add_option("--reduce", options->reduce,
                  "compare means of N x N pixels: less noise, and FLIP as for smaller images")
      .within(1, 4096)
      .value_name("N");
  command.on_run([options, &exit_code] { exit_code = run_compare(*options); });
}

}  // namespace alhazen::impl
