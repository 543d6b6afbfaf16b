#pragma once

// The scenes of the parity tests, read once.

#include "images/image.h"
#include "support/bits.h"
#include "support/environments.h"
#include "support/light_scenes.h"
#include "support/scene_files.h"
#include "support/temporary_folder.h"

namespace alhazen::impl::test {

/// Wider than a tile, and not a multiple of one in either direction.
inline constexpr int parity_width = 20, parity_height = 17;

inline Scene read_spheres() {
  const TemporaryFolder folder;
  const Image image{3, 2, {"R", "G", "B"}, {{1, 0, 0, 1, 0, 1}, {0, 1, 0, 1, 1, 0}, {0, 0, 1, 0, 1, 1}}};
  write_png(folder.file("photo.png"), source_of(image), {});
  return scene_of(many_spheres(parity_width, parity_height, folder.file("photo.png")));
}

/// Under two maps and a constant light, in an image of the same size.
inline Scene read_environments() {
  Scene scene = scene_of(R"(LookAt 0 -5 2  0 0 0.4  0 0 1
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 20 "integer yresolution" 17
WorldBegin
LightSource "infinite" "rgb L" [ 0.1 0.2 0.3 ]
Shape "trianglemesh" "point3 P" [ -9 -9 0  9 -9 0  9 9 0  -9 9 0 ] "integer indices" [ 0 1 2 0 2 3 ]
Material "conductor" "rgb reflectance" [ 0.9 0.8 0.7 ] "float roughness" 0.1
AttributeBegin Translate -0.7 0 0.6 Shape "sphere" "float radius" 0.6 AttributeEnd
Material "dielectric" "float eta" 1.5
AttributeBegin Translate 0.7 0 0.6 Shape "sphere" "float radius" 0.6 AttributeEnd
)");
  scene = test::lit_by(std::move(scene), test::sun_map(32, 16, 200));
  return test::lit_by(std::move(scene), test::lamps_map(16, 16), test::map_askew());
}

/// Lights of every kind, including textured ones and ones with images, chosen by a light tree.
inline Scene read_lights() {
  Scene scene = test::with_emission_texture(scene_of(R"(Film "rgb" "integer xresolution" 20 "integer yresolution" 17
)" + test::room_of_lights(40, true, 0.4) + R"(LightSource "infinite" "rgb L" [ 0.1 0.2 0.3 ]
LightSource "distant" "point3 from" [ 1 2 3 ] LightSource "distant" "point3 from" [ 3 2 1 ] "float angle" 8)"));
  for (const LightKind kind : {LightKind::goniometric, LightKind::projection}) {
    Light light;
    light.kind = kind;
    light.radiance = splat(0.5);
    light.position = {0.5, 1, -2};
    light.axes = test::map_askew();
    light.image = static_cast<uint32_t>(scene.light_images.size());
    scene.light_images.push_back(test::sun_map(8, 8, 3));
    scene.lights.push_back(light);
  }
  return scene;
}

/// Every kind of material, with alpha, one-sided surfaces, mixes, bumps and absorption.
inline Scene read_materials() {
  Scene scene = scene_of(R"(LookAt 0 -5 2  0 0 0.4  0 0 1
Camera "perspective" "float fov" 45
Film "rgb" "integer xresolution" 20 "integer yresolution" 17
WorldBegin
LightSource "infinite" "rgb L" [ 0.1 0.2 0.3 ]
AttributeBegin Translate 0 0 4 AreaLightSource "diffuse" "rgb L" [ 4 4 4 ] Shape "sphere" "float radius" 0.7 AttributeEnd
Texture "waves" "float" "wrinkled"
Texture "cells" "spectrum" "cellular" "string value" "cell"
Material "coateddiffuse" "texture reflectance" "cells" "float roughness" 0.05 "texture displacement" "waves"
Shape "trianglemesh" "point3 P" [ -9 -9 0  9 -9 0  9 9 0  -9 9 0 ] "integer indices" [ 0 1 2 0 2 3 ]
MakeNamedMaterial "metal" "string type" "conductor" "float uroughness" 0.1 "float vroughness" 0.4
MakeNamedMaterial "coat" "string type" "coatedconductor" "float conductor.roughness" 0.1
MakeNamedMaterial "leaf" "string type" "diffusetransmission"
MakeNamedMaterial "mixed" "string type" "mix" "string materials" [ "metal" "leaf" ]
AttributeBegin NamedMaterial "mixed" Translate -1.5 0 0.5 Shape "sphere" "float radius" 0.5 AttributeEnd
AttributeBegin NamedMaterial "coat" Translate -0.5 0 0.5 Shape "sphere" "float radius" 0.5 AttributeEnd
MakeNamedMedium "tea" "string type" "homogeneous" "rgb sigma_a" [ 0.5 1 2 ] "rgb sigma_s" [ 0 0 0 ]
AttributeBegin MediumInterface "tea" "" Material "dielectric" "float uroughness" 0.1 "float vroughness" 0.3
Translate 0.5 0 0.5 Shape "sphere" "float radius" 0.5 AttributeEnd
AttributeBegin Material "diffuse" Translate 1.5 0 0.5 Shape "sphere" "float radius" 0.5 AttributeEnd
AttributeBegin Material "thindielectric" Translate 0 -1 0.5 Shape "sphere" "float radius" 0.3 AttributeEnd
AttributeBegin Translate 0 0 1.5 Shape "trianglemesh" "point3 P" [ -2 -2 0  2 -2 0  2 2 0  -2 2 0 ]
"integer indices" [ 0 1 2 0 2 3 ] "float alpha" 0.6 AttributeEnd
)");
  for (Material& material : scene.materials) {
    if (material.kind != MaterialKind::diffuse || material.alpha != no_index) continue;
    material.kind = MaterialKind::principled;
    Principled& p = material.principled;
    const auto constant = [&](double value) {
      Texture texture;
      texture.value = splat(value);
      scene.textures.push_back(texture);
      return static_cast<uint32_t>(scene.textures.size() - 1);
    };
    p.transmission = constant(0.6), p.roughness = constant(0.4), p.clearcoat = constant(0.5);
    p.sheen_colour = constant(0.3), p.anisotropy = constant(0.5), p.iridescence = constant(0.5);
    p.thin = false, p.attenuation_colour = {0.5, 0.8, 0.9}, p.attenuation_distance = 0.5, p.dispersion = 0.5;
    material.double_sided = true;
  }
  return scene;
}

/// Eight balls of 20,480 triangles each, too many to be copied, one of them squashed and mirrored, one of glass inside
/// out, and a lamp.
inline Scene read_instances() {
  std::string text = R"(LookAt 0 -6 3  0 0 0.4  0 0 1
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 20 "integer yresolution" 17
WorldBegin
LightSource "infinite" "rgb L" [ 0.1 0.2 0.3 ]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 6 5 4 ]
  Shape "trianglemesh" "point3 P" [ -1 -1 3  1 -1 3  1 1 3  -1 1 3 ] "integer indices" [ 0 2 1 0 3 2 ]
AttributeEnd
Shape "trianglemesh" "point3 P" [ -9 -9 -0.6  9 -9 -0.6  9 9 -0.6  -9 9 -0.6 ] "integer indices" [ 0 1 2 0 2 3 ]
Material "conductor" "rgb reflectance" [ 0.9 0.8 0.7 ] "float roughness" 0.1
ObjectBegin "ball"
  Shape "loopsubdiv" "integer levels" 5
    "point3 P" [ -0.5 0.8 0  0.5 0.8 0  -0.5 -0.8 0  0.5 -0.8 0  0 -0.5 0.8  0 0.5 0.8  0 -0.5 -0.8  0 0.5 -0.8
                 0.8 0 -0.5  0.8 0 0.5  -0.8 0 -0.5  -0.8 0 0.5 ]
    "integer indices" [ 0 11 5 0 5 1 0 1 7 0 7 10 0 10 11 1 5 9 5 11 4 11 10 2 10 7 6 7 1 8
                        3 9 4 3 4 2 3 2 6 3 6 8 3 8 9 4 9 5 2 4 11 6 2 10 8 6 7 9 8 1 ]
ObjectEnd
)";
  for (int i = 0; i < 8; ++i)
    text += "AttributeBegin Rotate " + std::to_string(45 * i) + " 0 0 1 Translate 1.6 0 0 Rotate " +
            std::to_string(70 * i) + " 1 2 3 Scale " + (i == 0 ? "0.4 -0.9 0.7 " : "0.6 0.6 0.6 ") +
            (i == 1 ? "ReverseOrientation " : "") + "ObjectInstance \"ball\" AttributeEnd\n";
  return scene_of(text);
}

