#include "io/mitsuba/document.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <utility>

#include "io/mitsuba/attributes.h"
#include "io/mitsuba/transforms.h"
#include "util/parse_numbers.h"
#include "util/quoted.h"

namespace alhazen::impl::mitsuba {

namespace {

constexpr size_t max_include_depth = 16;
/// Bounds the stack of the readers, which call themselves for objects within objects.
constexpr uint32_t max_height = 128;

const std::set<std::string_view> object_tags{"integrator", "sensor",  "film",  "rfilter", "sampler", "emitter",
                                             "bsdf",       "texture", "shape", "medium",  "phase",   "volume"};

/// toWorld becomes to_world, and intIOR int_ior.
std::string in_snake_case(const std::string& name) {
  std::string result;
  bool after_lower = false;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isupper(byte) && after_lower) result += '_';
    after_lower = std::islower(byte) || std::isdigit(byte);
    result += static_cast<char>(std::tolower(byte));
  }
  return result;
}

/// Turns elements into objects, in the order of the files.
class Loader {
 public:
  Loader(Document& document, Definitions& definitions, XmlBudget& budget)
      : document_(document), definitions_(definitions), budget_(budget) {}

  void load(const std::shared_ptr<const SourceText>& source, const std::string& folder) {
    Element root = parse_xml(source, budget_);
    if (root.tag != "scene")
      fail(root.place, "the root element is <" + root.tag + ">, not <scene>: this is not a Mitsuba scene");
    document_.objects.push_back({"scene", "scene", {}, root.place, {}});
    document_.folders.push_back(folder);
    load_scene(root, 0, folder);
  }

  void resolve_references() {
    for (Object& object : document_.objects)
      for (Property& property : object.properties) {
        if (property.reference.empty()) continue;
        const auto found = ids_.find(property.reference);
        if (found == ids_.end()) fail(property.place, "no object has the id " + quoted(property.reference));
        property.object = found->second;
      }
    limit_heights();
  }

 private:
  /// Throws if an object contains itself, or if objects are nested too deep. References nest like elements, but without
  /// a limit, so that this keeps a stack of its own.
  void limit_heights() const {
    constexpr uint32_t unseen = 0, open = max_height + 1;  // others are heights: 1 for objects without objects
    std::vector<uint32_t> heights(document_.objects.size(), unseen);
    std::vector<std::pair<uint32_t, size_t>> stack{{0, 0}};
    heights[0] = open;
    while (!stack.empty()) {
      const uint32_t index = stack.back().first;
      const std::vector<Property>& properties = document_.objects[index].properties;
      if (stack.back().second == properties.size()) {
        heights[index] = height_over(properties, heights);
        stack.pop_back();
        continue;
      }
      const Property& property = properties[stack.back().second++];
      if (property.kind != ValueKind::object) continue;
      if (heights[property.object] == open)
        fail(property.place, "the object contains itself, through its reference to " + quoted(property.reference));
      if (heights[property.object] != unseen) continue;
      heights[property.object] = open;
      stack.emplace_back(property.object, 0);
    }
  }

  /// The height of an object from those of the objects in it.
  static uint32_t height_over(const std::vector<Property>& properties, const std::vector<uint32_t>& heights) {
    uint32_t height = 1;
    for (const Property& property : properties) {
      if (property.kind != ValueKind::object) continue;
      height = std::max(height, heights[property.object] + 1);
      if (height > max_height)
        fail(property.place, "objects are nested over 128 deep, with those that references name; nest fewer");
    }
    return height;
  }

  void load_scene(Element& root, uint32_t object, const std::string& folder) {
    replace_parameters(root);
    check_attributes(root, {"!version", "type", "id", "name"});
    const std::string& version = *root.find("version");
    const std::vector<std::string_view> words = words_of(version);
    double number = 0;
    const size_t dot = words.empty() ? 0 : words[0].find('.');
    if (words.size() != 1 || !parse_number(words[0].substr(0, dot), number) || !(number >= 0))
      fail(root.place, "the version " + quoted(version) + " is not one, such as 3.0.0");
    if (number > 3)
      fail(root.place, "scenes of version " + quoted(version) + " are unknown; 3 and below are supported");
    const bool was_version_1 = std::exchange(is_version_1_, number < 2);
    load_children(root, object, folder);
    is_version_1_ = was_version_1;
  }

  void replace_parameters(Element& element) const {
    for (auto& [name, value] : element.attributes) value = definitions_.replace(value, element.place);
  }

  void replace_all_parameters(Element& element) const {
    replace_parameters(element);
    for (Element& child : element.children) replace_all_parameters(child);
  }

  void load_children(Element& parent, uint32_t object, const std::string& folder) {
    for (Element& child : parent.children) load_child(child, object, folder);
  }

