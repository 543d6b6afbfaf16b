// The values of materials that viewers may change, and what was changed.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "util/quoted.h"
#include "view/scene_edit.h"

namespace alhazen::impl {

namespace {

constexpr double unit = 1, many = 10;

/// Calls `io` with each field of a material: its name, the member, and the upper end of a slider. Members are
/// NumberInput, ColourInput, double, Colour, bool or int.
template <class Io, class R>
void roughness_fields(Io& io, R& roughness) {
  if (roughness.u == roughness.v) {
    NumberInput both = roughness.u;
    io("roughness", both, unit);
    if (!(both == roughness.u)) roughness.u = roughness.v = both;
    return;
  }
  io("roughness_u", roughness.u, unit);
  io("roughness_v", roughness.v, unit);
}

template <class Io, class Metal>
void metal_fields(Io& io, Metal& metal) {
  if (metal.reflectance) io("reflectance", *metal.reflectance, unit);
  if (metal.eta) io("eta", *metal.eta, many);
  if (metal.k) io("k", *metal.k, many);
  roughness_fields(io, metal.roughness);
}

template <class Io>
void fields_of(Io& io, Diffuse& m) {
  io("reflectance", m.reflectance, unit);
  io("roughness", m.roughness, unit);
}
template <class Io>
void fields_of(Io& io, Conductor& m) {
  metal_fields(io, m);
}
template <class Io>
void fields_of(Io& io, Dielectric& m) {
  io("ior", m.ior, 3);
  roughness_fields(io, m.roughness);
  io("absorption", m.absorption, many);
}
template <class Io>
void fields_of(Io& io, ThinDielectric& m) {
  io("ior", m.ior, 3);
}
template <class Io>
void fields_of(Io& io, CoatedDiffuse& m) {
  io("reflectance", m.reflectance, unit);
  io("ior", m.ior, 3);
  roughness_fields(io, m.roughness);
}
template <class Io>
void fields_of(Io& io, CoatedConductor& m) {
  metal_fields(io, m);
  io("coat_ior", m.coat_ior, 3);
  io("coat_roughness", m.coat_roughness, unit);
}
template <class Io>
void fields_of(Io& io, DiffuseTransmission& m) {
  io("reflectance", m.reflectance, unit);
  io("transmittance", m.transmittance, unit);
}
template <class Io>
void fields_of(Io& io, Mix& m) {
  io("amount", m.amount, unit);
}
template <class Io>
void fields_of(Io& io, ::alhazen::Principled& m) {
  io("base_colour", m.base_colour, unit);
  io("metallic", m.metallic, unit);
  io("roughness", m.roughness, unit);
  io("specular", m.specular, 2);
  io("specular_colour", m.specular_colour, unit);
  io("ior", m.ior, 3);
  io("transmission", m.transmission, unit);
  io("thin", m.thin, unit);
  io("attenuation_colour", m.attenuation_colour, unit);
  if (std::isfinite(m.attenuation_distance)) io("attenuation_distance", m.attenuation_distance, many);
  io("dispersion", m.dispersion, unit);
  io("clearcoat", m.clearcoat, unit);
  io("clearcoat_roughness", m.clearcoat_roughness, unit);
  io("sheen_colour", m.sheen_colour, unit);
  io("sheen_roughness", m.sheen_roughness, unit);
  io("iridescence", m.iridescence, unit);
  io("iridescence_thickness", m.iridescence_thickness, 1000);
  io("iridescence_ior", m.iridescence_ior, 3);
  io("anisotropy", m.anisotropy, unit);
  io("anisotropy_rotation", m.anisotropy_rotation, 360);
  io("diffuse_transmission", m.diffuse_transmission, unit);
  io("diffuse_transmission_colour", m.diffuse_transmission_colour, unit);
}

template <class Io>
void all_fields(Io& io, ::alhazen::Material& material) {
  std::visit([&](auto& kind) { fields_of(io, kind); }, material.bsdf);
  io("alpha", material.alpha, unit);
  if (material.normal_map) io("normal_scale", material.normal_scale, 2);
  io("double_sided", material.double_sided, unit);
}

using Rgb = std::array<double, 3>;
Rgb rgb(const ::alhazen::Colour& c) { return {c.r, c.g, c.b}; }

class FieldLister {
 public:
  void operator()(const char* name, const NumberInput& v, double max) { add(name, v.number(), max, v.is_texture()); }
  void operator()(const char* name, const ColourInput& v, double max) {
    add(name, rgb(v.colour()), max, v.is_texture());
  }
  void operator()(const char* name, double v, double max) { add(name, v, max, false); }
  void operator()(const char* name, const ::alhazen::Colour& v, double max) { add(name, rgb(v), max, false); }
  void operator()(const char* name, bool v, double max) { add(name, v, max, false); }

  std::vector<MaterialField> fields;

 private:
  void add(const char* name, FieldValue value, double max, bool is_textured) {
    std::string label = name;
    std::replace(label.begin(), label.end(), '_', ' ');
    fields.push_back({name, label, value, is_textured, 0, max});
  }
};

class FieldSetter {
 public:
  explicit FieldSetter(const std::map<std::string, FieldValue>& values) : values_(values) {}