/// Triangles of every sort, most of them diffuse: with and without shading normals, flipped, bumped, textured, and
/// emissive on one side, on both, or by a mesh's normals; seen through a lens.
inline Scene read_meshes() {
  const std::string indices = R"( "integer indices" [ 0 1 2 0 2 3 ] )";
  const std::string tent = R"(Shape "trianglemesh" "point3 P" [ -1 -1 0  1 -1 0  1 1 0.6  -1 1 0.6 ]
    "normal N" [ -0.3 -0.5 1  0.3 -0.5 1  0.3 0.1 1  -0.3 0.1 1 ] "point2 uv" [ 0 0  1 0  1 1  0 1 ])" +
                           indices;
  return scene_of(R"(LookAt 0 -5 2  0 0 0.4  0 0 1
Camera "perspective" "float fov" 45 "float lensradius" 0.05 "float focaldistance" 5
Film "rgb" "integer xresolution" 20 "integer yresolution" 17
WorldBegin
LightSource "infinite" "rgb L" [ 0.1 0.2 0.3 ]
LightSource "point" "point3 from" [ 0 -2 3 ] "rgb I" [ 2 2 2 ]
AttributeBegin AreaLightSource "diffuse" "rgb L" [ 4 5 6 ] "bool twosided" true Translate 0 0 3 Scale 0.4 0.4 0.4 )" +
                  tent + R"(AttributeEnd
