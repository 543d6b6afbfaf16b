#include "study/write.h"

#include <algorithm>
#include <bit>
#include <filesystem>

#include "files/atomic_file.h"
#include "study/figure1.h"
#include "study/folder.h"
#include "study/json.h"
#include "study/plots.h"
#include "study/read_json.h"

namespace alhazen::impl::study {

void write_text(const std::string& path, const std::string& text) {
  AtomicFile file(path);
  file.write(text.data(), text.size());
  file.commit();
}

void write_grey_pfm(const std::string& path, int width, int height, const std::vector<float>& values) {
  const char* scale = std::endian::native == std::endian::little ? "-1.0" : "1.0";
  const std::string header = "Pf\n" + std::to_string(width) + " " + std::to_string(height) + "\n" + scale + "\n";
  AtomicFile file(path);
  file.write(header.data(), header.size());
  const size_t columns = static_cast<size_t>(width);
  for (size_t y = static_cast<size_t>(height); y-- > 0;)
    file.write(values.data() + y * columns, columns * sizeof(float));
  file.commit();
}

void write_json(const Study& study, const std::string& folder) {
  write_text(in_folder(folder, "study.json"), json_text(to_json(study)));
}

namespace {

bool has_plots(const std::string& folder) {
  return std::any_of(all_plots().begin(), all_plots().end(), [&](const Plot& plot) {
    std::error_code ignored;
    return std::filesystem::exists(in_folder(folder, std::string(plot.name) + plot_extensions[0]), ignored);
  });
}

}  // namespace

std::vector<std::string> write_study(const Study& study, const std::string& folder, const WriteEvents& events) {
  std::vector<std::string> files;
  std::string failures;
  // If one file cannot be written, the others still are.
  const auto attempt = [&](const std::string& name, const auto& write) {
    try {
      write(in_folder(folder, name));
      files.push_back(name);
    } catch (const RenderError& failure) {
      failures += (failures.empty() ? "" : "\n") + std::string(failure.what());
    }
  };
  attempt("study.json", [&](const std::string&) {
    write_json(study, folder);
    events.has_saved_study();
  });
  attempt("figure1.svg", [&](const std::string& path) { write_text(path, figure1_svg()); });
  attempt("tables.csv", [&](const std::string& path) { write_text(path, csv_of(study)); });
  attempt("tables.md", [&](const std::string& path) { write_text(path, markdown_of(study)); });
  const std::string problem = draw_plots(folder, events.go_on);
  attempt("index.html", [&](const std::string& path) { write_text(path, html_of(study, folder)); });
  if (!problem.empty() && failures.empty())
    events.warning(problem + (has_plots(folder) ? "; the page shows the plots that are there"
                                                : "; the tables and the page are complete without them"));
  else if (!problem.empty())
    events.warning(problem);
  if (!failures.empty()) throw RenderError(failures);
  return files;
}

}  // namespace alhazen::impl::study
