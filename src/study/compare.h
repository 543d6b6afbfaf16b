#pragma once

// Compares two studies and finds the changes beyond noise.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace alhazen::impl::study {

struct Change {
  std::string table, row, column;
  double a = 0, b = 0;                  ///< medians: nanoseconds per sample, or per ray if the table is in rays
  double a_speedup = 0, b_speedup = 0;  ///< 0: none
  std::string doubt;                    ///< why this may be no change: other programs disturbed one of them
  double ratio() const { return b / a; }
};

struct StudyComparison {
  std::vector<std::string> differences;  ///< of machine, scene, scale, version
  std::vector<Change> changes;           ///< in descending order
  std::vector<std::string> states;       ///< cells that only one of them has measured, and why
  size_t compared = 0;                   ///< cells that both have
  size_t by_chance = 0;                  ///< number of changes expected by chance for as many cells, rounded up
};

/// A change is beyond noise if all repeats of one are slower than all of the other, and the medians differ by more than
/// `threshold` (0.05: 5 %). Throws InputError if a study is damaged; the paths are for the message.
StudyComparison compare_studies(const nlohmann::json& a, const nlohmann::json& b, double threshold,
                                const std::string& path_a, const std::string& path_b);

}  // namespace alhazen::impl::study
