#pragma once

// What the figures of a study say, in words: every sentence is made from its numbers, and left out where there are
// none.

#include <string>
#include <vector>

#include "study/study.h"

namespace alhazen::study {

struct Conclusion {
  std::string title, text;
};

struct Headline {
  std::string text;
  std::string engine;  ///< the fastest; empty: nothing was measured
  double speedup = 0;  ///< over one core, in float
};

Headline headline_of(const Study& study);
std::vector<Conclusion> conclusions_of(const Study& study);
std::string figure3_text(const Study& study);
/// Where, when and how it was measured, in a few lines.
std::vector<std::string> facts_of(const Study& study);

/// Where so many runs were disturbed that the figures are those of a busy machine: a warning; else empty.
std::string disturbance_warning(const Study& study);
/// Sizes and S of the pictures of a table, where they are few enough to be told.
std::string pictures_of(const Study& study, const Table& table);

/// Half the spread of a usual trial over its median: the noise of a time, as a fraction.
double usual_noise(const Study& study);

}  // namespace alhazen::study