  void load_child(Element& element, uint32_t parent, const std::string& folder) {
    if (element.tag == "transform")
      replace_all_parameters(element);
    else
      replace_parameters(element);
    const bool may_nest = object_tags.contains(element.tag) || element.tag == "transform" ||
                          (element.tag == "spectrum" && element.find("type") != nullptr);
    if (!may_nest && !element.children.empty())
      fail(element.children[0].place, "<" + element.tag + "> contains no other elements");
    if (element.tag == "default")
      load_default(element);
    else if (element.tag == "include")
      include(element, parent, folder);
    else if (element.tag == "path")
      load_path(element, parent, folder);
    else if (element.tag == "alias")
      load_alias(element);
    else if (object_tags.contains(element.tag) || (element.tag == "spectrum" && element.find("type") != nullptr))
      load_object(element, parent, folder);
    else
      add_property(parent, read_value(element));
  }

  void load_default(const Element& element) {
    check_attributes(element, {"!name", "!value"});
    if (element.find("name")->empty()) fail(element.place, "the name of <default> is empty");
    definitions_.set_default(*element.find("name"), *element.find("value"));
  }

  void load_path(const Element& element, uint32_t parent, const std::string& folder) {
    check_attributes(element, {"!value"});
    if (parent != 0) fail(element.place, "<path> can only be a child of <scene>");
    const std::filesystem::path path = std::filesystem::path(folder) / *element.find("value");
    document_.folders.insert(document_.folders.begin(), path.string());
  }

  void load_alias(const Element& element) {
    check_attributes(element, {"!id", "!as"});
    const auto found = ids_.find(*element.find("id"));
    if (found == ids_.end()) fail(element.place, "no object before this has the id " + quoted(*element.find("id")));
    add_id(*element.find("as"), found->second, element.place);
  }

  void add_id(const std::string& id, uint32_t object, const Place& place) {
    if (id.empty()) fail(place, "an id is empty");
    if (!ids_.emplace(id, object).second) fail(place, "the id " + quoted(id) + " is used twice; rename one");
  }

  void include(const Element& element, uint32_t parent, const std::string& folder) {
    check_attributes(element, {"!filename", "name"});
    if (parent != 0) fail(element.place, "<include> can only be a child of <scene>");
    if (depth_ + 1 >= max_include_depth) fail(element.place, "files include each other over 16 deep");
    document_.folders.insert(document_.folders.begin(), folder);
    const InputPath path = document_.existing_file(element.place, *element.find("filename"));
    document_.folders.erase(document_.folders.begin());
    Element root = parse_xml(read_text(path, budget_), budget_);
    if (root.tag != "scene") fail(root.place, "the root element of an included file must be <scene>");
    const std::string inner = std::filesystem::path(path.name).parent_path().string();
    if (std::find(document_.folders.begin(), document_.folders.end(), inner) == document_.folders.end())
      document_.folders.push_back(inner);
    ++depth_;
    load_scene(root, parent, inner);
    --depth_;
  }

  void load_object(Element& element, uint32_t parent, const std::string& folder) {
    check_attributes(element, {"!type", "id", "name"});
    const auto index = static_cast<uint32_t>(document_.objects.size());
    const std::string* id = element.find("id");
    document_.objects.push_back(
        {element.tag, *element.find("type"), id ? *id : std::string(), element.place, {}, is_version_1_});
    if (id) add_id(*id, index, element.place);
    Property property = named(element);
    property.kind = ValueKind::object;
    property.object = index;
    add_property(parent, std::move(property));
    load_children(element, index, folder);
  }

  Property named(const Element& element) const {
    Property property;
    property.place = element.place;
    if (const std::string* name = element.find("name")) property.name = is_version_1_ ? in_snake_case(*name) : *name;
    return property;
  }

  void add_property(uint32_t parent, Property property) {
    std::vector<Property>& properties = document_.objects[parent].properties;
    const auto has_its_name = [&](const Property& other) { return other.name == property.name; };
    if (!property.name.empty() && parent != 0 && std::any_of(properties.begin(), properties.end(), has_its_name))
      fail(property.place, quoted(property.name) + " is given twice");
    properties.push_back(std::move(property));
  }

