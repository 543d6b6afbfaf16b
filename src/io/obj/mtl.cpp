#include "io/obj/mtl.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "io/obj/lines.h"
#include "util/quoted.h"

namespace alhazen::impl::obj {

namespace {

/// Statements about ambient light, which tracing rays finds, and what is not supported.
const std::set<std::string_view> ignored{"ka", "map_ka", "map_aat"};
const std::set<std::string_view> unsupported{"disp",   "decal",     "refl",     "map_ns",  "map_ps",
                                             "map_tr", "sharpness", "map_refl", "map_rma", "map_orm",
                                             "map_pc", "map_pcr",   "map_tf"};

const std::map<std::string_view, std::optional<double> MtlMaterial::*> numbers{
    {"ns", &MtlMaterial::exponent},      {"ni", &MtlMaterial::ior},
    {"d", &MtlMaterial::opacity},        {"pr", &MtlMaterial::roughness},
    {"pm", &MtlMaterial::metallic},      {"ps", &MtlMaterial::sheen},
    {"pc", &MtlMaterial::clearcoat},     {"pcr", &MtlMaterial::clearcoat_roughness},
    {"aniso", &MtlMaterial::anisotropy}, {"anisor", &MtlMaterial::anisotropy_rotation}};

const std::map<std::string_view, std::optional<Vec3d> MtlMaterial::*> colours{
    {"kd", &MtlMaterial::diffuse},
    {"ks", &MtlMaterial::specular},
    {"ke", &MtlMaterial::emission},
    {"tf", &MtlMaterial::transmission_filter}};

const std::map<std::string_view, Map MtlMaterial::*> maps{
    {"map_kd", &MtlMaterial::diffuse_map},   {"map_ks", &MtlMaterial::specular_map},
    {"map_ke", &MtlMaterial::emission_map},  {"map_d", &MtlMaterial::opacity_map},
    {"map_pr", &MtlMaterial::roughness_map}, {"map_pm", &MtlMaterial::metallic_map},
    {"bump", &MtlMaterial::bump_map},        {"map_bump", &MtlMaterial::bump_map},
    {"norm", &MtlMaterial::normal_map},      {"map_norm", &MtlMaterial::normal_map},
    {"map_kn", &MtlMaterial::normal_map}};

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

class MtlReader {
 public:
  MtlReader(Lines& lines, Diagnostics& diagnostics) : lines_(lines), diagnostics_(diagnostics) {}

  std::vector<MtlMaterial> run() {
    while (lines_.next()) {
      const std::string keyword = in_lower_case(lines_.words()[0].text);
      if (keyword == "newmtl") {
        begin_material();
        continue;
      }
      if (materials_.empty()) lines_.fail(0, "a statement before the first 'newmtl' belongs to no material");
      read_statement(keyword);
    }
    end_material();
    return std::move(materials_);
  }

 private:
  /// `d` counts before `Tr`, whatever their order.
  void end_material() {
    if (!materials_.empty() && !materials_.back().opacity && transparency_)
      materials_.back().opacity = 1 - *transparency_;
    transparency_.reset();
  }

  void begin_material() {
    end_material();
    MtlMaterial material;
    material.name = lines_.rest(1);
    material.where = lines_.place();
    if (material.name.empty()) lines_.fail(1, "the name of the material is missing after 'newmtl'");
    materials_.push_back(std::move(material));
  }

  void read_statement(const std::string& keyword) {
    MtlMaterial& material = materials_.back();
    if (const auto number = numbers.find(keyword); number != numbers.end())
      material.*number->second = read_number(keyword);
    else if (keyword == "tr")
      transparency_ = read_number(keyword);
    else if (const auto colour = colours.find(keyword); colour != colours.end())
      material.*colour->second = read_colour(keyword == "ke");
    else if (const auto map = maps.find(keyword); map != maps.end())
      material.*map->second = read_map();
    else if (keyword == "illum")
      material.illumination = static_cast<int>(std::clamp(lines_.number(1), 0.0, 10.0));
    else if (unsupported.contains(keyword))
      diagnostics_.warn(lines_.place(), "the statement " + quoted(lines_.words()[0].text) +
                                            " of materials is not supported; it is ignored");
    else if (!ignored.contains(keyword))
      diagnostics_.warn(lines_.place(),
                        "the statement " + quoted(lines_.words()[0].text) + " of materials is unknown; it is ignored");
  }

