#include "cli/compare_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "util/diagnostics.h"
#include "util/parse_numbers.h"

namespace alhazen::impl {

std::vector<std::pair<std::string, double>> measures_of(const ImageDifference& d) {
  return {{"mse", d.mse},
          {"rmse", d.rmse},
          {"relmse", d.relmse},
          {"relmse_trimmed", d.relmse_trimmed},
          {"psnr", d.psnr},
          {"ssim", d.ssim},
          {"flip", d.flip},
          {"mean_a", d.mean_a},
          {"mean_b", d.mean_b},
          {"max_abs", d.max_abs},
          {"nonfinite_a", static_cast<double>(d.nonfinite_a)},
          {"nonfinite_b", static_cast<double>(d.nonfinite_b)},
          {"nonfinite_in_one", static_cast<double>(d.nonfinite_in_one)},
          {"compared", static_cast<double>(d.compared)}};
}

Limit parse_limit(const std::string& text, const std::string& option, bool is_highest) {
  const size_t equals = text.find('=');
  Limit limit{text.substr(0, equals), 0, is_highest};
  std::string names;
  bool is_known = false;
  for (const auto& [name, value] : measures_of({})) {
    names += (names.empty() ? "" : ", ") + name;
    is_known = is_known || name == limit.measure;
  }
  const bool is_number = equals != std::string::npos && parse_number(text.substr(equals + 1), limit.value);
  if (!is_known || !is_number || std::isnan(limit.value))
    throw InputError(option + " must be MEASURE=NUMBER, for example flip=0.05, not '" + text + "'; measures are " +
                     names);
  return limit;
}

namespace {

/// Why no measure of these images keeps a limit; empty if measures decide.
std::string failure_of_all(const std::vector<Limit>& limits, const ImageDifference& d) {
  if (d.compared == 0) return "no pixel is finite in both images: nothing is compared, and every limit fails";
  const bool is_limited = std::any_of(limits.begin(), limits.end(),
                                      [](const Limit& limit) { return limit.measure.starts_with("nonfinite"); });
  if (d.nonfinite_in_one == 0 || is_limited) return {};
  return fmt::format(
      "{} pixel{} NaN or infinity in one of the images alone: every limit fails (a limit on "
      "nonfinite_in_one allows some)",
      d.nonfinite_in_one, d.nonfinite_in_one == 1 ? " has" : "s have");
}

}  // namespace

std::vector<std::string> exceeded(const std::vector<Limit>& limits, const ImageDifference& difference,
                                  const std::string& what) {
  const std::string prefix = what.empty() ? "" : what + ": ";
  if (const std::string failure = failure_of_all(limits, difference); !limits.empty() && !failure.empty())
    return {prefix + failure};
  std::vector<std::string> lines;
  const auto measures = measures_of(difference);
  for (const Limit& limit : limits) {
    const auto found =
        std::find_if(measures.begin(), measures.end(), [&](const auto& m) { return m.first == limit.measure; });
    const bool is_kept = limit.is_highest ? found->second <= limit.value : found->second >= limit.value;
    if (!is_kept)
      lines.push_back(fmt::format("{}{} is {:.6g}, {} {:g}", prefix, limit.measure, found->second,
                                  limit.is_highest ? "above" : "below", limit.value));
  }
  return lines;
}

}  // namespace alhazen::impl
