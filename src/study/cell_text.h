#pragma once

// The text of table cells, common to all output formats.

#include <string>
#include <vector>

#include "study/study.h"

namespace alhazen::impl::study {

struct CellText {
  bool is_measured = false;
  std::string value;    ///< "0.512 s", or "N/A", or "not run"
  std::string spread;   ///< "0.501 to 0.533"
  std::string speedup;  ///< "1.97x"; empty: none
  std::string report;   ///< "cuda2 3127 s (3.09x), cuda3 4409 s (2.30x)"
  std::string note;     ///< why there is no value, or a remark
  std::string doubt;    ///< why the value or the speedup is in doubt; also in the note
};

CellText text_of(const Study& study, const Table& table, const Cell& cell);

/// Three significant digits: 0.0123, 0.512, 12.3, 4533.
std::string short_number(double value);
std::string seconds_text(double seconds);
/// 3.09x, 29.4x, 5262x
std::string times_text(double factor);

/// The notes of a table's cells, each once and in order; cells refer to them by number.
class Footnotes {
 public:
  /// The number of a note, from 1; 0 for an empty one.
  size_t number_of(const std::string& note);
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::vector<std::string> notes_;
};

}  // namespace alhazen::impl::study
