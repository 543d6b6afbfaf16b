#pragma once

// What changed between two studies, beyond noise.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace alhazen::study {

struct Change {
  std::string table, row, column;
  double a = 0, b = 0;                  ///< medians: nanoseconds a sample, or a ray where the table goes by rays
  double a_speedup = 0, b_speedup = 0;  ///< 0: none
  double ratio() const { return b / a; }
};

struct StudyComparison {
  std::vector<std::string> differences;  ///< in what the two are of: machine, scene, scale, version
  std::vector<Change> changes;           ///< the largest first
  std::vector<std::string> states;       ///< cells that are measured in one alone, and why
  size_t compared = 0;                   ///< cells that both have
  size_t by_chance = 0;                  ///< changes that as many cells would show by chance, rounded up
};

/// A change is beyond noise where all repeats of one are slower than all of the other, and the medians differ by more
/// than `threshold` (0.05: 5 %). Throws InputError where a study is damaged; the paths are for the message.
StudyComparison compare_studies(const nlohmann::json& a, const nlohmann::json& b, double threshold,
                                const std::string& path_a, const std::string& path_b);

}  // namespace alhazen::study