AttributeBegin AreaLightSource "diffuse" "rgb L" [ 9 5 4 ] ReverseOrientation
Shape "trianglemesh" "point3 P" [ -3 0 1  -3 1 1  -3 1 2  -3 0 2 ])" +
                  indices + R"(AttributeEnd
Texture "checks" "spectrum" "checkerboard" "rgb tex1" [ 0.8 0.2 0.2 ] "rgb tex2" [ 0.2 0.8 0.2 ]
  "float uscale" 8 "float vscale" 8
Texture "waves" "float" "wrinkled"
Material "diffuse" "texture reflectance" "checks"
Shape "trianglemesh" "point3 P" [ -9 -9 0  9 -9 0  9 9 0  -9 9 0 ])" +
                  indices + R"(
AttributeBegin Translate -1.4 0 0.3 )" +
                  tent + R"(AttributeEnd
AttributeBegin ReverseOrientation Material "diffuse" "texture displacement" "waves" Translate 1.4 0 0.3 )" +
                  tent + R"(AttributeEnd
AttributeBegin Material "conductor" "float roughness" 0.2 Translate 0 1.2 0.3 )" +
                  tent + "AttributeEnd\n");
}

/// Cylinders, whole and in part: textured, mirrored, sheared, of glass, of rough metal, bumped, with holes, inside out,
/// in instances, and one that is a lamp, which is a mesh.
inline Scene read_cylinders() {
  return scene_of(R"(LookAt 0 -6 3  0 0 0.6  0 0 1
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 20 "integer yresolution" 17
WorldBegin
LightSource "infinite" "rgb L" [ 0.1 0.2 0.3 ]
LightSource "point" "point3 from" [ 2 -3 5 ] "rgb I" [ 20 20 20 ]
AttributeBegin AreaLightSource "diffuse" "rgb L" [ 8 7 5 ] Translate 0 0 3 Rotate 90 0 1 0
Shape "cylinder" "float radius" 0.2 AttributeEnd
Texture "checks" "spectrum" "checkerboard" "rgb tex1" [ 0.8 0.2 0.2 ] "rgb tex2" [ 0.2 0.8 0.2 ]
  "float uscale" 8 "float vscale" 4
Texture "holes" "float" "checkerboard" "float tex1" 0.3 "float tex2" 1 "float uscale" 6 "float vscale" 6
Texture "waves" "float" "wrinkled"
Shape "trianglemesh" "point3 P" [ -9 -9 0  9 -9 0  9 9 0  -9 9 0 ] "integer indices" [ 0 1 2 0 2 3 ]
AttributeBegin Material "diffuse" "texture reflectance" "checks" Translate -1.8 0 0
Shape "cylinder" "float radius" 0.6 "float zmin" 0 "float zmax" 1.2 AttributeEnd
AttributeBegin Material "dielectric" "float eta" 1.5 
ConcatTransform [ 1 0 0 0  0 1 0 0  0.4 0.2 1 0  -0.4 -0.8 0.7 1 ]
Shape "cylinder" "float radius" 0.5 "float zmin" -0.6 "float zmax" 0.6 AttributeEnd
AttributeBegin Material "conductor" "float uroughness" 0.1 "float vroughness" 0.4 "texture displacement" "waves"
Translate 0.8 0.6 0.8 Rotate 30 1 1 0 Scale -0.7 1.1 0.8
Shape "cylinder" "float phimax" 230 "float zmin" -0.8 "float zmax" 1 AttributeEnd
AttributeBegin Material "diffuse" "rgb reflectance" [ 0.7 0.6 0.2 ] Translate 1.6 -0.9 0.5 Rotate 80 0 1 0.3
Shape "cylinder" "float radius" 0.4 "texture alpha" "holes" AttributeEnd
ObjectBegin "ring"
  Material "conductor" "rgb reflectance" [ 0.9 0.8 0.7 ] "float roughness" 0
  Shape "cylinder" "float radius" 0.5 "float zmin" 0 "float zmax" 0.2
ObjectEnd
AttributeBegin Translate -0.5 1.2 1.4 Rotate 60 1 0 0 ObjectInstance "ring" AttributeEnd
AttributeBegin ReverseOrientation Translate 0.5 -1.8 0 Scale -1 1 2 ObjectInstance "ring" AttributeEnd
)");
}

