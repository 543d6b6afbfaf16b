// The page: one self-contained HTML file, images included.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "study/cell_text.h"
#include "study/conclusions.h"
#include "study/disturbance.h"
#include "study/figure1.h"
#include "study/page_style.h"
#include "study/plots.h"
#include "study/write.h"

namespace alhazen::impl::study {

namespace {

namespace fs = std::filesystem;

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '`':
        break;
      default:
        result += c;
    }
  return result;
}

std::string base64(const std::string& bytes) {
  constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<uint8_t>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[group >> (18 - 6 * k) & 63];
  }
  return text;
}

/// An image of the folder, embedded in the page; nothing if the file does not exist.
std::string embedded_image(const fs::path& file, const char* type, const std::string& title) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return {};
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  return fmt::format("<figure><img alt=\"{0}\" src=\"data:{1};base64,{2}\"><figcaption>{0}</figcaption></figure>\n",
                     escaped(title), type, base64(bytes));
}

/// The plots of a section. Heat maps, which have an element per thread, are PNG; others are SVG.
std::string plots_of(const std::string& section, const std::string& folder) {
  std::string html;
  for (const Plot& plot : all_plots()) {
    if (section != plot.section) continue;
    const bool is_heat_map = section == "figure3";
    const fs::path file = fs::path(folder) / (std::string(plot.name) + (is_heat_map ? ".png" : ".svg"));
    html += embedded_image(file, is_heat_map ? "image/png" : "image/svg+xml", plot.title);
  }
  return html;
}

/// The largest speedup in a column of a table of those that are not in doubt, to scale bars.
double max_speedup(const Study& study, const Table& table, const std::string& column) {
  double largest = 0;
  for (const Cell& cell : table.cells)
    if (cell.column == column) largest = std::max(largest, trusted_speedup_of(study, table, cell));
  return largest;
}

/// Returns whether the speedups of a column have the same baseline, so that one of them is the best.
bool has_one_baseline(const Table& table, const std::string& column) {
  std::string baseline;
  for (const Cell& cell : table.cells) {
    if (cell.column != column) continue;
    if (!baseline.empty() && cell.baseline != baseline) return false;
    baseline = cell.baseline;
  }
  return true;
}

std::string html_cell(const Study& study, const Table& table, const Cell& cell, double largest, Footnotes& notes) {
  const CellText text = text_of(study, table, cell);
  const double speedup = speedup_of(study, table, cell);
  const bool is_best = speedup > 0 && speedup == largest && text.doubt.empty() &&
                       table.measure != Measure::load_balance && has_one_baseline(table, cell.column);
  std::string html = fmt::format("<td{}><b>{}",
                                 !text.is_measured     ? " class=\"none\""
                                 : is_best             ? " class=\"best\""
                                 : !text.doubt.empty() ? " class=\"doubt\""
                                                       : "",
                                 escaped(text.value));
  if (const size_t note = notes.number_of(text.note)) html += fmt::format("<sup>{}</sup>", note);
  html += "</b>";
  if (!text.speedup.empty())
    html += fmt::format(" <span class=\"speedup\" style=\"--filled:{:.0f}%\">{}</span>",
                        largest > 0 ? std::min(100.0, 100 * speedup / largest) : 0, escaped(text.speedup));
  if (!text.spread.empty()) html += fmt::format("<small>{}</small>", escaped(text.spread));
  return html + "</td>";
}

bool has_report(const Table& table) {
  return std::any_of(table.cells.begin(), table.cells.end(), [](const Cell& cell) { return !cell.report.empty(); });
}

std::string report_cell(const Study& study, const Table& table, const std::string& row) {
  std::string html;
  for (const std::string& column : table.columns) {
    const Cell* cell = table.find(row, column);
    const std::string text = cell ? text_of(study, table, *cell).report : "";
    if (text.empty()) continue;
    html += fmt::format("<small>{}{}</small>", table.columns.size() > 1 ? escaped(column) + ": " : "", escaped(text));
  }
  return "<td>" + html + "</td>";
}

std::string html_table(const Study& study, const Table& table) {
  std::string html = fmt::format("<div class=\"scroll\"><table><thead><tr><th>{}</th>", escaped(table.row_title));
  for (const std::string& column : table.columns) html += fmt::format("<th>{}</th>", escaped(column));
  if (has_report(table)) html += "<th>the report</th>";
  html += "</tr></thead><tbody>\n";
  Footnotes notes;
  for (const std::string& row : table.rows()) {
    html += fmt::format("<tr><td class=\"row\">{}</td>", escaped(row));
    for (const std::string& column : table.columns) {
      const Cell* cell = table.find(row, column);
      html += cell ? html_cell(study, table, *cell, max_speedup(study, table, column), notes) : "<td>-</td>";
    }
    html += (has_report(table) ? report_cell(study, table, row) : "") + "</tr>\n";
  }
  html += "</tbody></table></div>\n";
  if (notes.notes().empty()) return html;
  html += "<ol class=\"notes\">";
  for (const std::string& note : notes.notes()) html += fmt::format("<li>{}</li>", escaped(note));
  return html + "</ol>\n";
}

std::string card(const std::string& number, const std::string& text) {
  return fmt::format("<div class=\"card\"><b>{}</b><span>{}</span></div>\n", escaped(number), escaped(text));
}

