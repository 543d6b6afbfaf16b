#pragma once

// Conclusions from a study in words: every sentence is made from measurements, omitted if there are none, and withheld
// if one of them is in doubt (disturbance.h).

#include <string>
#include <vector>

#include "study/study.h"

namespace alhazen::impl::study {

struct Conclusion {
  std::string title, text;
  bool is_withheld = false;  ///< the text then says why
};

struct Headline {
  std::string text;
  std::string engine;  ///< the fastest of those that are not in doubt; empty if there is none
  double speedup = 0;  ///< over one core, in float
};

Headline headline_of(const Study& study);
std::vector<Conclusion> conclusions_of(const Study& study);
std::string figure3_text(const Study& study);
/// Where, when and how the study was measured, in a few lines.
std::vector<std::string> facts_of(const Study& study);

/// The report that the study reproduces, and which of its tables and figures are measured here.
std::string reproduced_text(const Study& study);
/// What S and D mean.
inline constexpr const char* symbols_text =
    "S is the number of samples per pixel, each of which is one path; D is the maximum number of segments of a path, "
    "which the report calls depth.";

/// What makes the study less reliable: missing runs, and times in doubt.
std::vector<std::string> warnings_of(const Study& study);
/// Sizes and S of the images of a table, if they are few enough to list.
std::string image_sizes_of(const Study& study, const Table& table);

/// Half the spread of a typical trial over its median: the relative noise of a time.
double usual_noise(const Study& study);

}  // namespace alhazen::impl::study
