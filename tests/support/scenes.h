#pragma once

// Scene texts that several tests render. They have no film: prepend film_of(width, height).

#include <string>

namespace alhazen::impl::test {

/// A small Cornell box: coloured walls, a large lamp, a diffuse and a metal block.
inline const std::string cornell_box = R"(
    LookAt 0 1 -3.4  0 1 0  0 1 0
    Camera "perspective" "float fov" 36
    WorldBegin
    MakeNamedMaterial "white" "string type" "diffuse" "rgb reflectance" [0.73 0.73 0.73]
    MakeNamedMaterial "red" "string type" "diffuse" "rgb reflectance" [0.65 0.06 0.05]
    MakeNamedMaterial "green" "string type" "diffuse" "rgb reflectance" [0.12 0.45 0.15]
    MakeNamedMaterial "metal" "string type" "conductor" "rgb reflectance" [0.9 0.8 0.6] "float roughness" 0.1
    NamedMaterial "white"
    Shape "trianglemesh" "point3 P" [-1 0 -1  1 0 -1  1 0 1  -1 0 1] "integer indices" [0 1 2 0 2 3]
    Shape "trianglemesh" "point3 P" [-1 2 -1  1 2 -1  1 2 1  -1 2 1] "integer indices" [0 2 1 0 3 2]
    Shape "trianglemesh" "point3 P" [-1 0 1  1 0 1  1 2 1  -1 2 1] "integer indices" [0 1 2 0 2 3]
    Shape "trianglemesh"
      "point3 P" [-0.7 0 0.2  -0.2 0 0.5  -0.2 1 0.5  -0.7 1 0.2  -0.4 0 -0.3  -0.4 1 -0.3]
      "integer indices" [0 1 2 0 2 3  0 3 5 0 5 4  4 5 2 4 2 1  3 2 5]
    NamedMaterial "red"
    Shape "trianglemesh" "point3 P" [-1 0 -1  -1 0 1  -1 2 1  -1 2 -1] "integer indices" [0 1 2 0 2 3]
    NamedMaterial "green"
    Shape "trianglemesh" "point3 P" [1 0 -1  1 0 1  1 2 1  1 2 -1] "integer indices" [0 2 1 0 3 2]
    NamedMaterial "metal"
    AttributeBegin
      Translate 0.45 0.35 -0.2
      Shape "sphere" "float radius" 0.35
    AttributeEnd
    NamedMaterial "white"
    AreaLightSource "diffuse" "rgb L" [6 5 4]
    Shape "trianglemesh" "point3 P" [-0.6 1.98 -0.6  0.6 1.98 -0.6  0.6 1.98 0.6  -0.6 1.98 0.6]
      "integer indices" [0 1 2 0 2 3]
)";

/// A diffuse emissive sphere around a mirror, a smooth and a rough glass ball. Its emission is brighter above, so that
/// the image depends on every bounce.
inline const std::string furnace_of_glass = R"(
    LookAt 0 0.2 -1.8  0 0 0  0 1 0
    Camera "perspective" "float fov" 50
    WorldBegin
    Material "diffuse" "rgb reflectance" [0.5 0.6 0.7]
    AttributeBegin
      AreaLightSource "diffuse" "rgb L" [1 1 1]
      ReverseOrientation
      Shape "sphere" "float radius" 2
    AttributeEnd
    AttributeBegin
      AreaLightSource "diffuse" "rgb L" [3 2 1]
      Shape "trianglemesh" "point3 P" [-1 1.2 -1  1 1.2 -1  1 1.2 1  -1 1.2 1] "integer indices" [0 1 2 0 2 3]
    AttributeEnd
    AttributeBegin
      Translate -0.8 0 0.2
      Material "conductor" "rgb reflectance" [0.9 0.9 0.9]
      Shape "sphere" "float radius" 0.4
    AttributeEnd
    AttributeBegin
      Translate 0 -0.1 0
      Material "dielectric" "float eta" 1.5
      Shape "sphere" "float radius" 0.35
    AttributeEnd
    AttributeBegin
      Translate 0.8 0 0.1
      Material "dielectric" "float eta" 1.5 "float roughness" 0.09
      Shape "sphere" "float radius" 0.4
    AttributeEnd
)";

}  // namespace alhazen::impl::test