  void operator()(const char* name, NumberInput& field, double) { put<double>(name, field, "a number"); }
  void operator()(const char* name, double& field, double) { put<double>(name, field, "a number"); }
  void operator()(const char* name, bool& field, double) { put<bool>(name, field, "true or false"); }
  void operator()(const char* name, ColourInput& field, double) { put_colour(name, field); }
  void operator()(const char* name, ::alhazen::Colour& field, double) { put_colour(name, field); }

  size_t used = 0;

 private:
  template <class Value, class Field>
  void put(const char* name, Field& field, const char* wanted) {
    if (const Value* value = find<Value>(name, wanted)) field = *value;
  }
  template <class Field>
  void put_colour(const char* name, Field& field) {
    if (const Rgb* value = find<Rgb>(name, "three numbers"))
      field = ::alhazen::Colour((*value)[0], (*value)[1], (*value)[2]);
  }
  template <class Value>
  const Value* find(const char* name, const char* wanted) {
    const auto found = values_.find(name);
    if (found == values_.end()) return nullptr;
    ++used;
    const Value* value = std::get_if<Value>(&found->second);
    if (!value) throw ::alhazen::InputError("'" + std::string(name) + "' takes " + wanted);
    return value;
  }

  const std::map<std::string, FieldValue>& values_;
};

std::string text_of(const MaterialField& field) {
  if (field.is_textured) return "a texture";
  if (const bool* flag = std::get_if<bool>(&field.value)) return *flag ? "true" : "false";
  if (const double* number = std::get_if<double>(&field.value)) return fmt::format("{}", *number);
  const Rgb& c = std::get<Rgb>(field.value);
  return fmt::format("({}, {}, {})", c[0], c[1], c[2]);
}

const MaterialField* find_field(const std::vector<MaterialField>& fields, const std::string& name) {
  for (const MaterialField& field : fields)
    if (field.name == name) return &field;
  return nullptr;
}

bool is_changed(const MaterialField& before, const MaterialField& now) {
  return before.is_textured != now.is_textured || before.value != now.value;
}

}  // namespace

std::string material_kind(const ::alhazen::Material& material) {
  constexpr const char* names[] = {"Diffuse",       "Conductor",       "Dielectric",          "ThinDielectric",
                                   "CoatedDiffuse", "CoatedConductor", "DiffuseTransmission", "Mix",
                                   "Principled"};
  static_assert(std::size(names) == std::variant_size_v<Bsdf>);
  return names[material.bsdf.index()];
}

std::vector<MaterialField> material_fields(const ::alhazen::Material& material) {
  ::alhazen::Material copy = material;
  FieldLister lister;
  all_fields(lister, copy);
  return std::move(lister.fields);
}

void set_material_fields(::alhazen::Scene& scene, MaterialId id, const std::map<std::string, FieldValue>& values) {
  ::alhazen::Material material = scene.material(id);
  FieldSetter setter(values);
  all_fields(setter, material);
  if (setter.used != values.size()) {
    const std::vector<MaterialField> fields = material_fields(material);
    for (const auto& [name, value] : values)
      if (!find_field(fields, name))
        throw ::alhazen::InputError("a " + material_kind(material) + " material has no field " + quoted(name) +
                                    " that can be changed");
  }
  scene.set(id, material);
}

void MaterialChanges::remember(const ::alhazen::Scene& scene, MaterialId material) {
  if (!first_.contains(material)) first_.emplace(material, material_fields(scene.material(material)));
}

std::vector<std::string> MaterialChanges::lines(const ::alhazen::Scene& scene) const {
  std::vector<std::string> result;
  for (const auto& [id, before] : first_)
    for (const MaterialField& now : material_fields(scene.material(id)))
      if (const MaterialField* old = find_field(before, now.name); old && is_changed(*old, now))
        result.push_back("material " + quoted(scene.name(id)) + ": " + now.label + " " + text_of(*old) + " -> " +
                         text_of(now));
  return result;
}

std::vector<std::string> MaterialChanges::repeat(const ::alhazen::Scene& before, ::alhazen::Scene& scene) {
  std::vector<std::string> lost;
  std::map<MaterialId, std::vector<MaterialField>> first;
  for (const auto& [id, old_fields] : first_) {
    const std::string name = before.name(id);
    std::map<std::string, FieldValue> values;
    for (const MaterialField& field : material_fields(before.material(id)))
      if (const MaterialField* old = find_field(old_fields, field.name); old && is_changed(*old, field))
        values.emplace(field.name, field.value);
    if (values.empty()) continue;
    const MaterialId now = scene.find_material(name);
    if (!now) {
      lost.push_back("there is no material " + quoted(name) + " any more: its changes are lost");
      continue;
    }
    std::vector<MaterialField> fields = material_fields(scene.material(now));
    try {
      set_material_fields(scene, now, values);
      first.emplace(now, std::move(fields));
    } catch (const ::alhazen::InputError& error) {
      lost.push_back("changes of the material " + quoted(name) + " are lost: " + error.what());
    }
  }
  first_ = std::move(first);
  return lost;
}

}  // namespace alhazen::impl
