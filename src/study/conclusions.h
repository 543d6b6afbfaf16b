#pragma once

// Conclusions from a study in words: every sentence is made from measurements, and omitted if there are none.

#include <string>
#include <vector>

#include "study/study.h"

namespace alhazen::study {

struct Conclusion {
  std::string title, text;
};

struct Headline {
  std::string text;
  std::string engine;  ///< the fastest; empty if nothing was measured
  double speedup = 0;  ///< over one core, in float
};

Headline headline_of(const Study& study);
std::vector<Conclusion> conclusions_of(const Study& study);
std::string figure3_text(const Study& study);
/// Where, when and how the study was measured, in a few lines.
std::vector<std::string> facts_of(const Study& study);

/// A warning if so many runs were disturbed that the times are those of a busy machine; else empty.
std::string disturbance_warning(const Study& study);
/// Sizes and S of the images of a table, if they are few enough to list.
std::string image_sizes_of(const Study& study, const Table& table);

/// Half the spread of a typical trial over its median: the relative noise of a time.
double usual_noise(const Study& study);

}  // namespace alhazen::study
