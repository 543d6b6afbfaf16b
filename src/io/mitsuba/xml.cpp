#include "io/mitsuba/xml.h"

#include <algorithm>

#include "util/printable.h"

#ifdef ALHAZEN_WITH_EXPAT
#include <expat.h>

#include <exception>
#endif

namespace alhazen::impl::mitsuba {

namespace {

/// Length of the excerpt in bytes; spectra may make lines of kilobytes.
constexpr size_t excerpt_width = 100;

std::string excerpt_at(const Place& place) {
  if (!place.source || place.line <= 0) return {};
  std::string_view left = place.source->text;
  for (int line = 1; line < place.line; ++line) {
    const size_t end = left.find('\n');
    if (end == std::string_view::npos) return {};
    left.remove_prefix(end + 1);
  }
  left = left.substr(0, left.find('\n'));
  const size_t caret = static_cast<size_t>(std::max(place.column - 1, 0));
  if (left.empty() || caret > left.size()) return {};
  const size_t begin = caret > excerpt_width / 2 ? caret - excerpt_width / 2 : 0;
  left = left.substr(begin, excerpt_width);
  size_t columns = 0, all = 0;
  printable_columns(left.substr(0, caret - begin), columns);
  const std::string number = std::to_string(place.line);
  return " " + number + " | " + printable_columns(left, all) + "\n " + std::string(number.size(), ' ') + " | " +
         std::string(columns, ' ') + "^";
}

}  // namespace

void fail(const Place& place, const std::string& message) {
  throw InputError(place.location(), message, excerpt_at(place));
}

std::shared_ptr<const SourceText> read_text(const InputPath& path, XmlBudget& budget) {
  FileSource file(path);
  SourceText source{path.name, {}};
  std::vector<char> chunk(size_t{1} << 18);
  while (const size_t count = file.read(chunk.data(), chunk.size())) {
    if (count > budget.bytes)
      throw InputError({path.name},
                       "the scene has over 1 GiB of XML with what it includes; move its meshes to files of their own");
    budget.bytes -= count;
    source.text.append(chunk.data(), count);
  }
  return std::make_shared<const SourceText>(std::move(source));
}

const std::string* Element::find(std::string_view name) const {
  for (const auto& [key, value] : attributes)
    if (key == name) return &value;
  return nullptr;
}

#ifdef ALHAZEN_WITH_EXPAT

namespace {

constexpr size_t max_depth = 128;

/// Builds the tree from the events of Expat. Exceptions must not pass through its C code, so they wait in `failure`.
class TreeBuilder {
 public:
  TreeBuilder(const std::shared_ptr<const SourceText>& source, XmlBudget& budget)
      : source_(source), budget_(budget), parser_(XML_ParserCreate(nullptr)) {
    if (parser_ == nullptr) throw std::bad_alloc();
    XML_SetUserData(parser_, this);
    XML_SetElementHandler(
        parser_,
        [](void* self, const XML_Char* name, const XML_Char** attributes) {
          guarded(self, [&](TreeBuilder& builder) { builder.open(name, attributes); });
        },
        [](void* self, const XML_Char*) { guarded(self, [](TreeBuilder& builder) { builder.close(); }); });
    XML_SetCharacterDataHandler(parser_, [](void* self, const XML_Char* text, int length) {
      guarded(self, [&](TreeBuilder& builder) { builder.text({text, static_cast<size_t>(length)}); });
    });
    XML_SetStartDoctypeDeclHandler(parser_, [](void* self, const XML_Char*, const XML_Char*, const XML_Char*, int) {
      guarded(self, [](TreeBuilder& builder) {
        fail(builder.here(), "document type declarations (<!DOCTYPE>) are not supported: remove it");
      });
    });
  }
  ~TreeBuilder() { XML_ParserFree(parser_); }
  TreeBuilder(const TreeBuilder&) = delete;
  TreeBuilder& operator=(const TreeBuilder&) = delete;

  Element run() {
    constexpr size_t step = size_t{1} << 26;  // lengths of Expat are int
    const std::string& text = source_->text;
    for (size_t at = 0; at <= text.size(); at += step) {
      const size_t count = std::min(step, text.size() - at);
      const XML_Status status =
          XML_Parse(parser_, text.data() + at, static_cast<int>(count), at + count == text.size() ? 1 : 0);
      if (failure_) std::rethrow_exception(failure_);
      if (status != XML_STATUS_OK) {
        if (XML_GetErrorCode(parser_) == XML_ERROR_NO_MEMORY) throw std::bad_alloc();
        fail(here(), std::string("this is not well-formed XML: ") + XML_ErrorString(XML_GetErrorCode(parser_)));
      }
      if (at + count == text.size()) break;
    }
    return std::move(root_);
  }

 private:
  template <class Action>
  static void guarded(void* self, const Action& action) {
    TreeBuilder& builder = *static_cast<TreeBuilder*>(self);
    if (builder.failure_) return;
    try {
      action(builder);
    } catch (...) {
      builder.failure_ = std::current_exception();
      XML_StopParser(builder.parser_, XML_FALSE);
    }
  }

  Place here() const {
    return {source_, static_cast<int>(XML_GetCurrentLineNumber(parser_)),
            static_cast<int>(XML_GetCurrentColumnNumber(parser_)) + 1};
  }

  void open(const char* name, const char** attributes) {
    if (open_.size() >= max_depth) fail(here(), "elements are nested over 128 deep");
    if (budget_.elements == 0) fail(here(), "the scene has over 10 million elements with those it includes");
    --budget_.elements;
    // The vector of a parent does not grow while one of its children is open, so the pointers stay valid.
    Element& element = open_.empty() ? root_ : open_.back()->children.emplace_back();
    element.tag = name;
    element.place = here();
    for (; *attributes != nullptr; attributes += 2) element.attributes.emplace_back(attributes[0], attributes[1]);
    open_.push_back(&element);
  }

  void close() { open_.pop_back(); }

  void text(std::string_view text) const {
    if (text.find_first_not_of(" \t\r\n") != std::string_view::npos)
      fail(here(), "there is text between elements; values are in attributes: value=\"...\"");
  }

  std::shared_ptr<const SourceText> source_;
  XmlBudget& budget_;
  XML_Parser parser_;
  std::exception_ptr failure_;
  Element root_;
  std::vector<Element*> open_;
};

}  // namespace

bool reads_xml() { return true; }

Element parse_xml(const std::shared_ptr<const SourceText>& source, XmlBudget& budget) {
  return TreeBuilder(source, budget).run();
}

#else

bool reads_xml() { return false; }

Element parse_xml(const std::shared_ptr<const SourceText>& source, XmlBudget&) {
  throw InputError(
      {source->name},
      "this build of alhazen reads no XML: install libexpat1-dev and build it again to read Mitsuba scenes");
}

#endif

}  // namespace alhazen::impl::mitsuba
