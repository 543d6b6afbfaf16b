#include "study/report_figures.h"

namespace alhazen::impl::study {

namespace {

/// Seconds and speedup as printed.
struct Printed {
  double seconds, speedup;
};

struct Row {
  const char *table, *row;
  Printed cuda2_double, cuda2_float, cuda3_double, cuda3_float;
};

/// For rows that have only one machine or precision.
constexpr Printed absent{-1, 0};
constexpr Printed not_launched{0, 0};

/// Tables 1 to 5. Table 2 was measured with the threads and schedule that were fastest in Table 3, 8 and dynamic.
constexpr Row rows[] = {
    {"table1", "recursive (Algorithm 3)", {9652, 0}, {10524, 0}, {10123, 0}, {10028, 0}},

    {"table2", "rows (simple)", absent, {3048, 0}, absent, absent},
    {"table2", "collapse", absent, {3220, 0}, absent, absent},
    {"table2", "rows+reduction", absent, {3131, 0}, absent, absent},
    {"table2", "reduction", absent, {4672, 0}, absent, absent},

    {"table3", "4 static", {4533, 2.13}, {4745, 2.22}, {4995, 2.03}, {4886, 2.05}},
    {"table3", "4 dynamic", {3797, 2.54}, {4020, 2.62}, {4269, 2.37}, {5175, 1.94}},
    {"table3", "8 static", {3325, 2.90}, {3198, 3.29}, {4498, 2.25}, {4684, 2.14}},
    {"table3", "8 dynamic", {3127, 3.09}, {3048, 3.45}, {4409, 2.30}, {4552, 2.20}},
    {"table3", "12 static", {3232, 2.99}, {3506, 3.00}, {4912, 2.06}, {4210, 2.38}},
    {"table3", "12 dynamic", {3116, 3.10}, {3251, 3.24}, {4807, 2.11}, {4060, 2.47}},

    {"table4", "8x8", {390, 24.75}, {358, 29.40}, {237, 42.71}, {346, 28.98}},
    {"table4", "16x16", {332, 29.07}, {342, 30.77}, {203, 49.87}, {336, 29.85}},
    {"table4", "16x32", {339, 28.47}, {326, 32.28}, {210, 48.20}, {343, 29.24}},
    {"table4", "32x32", not_launched, {372, 28.29}, not_launched, {372, 26.96}},

    {"table5", "8x8, 1x1", {374, 25.81}, {179, 58.79}, {232, 43.63}, {239, 41.96}},
    {"table5", "8x8, 2x2", {417, 23.15}, {194, 54.25}, {240, 42.18}, {235, 42.67}},
    {"table5", "8x8, 4x4", {386, 25.01}, {129, 81.58}, {257, 39.39}, {114, 87.96}},
    {"table5", "8x8, 5x5", {348, 27.74}, {133, 79.13}, {166, 60.98}, {128, 78.34}},
    {"table5", "16x16, 1x1", {329, 29.34}, {163, 64.56}, {201, 50.36}, {230, 43.60}},
    {"table5", "16x16, 2x2", {357, 27.04}, {190, 55.39}, {213, 47.53}, {237, 42.31}},
    {"table5", "16x16, 4x4", {474, 20.36}, {142, 74.11}, {235, 43.08}, {116, 86.45}},
    {"table5", "16x16, 5x5", {465, 20.76}, {145, 72.58}, {188, 53.85}, {146, 68.68}},

    {"optix", "OptiX", absent, {2, 0}, absent, absent},
};

}  // namespace

std::vector<ReportFigure> report_figures(const std::string& table, const std::string& row, const std::string& column) {
  std::vector<ReportFigure> figures;
  for (const Row& r : rows) {
    if (table != r.table || row != r.row) continue;
    const bool in_double = column == "double";
    const Printed cuda2 = in_double ? r.cuda2_double : r.cuda2_float;
    const Printed cuda3 = in_double ? r.cuda3_double : r.cuda3_float;
    if (cuda2.seconds >= 0) figures.push_back({"cuda2", cuda2.seconds, cuda2.speedup});
    if (cuda3.seconds >= 0) figures.push_back({"cuda3", cuda3.seconds, cuda3.speedup});
  }
  return figures;
}

}  // namespace alhazen::impl::study
