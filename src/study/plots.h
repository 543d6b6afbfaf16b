#pragma once

// Draws the plots of a study by Python and matplotlib: python/study_plots.py, which is embedded in the program.

#include <string>
#include <vector>

namespace alhazen::study {

struct Plot {
  const char* name;     ///< of its files, which end in .png and .svg
  const char* section;  ///< id of the table to which it belongs; figure2, figure3
  const char* title;
};

const std::vector<Plot>& all_plots();

/// Draws the plots of the study.json in `folder` into it. Returns an empty string, or a line that says why there are no
/// plots and, if known, how to get them. Old plots are removed first, so that none is from another study.
std::string draw_plots(const std::string& folder);

}  // namespace alhazen::study