/// Disks, whole and in part: a can of glass, textured ones with a hole, mirrored, sheared, of rough metal, bumped, with
/// holes, inside out, in instances, and one that is a lamp, which is a mesh.
inline Scene read_disks() {
  return scene_of(R"(LookAt 0 -6 3  0 0 0.6  0 0 1
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 20 "integer yresolution" 17
WorldBegin
LightSource "infinite" "rgb L" [ 0.1 0.2 0.3 ]
LightSource "point" "point3 from" [ 2 -3 5 ] "rgb I" [ 20 20 20 ]
AttributeBegin AreaLightSource "diffuse" "rgb L" [ 8 7 5 ] ReverseOrientation
Shape "disk" "float radius" 0.5 "float height" 3 AttributeEnd
Texture "checks" "spectrum" "checkerboard" "rgb tex1" [ 0.8 0.2 0.2 ] "rgb tex2" [ 0.2 0.8 0.2 ]
  "float uscale" 8 "float vscale" 4
Texture "holes" "float" "checkerboard" "float tex1" 0.3 "float tex2" 1 "float uscale" 6 "float vscale" 6
Texture "waves" "float" "wrinkled"
Shape "disk" "float radius" 9
AttributeBegin Material "diffuse" "texture reflectance" "checks" Translate -1.8 0 0.6 Rotate 70 1 0.3 0
Shape "disk" "float radius" 0.8 "float innerradius" 0.3 AttributeEnd
AttributeBegin Material "dielectric" "float eta" 1.5
ConcatTransform [ 1 0 0 0  0 1 0 0  0.4 0.2 1 0  -0.4 -0.8 0.7 1 ]
Shape "cylinder" "float radius" 0.5 "float zmin" -0.6 "float zmax" 0.6
Shape "disk" "float radius" 0.5 "float height" 0.6
ReverseOrientation Shape "disk" "float radius" 0.5 "float height" -0.6 AttributeEnd
AttributeBegin Material "conductor" "float uroughness" 0.1 "float vroughness" 0.4 "texture displacement" "waves"
Translate 0.8 0.6 0.8 Rotate 50 1 1 0 Scale -0.7 1.1 0.8
Shape "disk" "float phimax" 230 "float height" 0.3 AttributeEnd
AttributeBegin Material "diffuse" "rgb reflectance" [ 0.7 0.6 0.2 ] Translate 1.6 -0.9 0.7 Rotate 80 0 1 0.3
Shape "disk" "float radius" 0.6 "texture alpha" "holes" AttributeEnd
ObjectBegin "mirror"
  Material "conductor" "rgb reflectance" [ 0.9 0.8 0.7 ] "float roughness" 0
  Shape "disk" "float radius" 0.5
ObjectEnd
AttributeBegin Translate -0.5 1.2 1.4 Rotate 60 1 0 0 ObjectInstance "mirror" AttributeEnd
AttributeBegin ReverseOrientation Translate 0.5 -1.8 0.3 Scale -1 1 2 ObjectInstance "mirror" AttributeEnd
)");
}

inline const Scene& parity_scene(const std::string& name) {
  if (name == "cornell") {
    static const Scene cornell = scene_of(cornell_box(parity_height));
    return cornell;
  }
  if (name == "environments") {
    static const Scene environments = read_environments();
    return environments;
  }
  if (name == "lights") {
    static const Scene lights = read_lights();
    return lights;
  }
  if (name == "materials") {
    static const Scene materials = read_materials();
    return materials;
  }
  if (name == "instances") {
    static const Scene instances = read_instances();
    return instances;
  }
  if (name == "cylinders") {
    static const Scene cylinders = read_cylinders();
    return cylinders;
  }
  if (name == "disks") {
    static const Scene disks = read_disks();
    return disks;
  }
  if (name == "meshes") {
    static const Scene meshes = read_meshes();
    return meshes;
  }
  static const Scene spheres = read_spheres();
  return spheres;
}

}  // namespace alhazen::impl::test
