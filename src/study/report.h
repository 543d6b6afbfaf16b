#pragma once

// `alhazen study report`: from a scene file to a study and its folder.

#include <functional>
#include <string>
#include <vector>

#include "study/measure.h"
#include "study/study.h"

namespace alhazen::impl::study {

struct ReportOptions {
  std::string scene;
  std::string output = "study";  ///< a folder
  Scale scale;
  std::vector<std::string> only;  ///< ids of tables and figures to measure; empty: all
  bool resume = false;            ///< continues the study in the folder, and keeps its other parts; so does an
                                  ///< incomplete study without `overwrite`
  bool overwrite = false;         ///< replaces it by another
  std::string command;            ///< the command line, for the page
};

struct ReportEvents {
  GoOn go_on;
  std::function<void(const std::string&)> stage;  ///< receives a description of the next step
  std::function<void(const Measuring&)> progress;
  std::function<void(const std::string&)> warning;
};

struct ReportOutcome {
  bool is_complete = false;        ///< false if stopped; the measurements so far are written
  std::vector<std::string> files;  ///< empty if stopped before anything was measured: then nothing is written
};

/// The ids that `only` may contain.
std::vector<std::string> report_parts();

/// Runs the study and writes it. Throws InputError before measuring, and RenderError if nothing can be written.
ReportOutcome run_report(const ReportOptions& options, const ReportEvents& events);

}  // namespace alhazen::impl::study
