#pragma once

// `alhazen study report`: everything from a scene file to a study and the folder that it is written to.

#include <functional>
#include <string>
#include <vector>

#include "study/measure.h"
#include "study/study.h"

namespace alhazen::study {

struct ReportOptions {
  std::string scene;
  std::string output = "study";  ///< a folder
  Scale scale;
  std::vector<std::string> only;  ///< ids of tables and figures; empty: all
  bool resume = false;            ///< goes on with the study that is in the folder
  bool overwrite = false;         ///< puts another one in its place
  std::string command;            ///< as it was given, for the page
};

struct ReportEvents {
  GoOn go_on;
  std::function<void(const std::string&)> stage;  ///< what is done next, for a person
  std::function<void(const Measuring&)> progress;
  std::function<void(const std::string&)> warning;
};

struct ReportOutcome {
  bool is_complete = false;  ///< false: it was stopped, and what there was is written
  std::vector<std::string> files;
};

/// The ids that `only` may hold.
std::vector<std::string> report_parts();

/// Runs the study and writes it. Throws InputError before anything is measured, RenderError where nothing can be
/// written.
ReportOutcome run_report(const ReportOptions& options, const ReportEvents& events);

}  // namespace alhazen::study
