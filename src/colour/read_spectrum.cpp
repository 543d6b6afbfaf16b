// Reads text files of wavelength and value pairs (`.spd`).

#include <cmath>
#include <cstring>

#include "colour/spectrum.h"
#include "util/numbers.h"
#include "util/quoted.h"

namespace alhazen::impl {

namespace {

struct Number {
  double value = 0;
  SourceLocation where;
};

/// Reads the numbers of a text one by one. A comment extends from `#` to the end of its line.
class NumberReader {
 public:
  NumberReader(std::string_view text, const std::string& name) : text_(text), where_{name, 1, 1} {}

  /// Returns false at the end of the text; where() is then that end.
  bool next(Number& number) {
    skip_blanks_and_comments();
    if (text_.empty()) return false;
    const std::string_view word = text_.substr(0, text_.find_first_of(" \t\r\n#"));
    const std::optional<double> value = parse_real(word);
    if (!value || !std::isfinite(*value)) throw InputError(where_, quoted(word) + " is not a finite number");
    number = {*value, where_};
    advance(word.size());
    return true;
  }

  const SourceLocation& where() const { return where_; }

 private:
  void skip_blanks_and_comments() {
    while (!text_.empty()) {
      if (text_[0] == '#')
        advance(std::min(text_.find('\n'), text_.size()));
      else if (std::strchr(" \t\r\n", text_[0]) && text_[0] != '\0')
        advance(1);
      else
        return;
    }
  }

  void advance(size_t count) {
    for (const char c : text_.substr(0, count)) {
      ++where_.column;
      if (c != '\n') continue;
      ++where_.line;
      where_.column = 1;
    }
    text_.remove_prefix(count);
  }

  std::string_view text_;
  SourceLocation where_;
};

}  // namespace

Spectrum read_spectrum(const InputPath& path) {
  const std::vector<uint8_t> bytes = read_short_text(path);
  NumberReader numbers({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path.name);
  Spectrum spectrum;
  Number wavelength, value;
  while (numbers.next(wavelength)) {
    if (!spectrum.wavelengths.empty() && wavelength.value <= spectrum.wavelengths.back())
      throw InputError(wavelength.where, "wavelengths must ascend; this one is not above the previous one");
    if (!numbers.next(value)) throw InputError(wavelength.where, "a wavelength without a value after it");
    spectrum.wavelengths.push_back(wavelength.value);
    spectrum.values.push_back(value.value);
  }
  if (spectrum.wavelengths.empty())
    throw InputError(numbers.where(), "no spectrum; expected pairs of a wavelength in nanometres and a value");
  return spectrum;
}

}  // namespace alhazen::impl