  Property read_value(const Element& element) const {
    Property property = named(element);
    const std::string& tag = element.tag;
    const auto value = [&]() -> const std::string& { return *element.find("value"); };
    if (tag == "ref") {
      check_attributes(element, {"!id", "name"});
      property.kind = ValueKind::object;
      property.reference = *element.find("id");
      if (property.reference.empty()) fail(element.place, "the id of <ref> is empty");
      return property;
    }
    if (tag == "transform") {
      check_attributes(element, {"!name"});
      property.kind = ValueKind::transform;
      property.transform = read_transform(element);
      return property;
    }
    if (tag == "point" || tag == "vector") {
      read_vector(element, property);
      return property;
    }
    if (tag == "spectrum") {
      check_attributes(element, {"!name", "value", "filename"});
      const bool has_file = element.find("filename") != nullptr;
      if (has_file == (element.find("value") != nullptr))
        fail(element.place, "<spectrum> takes either 'value' or 'filename'");
      property.kind = has_file ? ValueKind::spectrum_file : ValueKind::spectrum;
      property.text = *element.find(has_file ? "filename" : "value");
      return property;
    }
    if (tag != "float" && tag != "integer" && tag != "boolean" && tag != "string" && tag != "rgb" && tag != "srgb")
      fail(element.place, "unknown element <" + tag + ">");
    check_attributes(element, {"!name", "!value"});
    const std::string what = quoted(property.name);
    if (tag == "string") {
      property.kind = ValueKind::text;
      property.text = value();
    } else if (tag == "float") {
      property.number = parse_finite(value(), element.place, what);
    } else if (tag == "integer") {
      property.kind = ValueKind::integer;
      property.number = parse_finite(value(), element.place, what);
      if (property.number != std::trunc(property.number) || std::abs(property.number) > 9e15)
        fail(element.place, what + " must be a whole number, not " + quoted(value()));
    } else if (tag == "boolean") {
      property.kind = ValueKind::boolean;
      std::string lower = value();
      std::transform(lower.begin(), lower.end(), lower.begin(),
                     [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      if (lower != "true" && lower != "false") fail(element.place, what + " must be true or false");
      property.boolean = lower == "true";
    } else {
      property.kind = ValueKind::rgb;
      property.vector = read_rgb(element, value(), what);
    }
    return property;
  }

  static Vec3d read_rgb(const Element& element, const std::string& value, const std::string& what) {
    if (element.tag == "rgb" || value.empty() || value[0] != '#') {
      const Vec3d rgb = parse_three(value, element.place, what);
      return element.tag == "rgb" ? rgb : decoded(rgb, element.place, what);
    }
    unsigned bits = 0;
    const char* const end = value.data() + value.size();
    if (value.size() != 7 || std::from_chars(value.data() + 1, end, bits, 16).ptr != end)
      fail(element.place, what + " must be a colour as #rrggbb, not " + quoted(value));
    const auto channel = [&](unsigned shift) { return static_cast<double>(bits >> shift & 0xff) / 255; };
    return decoded({channel(16), channel(8), channel(0)}, element.place, what);
  }

  static Vec3d decoded(const Vec3d& encoded, const Place& place, const std::string& what) {
    Vec3d linear{};
    for (int i = 0; i < 3; ++i) {
      if (!(encoded[i] >= 0 && encoded[i] <= 1)) fail(place, what + ": <srgb> takes values from 0 to 1");
      linear[i] = encoded[i] <= 0.04045 ? encoded[i] / 12.92 : std::pow((encoded[i] + 0.055) / 1.055, 2.4);
    }
    return linear;
  }

  static void read_vector(const Element& element, Property& property) {
    property.kind = ValueKind::vector;
    const std::string what = quoted(property.name);
    if (element.find("value") != nullptr) {
      check_attributes(element, {"!name", "!value"});
      property.vector = parse_three(*element.find("value"), element.place, what);
      return;
    }
    check_attributes(element, {"!name", "!x", "!y", "!z"});
    property.vector = {parse_finite(*element.find("x"), element.place, what),
                       parse_finite(*element.find("y"), element.place, what),
                       parse_finite(*element.find("z"), element.place, what)};
  }

  Document& document_;
  Definitions& definitions_;
  XmlBudget& budget_;
  std::map<std::string, uint32_t> ids_;
  size_t depth_ = 0;
  bool is_version_1_ = false;
};

Document load(const std::shared_ptr<const SourceText>& source, const std::string& folder, const InputScope& scope,
              const std::vector<std::string>& given, const FileSearch& search, XmlBudget& budget) {
  Document document;
  document.scope = scope;
  document.search = search;
  Definitions definitions(given);
  Loader loader(document, definitions, budget);
  loader.load(source, folder);
  loader.resolve_references();
  definitions.require_use(source->name);
  return document;
}

}  // namespace

InputPath Document::existing_file(const Place& place, const std::string& name) const {
  if (name.empty()) fail(place, "the name of a file is empty");
  std::string looked_for, problem;
  for (const std::string& folder : folders) {
    InputPath path((std::filesystem::path(folder) / name).string(), scope);
    const InputProblem found = input_problem(path);
    if (found.message.empty()) return path;
    if (!found.is_missing && problem.empty()) problem = found.message;
    if (looked_for.find(path.name) == std::string::npos) looked_for += (looked_for.empty() ? "" : ", ") + path.name;
  }
  if (!problem.empty()) fail(place, "the file \"" + name + "\" " + problem);
  FoundFile elsewhere = find_file(folders.front(), name, scope, search);
  if (elsewhere.problem.message.empty()) return elsewhere.path;
  fail(place, "there is no file \"" + name + "\" (looked for " + looked_for +
                  "); paths are relative to the folder of the scene file and to those of <path>" + search_hint(search));
}

Document read_document(const InputPath& path, const std::vector<std::string>& definitions, const FileSearch& search) {
  XmlBudget budget;
  return load(read_text(path, budget), std::filesystem::path(path.name).parent_path().string(), path.scope, definitions,
              search, budget);
}

Document parse_document(const std::string& text, const std::string& name, const std::string& folder,
                        const std::vector<std::string>& definitions, const FileSearch& search) {
  XmlBudget budget;
  return load(std::make_shared<const SourceText>(SourceText{name, text}), folder, {}, definitions, search, budget);
}

}  // namespace alhazen::impl::mitsuba
