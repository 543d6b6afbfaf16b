#pragma once

// What `alhazen compare` prints of a difference, by name, and limits on it.

#include <string>
#include <utility>
#include <vector>

#include "images/metrics/compare.h"

namespace alhazen::impl {

/// Every measure by its key in JSON.
std::vector<std::pair<std::string, double>> measures_of(const ImageDifference& difference);

struct Limit {
  std::string measure;
  double value = 0;
  bool is_highest = true;  ///< else the lowest
};

/// Reads "flip=0.05". `option` is the one that it is the value of. Throws InputError that lists the measures.
Limit parse_limit(const std::string& text, const std::string& option, bool is_highest);

/// A line about each limit that is not kept; `what` is what was compared, or empty. NaN keeps no limit. Without a pixel
/// to compare no limit is kept, nor where pixels are finite in one image alone, unless a limit on their number is
/// given.
std::vector<std::string> exceeded(const std::vector<Limit>& limits, const ImageDifference& difference,
                                  const std::string& what);

}  // namespace alhazen::impl
