// `alhazen compare`: measures the difference of two images.

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/subcommands.h"
#include "files/atomic_file.h"
#include "files/file_identity.h"
#include "images/image.h"
#include "images/metrics/compare.h"

namespace alhazen {

namespace {

struct CompareOptions {
  std::string a, b;
  bool json = false;
  std::string diff;
  int reduce = 1;
};

/// Numbers that are not finite (psnr of equal images) are null: JSON has no infinity.
std::string json_text(const ImageDifference& d) {
  const nlohmann::ordered_json object{{"mse", d.mse},
                                      {"rmse", d.rmse},
                                      {"relmse", d.relmse},
                                      {"relmse_trimmed", d.relmse_trimmed},
                                      {"psnr", d.psnr},
                                      {"ssim", d.ssim},
                                      {"flip", d.flip},
                                      {"mean_a", d.mean_a},
                                      {"mean_b", d.mean_b},
                                      {"max_abs", d.max_abs},
                                      {"nonfinite_a", d.nonfinite_a},
                                      {"nonfinite_b", d.nonfinite_b}};
  return object.dump();
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
    text += fmt::format("excluded: pixels with NaN or infinity, {} in A and {} in B\n", d.nonfinite_a, d.nonfinite_b);
  return text;
}

void write_difference(const std::string& path, const Image& a, const Image& b) {
  const Image difference = difference_image(a, b);
  write_image(path, source_of(difference), {});
}

void run_compare(const CompareOptions& options) {
  if (!options.diff.empty() && !has_written_extension(options.diff))
    throw InputError("--diff " + options.diff + ": give a file name that ends in " + written_extensions());
  if (!options.diff.empty()) check_target(options.diff);
  refuse_same_file({options.diff, "the image of --diff"}, {{options.a, "the image"}, {options.b, "the reference"}});
  Image a = read_image(options.a), b = read_image(options.b);
  if (options.reduce > 1) a = reduced(a, options.reduce), b = reduced(b, options.reduce);
  const ImageDifference difference = compare_images(a, b);
  print_out("{}{}", options.json ? json_text(difference) : table_text(difference), options.json ? "\n" : "");
  if (!options.diff.empty()) write_difference(options.diff, a, b);
}

}  // namespace

void register_compare(Command& program) {
  Command command = program.add_subcommand("compare", "Measure the difference of two images");
  const auto options = std::make_shared<CompareOptions>();
  command.add_option("A", options->a, "the image in question: EXR, PNG, JPEG, TGA, BMP, QOI, HDR, PFM or WebP")
      .required()
      .value_name("");
  command.add_option("B", options->b, "the reference, of the same size").required().value_name("");
  command.add_flag("--json", options->json, "print one JSON object");
  command.add_option("--diff", options->diff, "write an image of the differences (FLIP), " + written_extensions())
      .value_name("FILE");
  command
      .add_option("--reduce", options->reduce,
                  "compare means of N x N pixels: less noise, and FLIP as for smaller images")
      .within(1, 4096)
      .value_name("N");
  command.on_run([options] { run_compare(*options); });
}

}  // namespace alhazen
