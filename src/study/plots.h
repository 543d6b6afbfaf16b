#pragma once

// Plots of a study, by Python and matplotlib: python/study_plots.py, which the program carries within itself.

#include <string>
#include <vector>

namespace alhazen::study {

struct Plot {
  const char* name;     ///< of its files, which end in .png and .svg
  const char* section;  ///< id of the table that it belongs to; figure2, figure3
  const char* title;
};

const std::vector<Plot>& all_plots();

/// Draws the plots of the study.json in `folder` into it. Empty, or a line that says why there are none and, where it
/// is known, how to get them. Old plots are taken away first, so that none is of another study.
std::string draw_plots(const std::string& folder);

}  // namespace alhazen::study
