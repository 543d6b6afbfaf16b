#pragma once

// The figures of the report "Accelerating Ray Tracing" (Huang, Kuanyshbay, Long), by the place that they have in a
// study. Its machines: cuda2 and cuda3 of the Courant Institute; S = 1,000, D = 10.

#include <string>
#include <vector>

#include "study/study.h"

namespace alhazen::study {

/// Empty where the report has nothing there.
std::vector<ReportFigure> report_figures(const std::string& table, const std::string& row, const std::string& column);

}  // namespace alhazen::study
