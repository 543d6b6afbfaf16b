#include "io/pbrt/parser.h"

#include <algorithm>
#include <cctype>
#include <unordered_map>
#include <utility>

#include "colour/rgb_space.h"
#include "io/pbrt/lights.h"
#include "io/pbrt/materials.h"
#include "io/pbrt/options.h"
#include "io/pbrt/parameter_parser.h"
#include "io/pbrt/shapes.h"
#include "io/pbrt/suggestions.h"
#include "io/pbrt/textures.h"
#include "io/pbrt/transforms.h"

namespace alhazen::impl::pbrt {

namespace {

constexpr size_t max_block_depth = 4096;
constexpr size_t max_file_depth = 64;
/// Limit per target of Attribute, since every block and every shape copies them. No directive has as many parameters.
constexpr size_t max_defaults = 256;
/// Limit on the total number of files: files that include others twice multiply long before they nest deeply.
constexpr size_t max_files = 100'000;

}  // namespace

const std::vector<Parser::Directive>& Parser::directives() {
  using enum Section;
  static const std::vector<Directive> list{
      {"Accelerator", options, &Parser::with_parameters<ignore_accelerator>},
      {"ActiveTransform", anywhere, &Parser::with_lexer<set_active_transform>},
      {"AreaLightSource", world, &Parser::with_parameters<set_area_light>},
      {"Attribute", anywhere, &Parser::attribute},
      {"AttributeBegin", world, &Parser::attribute_begin},
      {"AttributeEnd", world, &Parser::attribute_end},
      {"Camera", options, &Parser::with_parameters<set_camera>},
      {"ColorSpace", anywhere, &Parser::colour_space},
      {"ConcatTransform", anywhere, &Parser::with_lexer<concat_transform>},
      {"CoordSysTransform", anywhere, &Parser::with_lexer<use_coordinate_system>},
      {"CoordinateSystem", anywhere, &Parser::with_lexer<name_coordinate_system>},
      {"Film", options, &Parser::with_parameters<set_film>},
      {"Identity", anywhere, &Parser::with_lexer<set_identity>},
      {"Import", world, &Parser::import},
      {"Include", anywhere, &Parser::include},
      {"Integrator", options, &Parser::with_parameters<set_integrator>},
      {"LightSource", world, &Parser::with_parameters<add_light>},
      {"LookAt", anywhere, &Parser::with_lexer<look_at>},
      {"MakeNamedMaterial", world, &Parser::make_named_material},
      {"MakeNamedMedium", anywhere, &Parser::make_named_medium},
      {"Material", world, &Parser::with_parameters<set_material>},
      {"MediumInterface", anywhere, &Parser::medium_interface},
      {"NamedMaterial", world, &Parser::named_material},
      {"ObjectBegin", world, &Parser::object_begin},
      {"ObjectEnd", world, &Parser::object_end},
      {"ObjectInstance", world, &Parser::object_instance},
      {"Option", anywhere, &Parser::with_lexer<set_option>},
      {"PixelFilter", options, &Parser::with_parameters<set_filter>},
      {"ReverseOrientation", world, &Parser::reverse_orientation},
      {"Rotate", anywhere, &Parser::with_lexer<rotate>},
      {"Sampler", options, &Parser::with_parameters<set_sampler>},
      {"Scale", anywhere, &Parser::with_lexer<scale>},
      {"Shape", world, &Parser::with_parameters<add_shape>},
      {"Texture", world, &Parser::texture},
      {"Transform", anywhere, &Parser::with_lexer<set_transform>},
      {"TransformBegin", world, &Parser::transform_begin},
      {"TransformEnd", world, &Parser::transform_end},
      {"TransformTimes", options, &Parser::with_lexer<set_transform_times>},
      {"Translate", anywhere, &Parser::with_lexer<translate>},
      {"WorldBegin", options, &Parser::world_begin},
      {"WorldEnd", world, &Parser::world_end},
  };
  return list;
}

void Parser::parse_top(std::shared_ptr<const SourceFile> source) {
  open_files_.push_back(source->file ? InputFile(*source->file).identity() : FileNumber());
  parse_file(source);
  if (!build_.in_world)
    fail({source, 1, 1}, "the scene has no WorldBegin; put it between the camera and the first shape");
}

void Parser::parse_file(std::shared_ptr<const SourceFile> source) {
  Lexer lexer(source);
  Lexer* outer = std::exchange(lexer_, &lexer);
  while (lexer.peek().kind != TokenKind::end) parse_directive();
  // Included files may open and close blocks for each other; all must be closed only at the end.
  if (!outer) require_closed(0);
  open_files_.pop_back();
  lexer_ = outer;
}

void Parser::require_closed(size_t depth) const {
  if (blocks_.size() <= depth) return;
  const OpenBlock& open = blocks_.back();
  const bool is_object = open.kind == Block::object;
  fail(open.place, std::string(is_object ? "ObjectBegin" : "AttributeBegin") + " is not closed; put " +
                       (is_object ? "ObjectEnd" : "AttributeEnd") + " at its end");
}

void Parser::parse_directive() {
  static const std::unordered_map<std::string_view, const Directive*> by_name = [] {
    std::unordered_map<std::string_view, const Directive*> table;
    for (const Directive& directive : directives()) table[directive.name] = &directive;
    return table;
  }();
  const Token token = lexer_->next();
  const Place place = lexer_->place(token);
  if (token.kind != TokenKind::word) fail(place, "expected a directive, got " + described(token));
  const auto found = by_name.find(token.text);
  if (found == by_name.end()) {
    std::vector<std::string_view> names;
    for (const Directive& directive : directives()) names.emplace_back(directive.name);
    fail(place, "unknown directive " + described(token) + upgrade_or_suggestion(token.text, names));
  }
  const Directive& directive = *found->second;
  directive_ = directive.name;
  if (directive.section == Section::options && build_.in_world) fail(place, directive_ + " must be before WorldBegin");
  if (directive.section == Section::world && !build_.in_world) fail(place, directive_ + " must be after WorldBegin");
  (this->*directive.handle)(place);
}

ParameterList Parser::read_parameters(const std::string& kind, const Place& place) {
  ParameterList list(directive_ + " \"" + kind + "\"", place);
  parse_parameters(*lexer_, build_.state.rgb_space, list);
  return list;
}

void Parser::open_block(Block kind, const Place& place) {
  if (blocks_.size() == max_block_depth) fail(place, "blocks are nested over 4096 deep; is an AttributeEnd missing?");
  blocks_.push_back({kind, build_.state, place});
}

void Parser::close_block(Block kind, const Place& place) {
  if (blocks_.empty())
    fail(place, directive_ + " without " + (kind == Block::object ? "ObjectBegin" : "AttributeBegin") + " before it");
  if (blocks_.back().kind != kind)
    fail(place, directive_ + (kind == Block::object ? " closes the AttributeBegin" : " closes the ObjectBegin") +
                    " of line " + std::to_string(blocks_.back().place.line) + "; end that first");
  build_.state = std::move(blocks_.back().saved);
  blocks_.pop_back();
}

void Parser::attribute_begin(const Place& place) { open_block(Block::attribute, place); }
void Parser::attribute_end(const Place& place) { close_block(Block::attribute, place); }

void Parser::transform_begin(const Place& place) {
  build_.warn(place, "TransformBegin and TransformEnd are deprecated; they work as AttributeBegin and AttributeEnd");
  open_block(Block::attribute, place);
}
void Parser::transform_end(const Place& place) { close_block(Block::attribute, place); }

void Parser::world_begin(const Place&) {
  build_.in_world = true;
  GraphicsState& state = build_.state;
  state.ctm_start = state.ctm_end = Transform();
  state.start_active = state.end_active = true;
  build_.coordinate_systems["world"] = state.ctm();
}

void Parser::world_end(const Place& place) { build_.warn(place, "WorldEnd is not part of pbrt-v4; it is ignored"); }

void Parser::object_begin(const Place& place) {
  const std::string name = expect_string(*lexer_, "the name of the object");
  if (build_.open_object != 0) fail(place, "ObjectBegin inside an object; end the other one first");
  NamedEntry& entry = build_.named_object(name, place);
  if (entry.defined) fail(place, "object \"" + name + "\" is defined twice; rename one");
  entry.defined = true;
  open_block(Block::object, place);
  build_.open_object = entry.index;
}

void Parser::object_end(const Place& place) {
  close_block(Block::object, place);
  build_.open_object = 0;
}

void Parser::object_instance(const Place& place) {
  const std::string name = expect_string(*lexer_, "the name of an object");
  if (build_.open_object != 0) fail(place, "ObjectInstance inside an object; objects cannot hold instances");
  Instance instance;
  instance.group = build_.named_object(name, place).index;
  instance.world_from_group = build_.state.ctm();
  instance.where = place.location();
  build_.scene.instances.push_back(std::move(instance));
}

void Parser::reverse_orientation(const Place&) { build_.state.reverse_orientation = !build_.state.reverse_orientation; }

void Parser::attribute(const Place& place) {
  const std::string target = expect_string(*lexer_, "what the attributes are for");
  const ParameterList list = read_parameters(target, place);
  AttributeDefaults& defaults = build_.state.defaults;
  const std::unordered_map<std::string_view, InheritedParameters*> targets{{"shape", &defaults.shape},
                                                                           {"light", &defaults.light},
                                                                           {"material", &defaults.material},
                                                                           {"medium", &defaults.medium},
                                                                           {"texture", &defaults.texture}};
  const auto found = targets.find(target);
  if (found == targets.end())
    fail(place, "unknown target \"" + target + "\" of Attribute; use shape, light, material, medium or texture");
  for (const Parameter& parameter : list.own()) {
    // A later default of that name replaces the earlier one permanently.
    std::erase_if(*found->second, [&](const auto& earlier) { return earlier->name == parameter.name; });
    if (found->second->size() == max_defaults) fail(place, "over 256 defaults are set for \"" + target + "\"");
    found->second->push_back(std::make_shared<const Parameter>(parameter));
  }
}

void Parser::colour_space(const Place& place) {
  std::string name = expect_string(*lexer_, "the name of a colour space");
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (!is_rgb_space(name))
    fail(place, "unknown colour space \"" + name + "\"; use srgb, rec2020, dci-p3 or aces2065-1");
  build_.state.rgb_space = name;
}

void Parser::include(const Place& place) {
  const std::string name = expect_string(*lexer_, "the name of a file");
  const InputPath path = build_.existing_file(place, name);
  if (open_files_.size() == max_file_depth) fail(place, "files are included over 64 deep");
  if (++file_count_ > max_files) fail(place, "over 100000 files are included");
  const FileNumber identity = InputFile(path).identity();
  if (std::find(open_files_.begin(), open_files_.end(), identity) != open_files_.end())
    fail(place, "\"" + name + "\" includes itself, directly or through others");
  open_files_.push_back(identity);
  parse_file(std::make_shared<const SourceFile>(SourceFile{path.name, path, {}}));
}

/// Like Include, but the attributes that the file sets do not affect the importing file.
void Parser::import(const Place& place) {
  open_block(Block::attribute, place);
  const size_t depth = blocks_.size();
  include(place);
  if (blocks_.size() < depth) fail(place, "the imported file closes a block that it did not open");
  require_closed(depth);
  close_block(Block::attribute, place);
}

void Parser::named_material(const Place& place) {
  use_named_material(build_, expect_string(*lexer_, "the name of a material"), place);
}

void Parser::make_named_material(const Place& place) {
  const std::string name = expect_string(*lexer_, "the name of the material");
  ParameterList list = read_parameters(name, place);
  define_named_material(build_, name, list);
}

void Parser::texture(const Place& place) {
  const std::string name = expect_string(*lexer_, "the name of the texture");
  const std::string type = expect_string(*lexer_, "the type of the texture");
  const std::string kind = expect_string(*lexer_, "the kind of the texture");
  ParameterList list = read_parameters(kind, place);
  list.inherit(build_.state.defaults.texture);
  add_texture(build_, name, type, kind, list);
}

void Parser::make_named_medium(const Place& place) {
  const std::string name = expect_string(*lexer_, "the name of the medium");
  ParameterList list = read_parameters(name, place);
  define_named_medium(build_, name, list);
}

void Parser::medium_interface(const Place& place) {
  const std::string inside = expect_string(*lexer_, "the name of a medium");
  std::string outside = inside;
  if (lexer_->peek().kind == TokenKind::string) outside = expect_string(*lexer_, "the name of a medium");
  set_medium_interface(build_, inside, outside, place);
}

}  // namespace alhazen::impl::pbrt
