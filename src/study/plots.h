#pragma once

// Draws the plots of a study by Python and matplotlib: python/alhazen/study_plots.py, which is embedded in the program.

#include <string>
#include <vector>

#include "study/run_work.h"

namespace alhazen::impl::study {

struct Plot {
  const char* name;     ///< of its files, which end in .png and .svg
  const char* section;  ///< id of the table to which it belongs; figure2, figure3
  const char* title;
};

const std::vector<Plot>& all_plots();
inline constexpr const char* plot_extensions[] = {".png", ".svg"};

/// Draws the plots of the study.json in `folder` into it. Returns an empty string, or a line that says why there are no
/// plots and, if known, how to get them. A plot that is there is replaced only by its complete successor. Once `go_on`
/// returns false, drawing ends.
std::string draw_plots(
    const std::string& folder, const GoOn& go_on = [] { return true; });

}  // namespace alhazen::impl::study
