#pragma once

// Complete scene files as texts, which together use most features of the renderer.

#include <string>

namespace alhazen::impl::test {

/// A box of triangles with coloured walls, a light of two triangles, and two blocks.
inline std::string cornell_box(int size) {
  const std::string side = std::to_string(size);
  return R"(LookAt 0 1 6.8  0 1 0  0 1 0
Camera "perspective" "float fov" 19.5
Film "rgb" "integer xresolution" )" +
         side + R"( "integer yresolution" )" + side + R"( "string filename" "cornell.exr"
Sampler "sobol" "integer pixelsamples" 8
PixelFilter "box"
Integrator "path" "integer maxdepth" 5
WorldBegin
Material "diffuse" "rgb reflectance" [ 0.725 0.71 0.68 ]
Shape "trianglemesh" "point3 P" [ -1 0 -1  -1 0 1  1 0 1  1 0 -1 ] "integer indices" [ 0 1 2 0 2 3 ]
Shape "trianglemesh" "point3 P" [ 1 2 1  -1 2 1  -1 2 -1  1 2 -1 ] "integer indices" [ 0 1 2 0 2 3 ]
Shape "trianglemesh" "point3 P" [ -1 0 -1  1 0 -1  1 2 -1  -1 2 -1 ] "integer indices" [ 0 1 2 0 2 3 ]
Material "diffuse" "rgb reflectance" [ 0.63 0.065 0.05 ]
Shape "trianglemesh" "point3 P" [ -1 0 1  -1 0 -1  -1 2 -1  -1 2 1 ] "integer indices" [ 0 1 2 0 2 3 ]
Material "diffuse" "rgb reflectance" [ 0.14 0.45 0.091 ]
Shape "trianglemesh" "point3 P" [ 1 0 -1  1 0 1  1 2 1  1 2 -1 ] "integer indices" [ 0 1 2 0 2 3 ]
Material "diffuse" "rgb reflectance" [ 0.725 0.71 0.68 ]
AttributeBegin
  Translate 0.33 0.3 0.35
  Rotate -17 0 1 0
  Scale 0.3 0.3 0.3
  Shape "trianglemesh" "point3 P" [ -1 -1 -1  1 -1 -1  1 1 -1  -1 1 -1  -1 -1 1  1 -1 1  1 1 1  -1 1 1 ]
    "integer indices" [ 0 2 1 0 3 2  4 5 6 4 6 7  0 1 5 0 5 4  3 6 2 3 7 6  1 2 6 1 6 5  0 4 7 0 7 3 ]
AttributeEnd
AttributeBegin
  Translate -0.34 0.6 -0.29
  Rotate 20 0 1 0
  Scale 0.3 0.6 0.3
  Shape "trianglemesh" "point3 P" [ -1 -1 -1  1 -1 -1  1 1 -1  -1 1 -1  -1 -1 1  1 -1 1  1 1 1  -1 1 1 ]
    "integer indices" [ 0 2 1 0 3 2  4 5 6 4 6 7  0 1 5 0 5 4  3 6 2 3 7 6  1 2 6 1 6 5  0 4 7 0 7 3 ]
AttributeEnd
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 17 12 4 ]
  Material "diffuse" "rgb reflectance" [ 0 0 0 ]
  Shape "trianglemesh" "point3 P" [ -0.24 1.98 -0.22  0.23 1.98 -0.22  0.23 1.98 0.16  -0.24 1.98 0.16 ]
    "integer indices" [ 0 1 2 0 2 3 ]
AttributeEnd
)";
}

/// Glass, metal, rough metal and rough glass, noise, checks and an image on spheres, one of them moving and one of them
/// a light, with a thin lens and a filter with negative weights. `image` is the name of an image file.
inline std::string many_spheres(int width, int height, const std::string& image) {
  return R"(LookAt 0 1.5 6  0 0.6 0  0 1 0
Camera "perspective" "float fov" 38 "float lensradius" 0.06 "float focaldistance" 6
Film "rgb" "integer xresolution" )" +
         std::to_string(width) + R"( "integer yresolution" )" + std::to_string(height) +
         R"( "string filename" "many.exr"
Sampler "sobol" "integer pixelsamples" 8
PixelFilter "mitchell" "float xradius" 2 "float yradius" 2
Integrator "path" "integer maxdepth" 6
WorldBegin
LightSource "infinite" "rgb L" [ 0.2 0.25 0.4 ]
Texture "checks" "spectrum" "checkerboard" "integer dimension" 3 "rgb tex1" [ 0.8 0.8 0.7 ] "rgb tex2" [ 0.1 0.2 0.1 ]
Texture "veins" "spectrum" "marble" "float scale" 3
Texture "bumps" "float" "fbm" "integer octaves" 4
Texture "photo" "spectrum" "imagemap" "string filename" ")" +
         image + R"("
Texture "blend" "spectrum" "mix" "texture tex1" "photo" "rgb tex2" [ 0.9 0.3 0.1 ] "texture amount" "bumps"
AttributeBegin
  Material "diffuse" "texture reflectance" "checks"
  Translate 0 -1000 0
  Shape "sphere" "float radius" 1000
AttributeEnd
AttributeBegin
  Material "dielectric" "float eta" 1.5
  Translate -1.4 0.6 0.4
  Shape "sphere" "float radius" 0.6
AttributeEnd
AttributeBegin
  Material "conductor" "rgb reflectance" [ 0.9 0.8 0.6 ] "float roughness" 0
  Translate 0 0.6 -0.4
  Shape "sphere" "float radius" 0.6
AttributeEnd
AttributeBegin
  Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k" "float roughness" 0.2
  Translate 1.4 0.6 0.2
  Shape "sphere" "float radius" 0.6
AttributeEnd
AttributeBegin
  Material "dielectric" "float eta" 1.33 "float roughness" 0.1
  Translate 0.6 0.3 1.3
  Shape "sphere" "float radius" 0.3
AttributeEnd
AttributeBegin
  Material "diffuse" "texture reflectance" "veins"
  Translate -0.5 0.3 1.2
  ActiveTransform EndTime
  Translate 0.2 0.15 0
  ActiveTransform All
  Shape "sphere" "float radius" 0.3
AttributeEnd
AttributeBegin
  Material "diffuse" "texture reflectance" "blend"
  Translate 0.9 1.6 -1
  Rotate 30 0 1 0
  Shape "sphere" "float radius" 0.4
AttributeEnd
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 9 8 7 ]
  Translate -1.5 3 1
  Shape "sphere" "float radius" 0.5
AttributeEnd
)";
}

}  // namespace alhazen::impl::test
