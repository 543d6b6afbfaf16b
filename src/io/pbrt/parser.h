#pragma once

// Processes the directives of a scene file and of the files that it includes.

#include <memory>
#include <string>
#include <vector>

#include "io/pbrt/build.h"
#include "io/pbrt/lexer.h"

namespace alhazen::impl::pbrt {

class Parser {
 public:
  explicit Parser(Build& build) : build_(build) {}

  /// Parses the top file and all that it includes.
  void parse_top(std::shared_ptr<const SourceFile> source);

 private:
  enum class Block { attribute, object };
  struct OpenBlock {
    Block kind;
    GraphicsState saved;
    Place place;
  };
  /// Where a directive is allowed.
  enum class Section { anywhere, options, world };
  using Handler = void (Parser::*)(const Place&);
  struct Directive {
    const char* name;
    Section section;
    Handler handle;
  };
  static const std::vector<Directive>& directives();

  void parse_file(std::shared_ptr<const SourceFile> source);
  void parse_directive();
  void require_closed(size_t depth) const;

  void attribute_begin(const Place& place);
  void attribute_end(const Place& place);
  void transform_begin(const Place& place);
  void transform_end(const Place& place);
  void world_begin(const Place& place);
  void world_end(const Place& place);
  void object_begin(const Place& place);
  void object_end(const Place& place);
  void object_instance(const Place& place);
  void reverse_orientation(const Place& place);
  void attribute(const Place& place);
  void colour_space(const Place& place);
  void include(const Place& place);
  void import(const Place& place);
  void named_material(const Place& place);
  void make_named_material(const Place& place);
  void texture(const Place& place);
  void make_named_medium(const Place& place);
  void medium_interface(const Place& place);

  template <void (*function)(Build&, Lexer&, const Place&)>
  void with_lexer(const Place& place) {
    function(build_, *lexer_, place);
  }
  /// Directives of the form `Name "kind" parameters`.
  template <void (*function)(Build&, const std::string&, ParameterList&)>
  void with_parameters(const Place& place) {
    const std::string kind = expect_string(*lexer_, "a name after " + directive_);
    ParameterList list = read_parameters(kind, place);
    function(build_, kind, list);
  }
  ParameterList read_parameters(const std::string& kind, const Place& place);
  void open_block(Block kind, const Place& place);
  void close_block(Block kind, const Place& place);

  Build& build_;
  Lexer* lexer_ = nullptr;  ///< of the innermost file
  std::string directive_;   ///< name of the current one
  std::vector<OpenBlock> blocks_;
  /// The files that are currently including each other; a text in memory has none.
  std::vector<FileNumber> open_files_;
  size_t file_count_ = 0;
};

}  // namespace alhazen::impl::pbrt
