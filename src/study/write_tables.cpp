// The tables as CSV, one line per cell, and as Markdown.

#include <fmt/format.h>

#include "study/cell_text.h"
#include "study/conclusions.h"
#include "study/disturbance.h"
#include "study/figure1.h"
#include "study/write.h"

namespace alhazen::impl::study {

namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + "\"";
}

/// `|` would end a cell of a Markdown table.
std::string in_cell(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '|') result += '\\';
    result += c;
  }
  return result;
}

bool has_report(const Table& table, const std::string& column) {
  for (const Cell& cell : table.cells)
    if (cell.column == column && !cell.report.empty()) return true;
  return false;
}

bool has_speedups(const Table& table) {
  for (const Cell& cell : table.cells)
    if (!cell.baseline.empty()) return true;
  return false;
}

std::string markdown_cell(const CellText& text, Footnotes& notes) {
  std::string value = text.value;
  if (!text.doubt.empty()) value += "?";
  if (text.is_measured) value += " (" + text.spread + ")";
  if (const size_t note = notes.number_of(text.note)) value += fmt::format(" [{}]", note);
  return value;
}

std::string markdown_table(const Study& study, const Table& table) {
  const bool speedups = has_speedups(table);
  std::string header = "| " + table.row_title + " |", line = "|---|";
  for (const std::string& column : table.columns) {
    header += fmt::format(" {} |", column);
    line += "---|";
    if (speedups) header += " speedup |", line += "---|";
    if (has_report(table, column)) header += " the report |", line += "---|";
  }
  std::string text = header + "\n" + line + "\n";
  Footnotes notes;
  for (const std::string& row : table.rows()) {
    text += "| " + in_cell(row) + " |";
    for (const std::string& column : table.columns) {
      const Cell* cell = table.find(row, column);
      const CellText cell_text = cell ? text_of(study, table, *cell) : CellText{};
      text += cell ? " " + in_cell(markdown_cell(cell_text, notes)) + " |" : " - |";
      if (speedups) text += " " + cell_text.speedup + " |";
      if (has_report(table, column)) text += " " + cell_text.report + " |";
    }
    text += "\n";
  }
  for (size_t i = 0; i < notes.notes().size(); ++i) text += fmt::format("\n[{}] {}\n", i + 1, notes.notes()[i]);
  return text;
}

}  // namespace

std::string csv_of(const Study& study) {
  std::string text =
      "table,row,column,status,reason,median_seconds,min_seconds,max_seconds,repeats,width,height,spp,camera_samples,"
      "rays,speedup,rmse,doubt,note,options\n";
  for (const Table& table : study.tables)
    for (const Cell& cell : table.cells) {
      const Trial& t = *study.find(cell.trial);
      text += fmt::format("{},{},{},{},{},", table.id, quoted(cell.row), quoted(cell.column), to_string(t.status),
                          quoted(t.reason));
      if (t.has_times()) {
        const Spread spread = spread_of(t.seconds);
        const double speedup = speedup_of(study, table, cell);
        text +=
            fmt::format("{},{},{},{},{},{},{},{},{},{},{}", spread.median, spread.min, spread.max, t.seconds.size(),
                        t.width, t.height, t.samples_per_pixel, t.samples, t.rays + t.shadow_rays,
                        speedup > 0 ? fmt::format("{}", speedup) : "", t.rmse >= 0 ? fmt::format("{}", t.rmse) : "");
      } else {
        text += ",,,,,,,,,,";
      }
      text += fmt::format(",{},{},{}\n", quoted(doubt_of(study, cell)), quoted(cell.note), quoted(cell.trial));
    }
  return text;
}

std::string markdown_of(const Study& study) {
  std::string text = fmt::format("# {}\n\n{}\n\n{}\n\n", headline_of(study).text, reproduced_text(study), symbols_text);
  for (const std::string& line : facts_of(study)) text += line + "  \n";
  for (const std::string& warning : warnings_of(study)) text += "\n**Careful:** " + warning + ".\n";
  text += "\n![" + figure1_text() + "](figure1.svg)\n\n## What to conclude\n\n";
  for (const Conclusion& conclusion : conclusions_of(study))
    text += fmt::format("- **{}** {}\n", conclusion.title, conclusion.text);
  for (const Table& table : study.tables)
    text += fmt::format("\n## {}\n\n{} {}\n\n{}", table.title, table.text, image_sizes_of(study, table),
                        markdown_table(study, table));
  if (study.work_per_thread.is_there()) {
    const WorkPerThread& w = study.work_per_thread;
    text += fmt::format("\n## Figure 3: mean number of bounces of every thread\n\n{}\n\n", figure3_text(study));
    text +=
        "| threads | mean | smallest | largest | busiest over mean | Gini | segments in all "
        "|\n|---|---|---|---|---|---|---|\n";
    for (const auto& [name, grid] :
         {std::pair<const char*, const ThreadGrid&>{"one per pixel", w.naive}, {"one for 4 x 4 chunks", w.chunked}})
      text += fmt::format("| {}: {} x {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.0f} |\n", name, grid.width,
                          grid.height, grid.mean(), grid.smallest_mean(), grid.largest_mean(), grid.busiest_over_mean(),
                          gini(grid.segments), grid.total());
  }
  return text;
}

}  // namespace alhazen::impl::study
