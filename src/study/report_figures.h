#pragma once

// The figures of the report "Accelerating Ray Tracing" (Huang, Kuanyshbay, Long), by their position in a study. Its
// machines: cuda2 and cuda3 of the Courant Institute; S = 1,000, D = 10.

#include <string>
#include <vector>

#include "study/study.h"

namespace alhazen::impl::study {

inline constexpr const char* report_title = "Accelerating Ray Tracing";
inline constexpr const char* report_authors =
    "Wei-Lun Huang (Center for Data Science), Maksat Kuanyshbay (Department of Mathematics) and YiTao Long (Department "
    "of Computer Science), New York University";

/// Empty if the report has no figure there.
std::vector<ReportFigure> report_figures(const std::string& table, const std::string& row, const std::string& column);

}  // namespace alhazen::impl::study
