#pragma once

// The files of a study's folder.

#include <functional>
#include <string>
#include <vector>

#include "images/image.h"
#include "study/run_work.h"
#include "study/study.h"

namespace alhazen::impl::study {

/// Writes a file completely or not at all. Throws RenderError.
void write_text(const std::string& path, const std::string& text);
/// Writes one value per pixel, rows from the top down, as PFM.
void write_grey_pfm(const std::string& path, int width, int height, const std::vector<float>& values);

/// Writes study.json alone.
void write_json(const Study& study, const std::string& folder);
struct WriteEvents {
  GoOn go_on;                             ///< returns false if the user has asked to end: no plots are drawn
  std::function<void()> has_saved_study;  ///< called once study.json is written, before the other files are
  std::function<void(const std::string&)> warning;
};

/// Writes study.json, figure1.svg, tables.csv, tables.md, index.html, and plots if possible. Returns the names of the
/// files.
std::vector<std::string> write_study(const Study& study, const std::string& folder, const WriteEvents& events);

std::string csv_of(const Study& study);
std::string markdown_of(const Study& study);
/// The page; `folder` holds the images that it embeds.
std::string html_of(const Study& study, const std::string& folder);

}  // namespace alhazen::impl::study
