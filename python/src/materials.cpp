// The values of materials.

#include "alhazen/materials.h"

#include "alhazen/scene.h"
#include "described.h"
#include "value_bindings.h"

namespace alhazen::python {

namespace {

void check_material(const void* data) {
  Material material = *static_cast<const Material*>(data);
  alhazen::Scene scene;
  if (auto* mix = std::get_if<Mix>(&material.bsdf)) mix->materials = {scene.add(Diffuse{}), scene.add(Diffuse{})};
  scene.add(material);
}

void check_roughness(const void* data) {
  const Material material = Dielectric{.roughness = *static_cast<const Roughness*>(data)};
  check_material(&material);
}

template <class Kind>
auto bind_material(py::module_& m, const char* name, const char* doc, std::vector<Field> fields,
                   size_t positional = 0) {
  for (Field& common :
       std::vector{field("alpha", &Material::alpha, "opacity, 0 to 1"),
                   field("normal_map", &Material::normal_map,
                         "normals in tangent space, encoded as 0.5 + 0.5 * n, z away from the surface"),
                   field("normal_scale", &Material::normal_scale, "factor on x and y of these normals"),
                   field("displacement", &Material::displacement, "scene units along the normal, used as a bump map"),
                   field("double_sided", &Material::double_sided, "False: back faces are invisible to the camera"),
                   field("name", &Material::name, "by which scene.materials finds it")})
    fields.push_back(std::move(common));
  return bind_value<Kind>(m, {name, doc, positional}, std::move(fields), &check_material);
}

constexpr const char* roughness_doc =
    "of the microfacets: 0 is smooth; a number, a texture, or a Roughness with values along u and v";
constexpr const char* ior_doc = "index of refraction";
constexpr const char* thickness_doc = "optical thickness of the coat; None: 0.01 with defaults.pbrt_coats, otherwise 0";
constexpr const char* bounces_doc = "with defaults.pbrt_coats, the most at the base; 0: no limit";

void bind_roughness(py::module_& m) {
  bind_value<Roughness>(
      m,
      {"Roughness",
       "Roughness of a microfacet surface, along u and along v; 0 is smooth. A plain number or texture stands for the\n"
       "same in both directions.",
       2},
      {field("u", &Roughness::u, "along u"), field("v", &Roughness::v, "along v"),
       field("remap", &Roughness::remap, "alpha = sqrt(roughness), as in pbrt; otherwise alpha = roughness")},
      &check_roughness);
}

void bind_opaque(py::module_& m) {
  bind_material<Diffuse>(m, "Diffuse", "A matte surface.",
                         {field("reflectance", &Diffuse::reflectance, "0 to 1"),
                          field("roughness", &Diffuse::roughness, "0: Lambert; up to 1: Oren-Nayar")},
                         1);
  auto conductor = bind_material<Conductor>(
      m, "Conductor",
      "A metal: by its reflectance, or by its index of refraction eta and absorption coefficient k for red, green and\n"
      "blue. Without any it is copper. Conductor.of has those of real metals.",
      {field("reflectance", &Conductor::reflectance, "at normal incidence, 0 to 1; not with eta and k"),
       field("eta", &Conductor::eta, ior_doc), field("k", &Conductor::k, "absorption coefficient"),
       field("roughness", &Conductor::roughness, roughness_doc)});
  py::options options;
  options.disable_function_signatures();
  conductor.def_static(
      "of",
      [](const py::object& metal, const py::kwargs& others) {
        const Metal which = enum_value<Metal>("metal", metal);
        auto made = std::make_shared<Described<Conductor>>(Conductor::of(which));
        made->set_all(py::args(), others);
        return made;
      },
      ("of(metal: str, **others) -> Conductor\n\nWith the measured eta and k of a metal, " + enum_choice<Metal>() +
       ".\nThe others are arguments of Conductor.")
          .c_str());
  bind_material<CoatedDiffuse>(m, "CoatedDiffuse", "A diffuse surface under a dielectric coat, such as plastic.",
                               {field("reflectance", &CoatedDiffuse::reflectance, "of the base, 0 to 1"),
                                field("ior", &CoatedDiffuse::ior, "index of refraction of the coat"),
                                field("roughness", &CoatedDiffuse::roughness, "of the coat, as of Dielectric"),
                                field("thickness", &CoatedDiffuse::thickness, thickness_doc),
                                field("bounces", &CoatedDiffuse::bounces, bounces_doc)});
  bind_material<CoatedConductor>(
      m, "CoatedConductor", "A metal under a dielectric coat.",
      {field("reflectance", &CoatedConductor::reflectance, "of the metal, as of Conductor"),
       field("eta", &CoatedConductor::eta, "of the metal"), field("k", &CoatedConductor::k, "of the metal"),
       field("roughness", &CoatedConductor::roughness, "of the metal, as of Conductor"),
       field("coat_ior", &CoatedConductor::coat_ior, "index of refraction of the coat"),
       field("coat_roughness", &CoatedConductor::coat_roughness, "of the coat"),
       field("thickness", &CoatedConductor::thickness, thickness_doc),
       field("bounces", &CoatedConductor::bounces, bounces_doc)});
}

void bind_transparent(py::module_& m) {
  bind_material<Dielectric>(m, "Dielectric", "Glass and the like: a surface that bounds a volume.",
                            {field("ior", &Dielectric::ior, "index of refraction inside relative to outside"),
                             field("roughness", &Dielectric::roughness, roughness_doc),
                             field("absorption", &Dielectric::absorption, "of the volume, per scene unit")});
  bind_material<ThinDielectric>(m, "ThinDielectric", "A pane of glass: both of its surfaces in one.",
                                {field("ior", &ThinDielectric::ior, ior_doc)});
  bind_material<DiffuseTransmission>(
      m, "DiffuseTransmission", "Paper, leaves: reflects and transmits diffusely.",
      {field("reflectance", &DiffuseTransmission::reflectance, "fraction reflected, 0 to 1"),
       field("transmittance", &DiffuseTransmission::transmittance, "fraction transmitted, 0 to 1")});
}

void bind_mix(py::module_& m) {
  bind_material<Mix>(m, "Mix",
                     "One of two materials at each point, at random with the probability `amount` of the second.",
                     {field("materials", &Mix::materials, "two materials, values or parts of the scene; required"),
                      field("amount", &Mix::amount, "probability of the second, 0 to 1")},
                     2);
}

void bind_principled(py::module_& m) {
  using P = Principled;
  bind_material<P>(
      m, "Principled",
      "Metals, plastics, glass, cloth and car paint in one: glTF's metallic-roughness model with its extensions.",
      {field("base_color", &P::base_colour, "linear sRGB, 0 to 1"),
       field("metallic", &P::metallic, "0 or 1"),
       field("roughness", &P::roughness, "0: smooth, to 1; alpha = roughness^2"),
       field("specular", &P::specular, "factor on the dielectric's reflection"),
       field("specular_color", &P::specular_colour, "factor on it at normal incidence"),
       field("ior", &P::ior, ior_doc),
       field("transmission", &P::transmission, "fraction of the light not reflected by the base that is refracted"),
       field("thin", &P::thin,
             "transmission without refraction: the surface is a thin sheet; otherwise it bounds a volume"),
       field("attenuation_color", &P::attenuation_colour,
             "what is left of white light after attenuation_distance within the volume"),
       field("attenuation_distance", &P::attenuation_distance, "scene units"),
       field("dispersion", &P::dispersion, "20 / Abbe number"),
       field("clearcoat", &P::clearcoat, "strength, 0 to 1"),
       field("clearcoat_roughness", &P::clearcoat_roughness, "0 to 1"),
       field("clearcoat_normal_map", &P::clearcoat_normal_map, "as normal_map"),
       field("clearcoat_normal_scale", &P::clearcoat_normal_scale, "as normal_scale"),
       field("sheen_color", &P::sheen_colour, "of cloth; 0: none"),
       field("sheen_roughness", &P::sheen_roughness, "0 to 1"),
       field("iridescence", &P::iridescence, "strength of the thin film, 0 to 1"),
       field("iridescence_thickness", &P::iridescence_thickness, "nanometres"),
       field("iridescence_ior", &P::iridescence_ior, "index of refraction of the film"),
       field("anisotropy", &P::anisotropy, "0 to 1, along the tangent"),
       field("anisotropy_rotation", &P::anisotropy_rotation, "degrees, counter-clockwise from the tangent"),
       field("anisotropy_direction", &P::anisotropy_direction,
             "cosine and sine of an additional angle, encoded as 0.5 + 0.5 * x in red and green"),
       field("diffuse_transmission", &P::diffuse_transmission,
             "fraction of the light in the diffuse base that leaves on the other side"),
       field("diffuse_transmission_color", &P::diffuse_transmission_colour, "factor on that light")});
}

}  // namespace

py::object FieldType<Roughness>::show(const Roughness& value) {
  if (value.u == value.v && value.remap) return FieldType<NumberInput>::show(value.u);
  return py::cast(Described<Roughness>(value).frozen());
}

py::object FieldType<Roughness>::keep(const std::string& name, py::handle given) {
  if (py::isinstance<Described<Roughness>>(given)) return py::cast(given.cast<const Value&>().frozen());
  return keep_texture(name, given);
}

Roughness FieldType<Roughness>::resolve(const std::string& name, py::handle kept, alhazen::Scene& scene) {
  if (py::isinstance<Described<Roughness>>(kept))
    return *static_cast<const Roughness*>(kept.cast<const Value&>().resolved(scene)->data());
  return resolve_texture(name, kept, scene);
}

py::object FieldType<Roughness>::lift(const std::shared_ptr<PythonScene>& scene, const Roughness& roughness) {
  if (roughness.u == roughness.v && roughness.remap) return FieldType<NumberInput>::lift(scene, roughness.u);
  return py::cast(value_of<Roughness>(scene, roughness)->frozen());
}

void bind_materials(py::module_& m) {
  py::class_<Family<Material>, Value, std::shared_ptr<Family<Material>>>(
      m, "Material",
      "The base of all materials. Colors are linear sRGB, those that are reflectances from 0 to 1; inputs are a "
      "number,\n"
      "three numbers, or a Texture.");
  bind_roughness(m);
  bind_opaque(m);
  bind_transparent(m);
  bind_mix(m);
  bind_principled(m);
}

std::shared_ptr<Value> material_value(const std::shared_ptr<PythonScene>& scene, Material material) {
  return std::visit(
      [&]<class Kind>(const Kind&) -> std::shared_ptr<Value> { return value_of<Kind>(scene, std::move(material)); },
      Bsdf(material.bsdf));
}

}  // namespace alhazen::python