  double read_number(const std::string& keyword) const {
    // `d -halo 0.5` depends on the direction, which is not supported.
    const size_t at = keyword == "d" && lines_.words().size() > 2 && lines_.words()[1].text == "-halo" ? 2 : 1;
    const double value = lines_.number(at);
    if ((keyword == "d" || keyword == "tr") && !(value >= 0 && value <= 1))
      lines_.fail(at, quoted(lines_.words()[0].text) + " must be from 0 to 1");
    if (value < 0 && keyword != "anisor") lines_.fail(at, quoted(keyword) + " must not be negative");
    return value;
  }

  Vec3d read_colour(bool is_unbounded) const {
    if (lines_.words().size() > 1 && (lines_.words()[1].text == "spectral" || lines_.words()[1].text == "xyz"))
      lines_.fail(1, "colours as " + quoted(lines_.words()[1].text) + " are not supported; give red, green and blue");
    Vec3d colour = splat(lines_.number(1));
    if (lines_.words().size() > 2) colour = {lines_.number(1), lines_.number(2), lines_.number(3)};
    if (colour.x < 0 || colour.y < 0 || colour.z < 0) lines_.fail(1, "a colour cannot be negative");
    return is_unbounded ? colour : min(colour, Vec3d{1, 1, 1});
  }

  bool is_number(size_t word) const {
    return word < lines_.words().size() &&
           std::string_view("0123456789+-.").find(lines_.words()[word].text[0]) != std::string_view::npos;
  }

  /// The name of the file is what follows the options, with its blanks.
  Map read_map() const {
    Map map;
    map.where = lines_.place();
    size_t at = 1;
    const auto option = [&] { return at < lines_.words().size() ? lines_.words()[at].text : std::string_view(); };
    while (option().size() > 1 && option()[0] == '-') {
      const std::string_view name = option();
      ++at;
      if (name == "-s" || name == "-o" || name == "-t") {
        Vec2d& pair = name == "-s" ? map.scale : map.offset;
        size_t given = 0;
        for (; given < 3 && is_number(at); ++given, ++at)
          if (name != "-t" && given < 2) (given == 0 ? pair.x : pair.y) = lines_.number(at);
      } else if (name == "-mm") {
        map.base = lines_.number(at), map.gain = lines_.number(at + 1);
        at += 2;
      } else if (name == "-bm") {
        map.bump_multiplier = lines_.number(at++);
      } else if (name == "-clamp") {
        map.is_clamped = option() == "on";
        ++at;
      } else if (name == "-blendu" || name == "-blendv" || name == "-cc" || name == "-imfchan" || name == "-texres" ||
                 name == "-boost" || name == "-type") {
        ++at;
      } else {
        lines_.fail(at - 1, "unknown option " + quoted(name) + " of an image");
      }
    }
    map.file = lines_.rest(at);
    if (map.file.empty()) lines_.fail(at, "the name of the image is missing");
    std::replace(map.file.begin(), map.file.end(), '\\', '/');
    return map;
  }

  Lines& lines_;
  Diagnostics& diagnostics_;
  std::vector<MtlMaterial> materials_;
  std::optional<double> transparency_;  ///< Tr of the last material
};

}  // namespace

std::vector<MtlMaterial> parse_mtl(ByteSource& source, const std::string& name, Diagnostics& diagnostics) {
  Lines lines(source, name);
  return MtlReader(lines, diagnostics).run();
}

std::vector<MtlMaterial> read_mtl(const InputPath& path, Diagnostics& diagnostics) {
  FileSource source(path);
  return parse_mtl(source, path.name, diagnostics);
}

}  // namespace alhazen::impl::obj