/// The most important numbers.
std::string cards(const Study& study, const Headline& headline) {
  std::string html;
  if (headline.speedup > 0)
    html += card(times_text(headline.speedup),
                 "as fast as one core a path at a time: " + headline.engine + ", the fastest here");
  const auto speedup = [&](const char* id, const char* row, const char* column) {
    const Table* table = study.table(id);
    const Cell* cell = table ? table->find(row, column) : nullptr;
    return cell ? trusted_speedup_of(study, *table, *cell) : 0;
  };
  if (const double tree = speedup("queries", "wide BVH, SIMD", "float"); tree > 0)
    html += card(times_text(tree), "as fast by the wide BVH as by the linear scan, on this scene");
  if (const double million = speedup("objects", "1000000", "wide BVH, SIMD"); million > 0)
    html += card(times_text(million), "the same with a million spheres");
  if (study.work_per_thread.is_there())
    html += card(times_text(study.work_per_thread.naive.largest_mean() / study.work_per_thread.chunked.largest_mean()),
                 "lower: the maximum over threads of their mean bounces, by 4 x 4 chunks");
  return html.empty() ? html : "<div class=\"cards\">\n" + html + "</div>\n";
}

std::string section(const std::string& id, const std::string& title, const std::string& body) {
  return fmt::format("<section id=\"{}\"><h2>{}</h2>\n{}</section>\n", id, escaped(title), body);
}

std::string figures(const Study& study, const std::string& folder) {
  // SVG in the page itself is sharp, and its text can be read aloud and searched.
  std::string html = section("figure1", "Figure 1: the problem",
                             fmt::format("<figure class=\"drawing\">{}<figcaption>{}</figcaption></figure>\n",
                                         figure1_svg(), escaped(figure1_text())));
  const std::string picture =
      embedded_image(fs::path(folder) / "figure2.png", "image/png",
                     fmt::format("{}, S = {} samples per pixel, paths of at most D = {} segments", study.scene.name,
                                 study.scale.image_samples, study.scene.segments));
  if (!picture.empty()) html += section("figure2", "Figure 2: the image", picture);
  if (study.work_per_thread.is_there())
    html +=
        section("figure3", "Figure 3: mean number of bounces of every thread",
                "<p>" + escaped(figure3_text(study)) +
                    "</p><p>Bounces are counted as in the report: as segments of a path, so that a path that escapes "
                    "at once has 1. No GPU is needed to compute this: the schedule determines which pixels a thread "
                    "has.</p>\n" +
                    plots_of("figure3", folder));
  return html;
}

}  // namespace

std::string html_of(const Study& study, const std::string& folder) {
  const Headline headline = headline_of(study);
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<title>Alhazen: {}</title>\n<link rel=\"icon\" "
      "href=\"data:,\">\n"
      "<style>{}</style></head>\n<body><main>\n<p class=\"above\">alhazen study: what accelerates ray tracing here, "
      "and "
      "why</p>\n<h1>{}</h1>\n<p>{}</p>\n<p>{}</p>\n<ul class=\"facts\">",
      escaped(headline.text), page_style, escaped(headline.text), escaped(reproduced_text(study)), symbols_text);
  for (const std::string& line : facts_of(study)) html += fmt::format("<li>{}</li>", escaped(line));
  html += "</ul>\n";
  for (const std::string& warning : warnings_of(study))
    html += "<p class=\"warning\">Careful: " + escaped(warning) + ".</p>\n";
  html += cards(study, headline);
  html += plots_of("headline", folder).empty() ? "" : section("headline", "At a glance", plots_of("headline", folder));
  std::string conclusions;
  for (const Conclusion& c : conclusions_of(study))
    conclusions += fmt::format("<dt>{}</dt><dd{}>{}</dd>\n", escaped(c.title.substr(0, c.title.size() - 1)),
                               c.is_withheld ? " class=\"withheld\"" : "", escaped(c.text));
  if (!conclusions.empty()) html += section("conclusions", "What to conclude", "<dl>" + conclusions + "</dl>\n");
  html += figures(study, folder);
  for (const Table& table : study.tables)
    html += section(table.id, table.title,
                    fmt::format("<p>{} {}</p>\n{}{}", escaped(table.text), escaped(image_sizes_of(study, table)),
                                html_table(study, table), plots_of(table.id, folder)));
  html += section(
      "method", "How it was measured",
      "<p>Times are those of the render phase alone, without reading and building trees. Every cell was warmed up with "
      "a "
      "few samples, then all cells were run in rounds, in a different order each, so that other activity on the "
      "machine "
      "affected all alike. A run in which a thread lost more than a tenth of its time to other programs was replaced, "
      "and "
      "so was the slowest where repeats differed by more than a tenth, at most as often as each cell is run. What is "
      "still in doubt is marked, and conclusions that need it are withheld. The figures are medians, with minimum and "
      "maximum. A speedup is a ratio of "
      "median times per camera sample, or per ray if the table says so. Nothing is extrapolated: only what a cell "
      "states "
      "was run.</p><p>All numbers of "
      "this page are in <code>study.json</code> beside it; <code>alhazen study compare</code> compares two of "
      "them.</p>");
  return html + "</main></body></html>\n";
}

}  // namespace alhazen::impl::study
