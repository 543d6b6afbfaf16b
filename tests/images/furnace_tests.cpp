// White furnace: under a sky of radiance 1, objects that lose no light are invisible.

#include <gtest/gtest.h>

#include <cmath>

#include "support/bits.h"
#include "support/environments.h"

namespace alhazen::impl::test {

namespace {

/// A camera in the sky.
const std::string sky = R"(LookAt 0 0 6  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 48 "integer yresolution" 48
PixelFilter "box"
Integrator "path" "integer maxdepth" 200
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
)";

/// A mirror, rough and smooth glass, and white clay.
const std::string furnace = sky + R"(AttributeBegin
  Material "conductor" "rgb reflectance" [ 1 1 1 ] "float roughness" 0
  Translate -0.8 0.7 0
  Shape "sphere" "float radius" 0.7
AttributeEnd
AttributeBegin
  Material "dielectric" "float eta" 1.5
  Translate 0.8 0.7 0
  Shape "sphere" "float radius" 0.7
AttributeEnd
AttributeBegin
  Material "diffuse" "rgb reflectance" [ 1 1 1 ]
  Translate 0 -0.7 0
  Shape "sphere" "float radius" 0.7
AttributeEnd
)";

struct Moments {
  double mean = 0, error = 0, smallest = 1e30, largest = -1e30;  ///< error: standard error of the mean
};

Moments moments_of(const Outcome& outcome) {
  Moments m;
  double squares = 0;
  const double count = static_cast<double>(outcome.rows.size());
  for (const float value : outcome.rows) {
    const double v = static_cast<double>(value);
    m.mean += v / count;
    squares += v * v / count;
    m.smallest = std::min(m.smallest, v);
    m.largest = std::max(m.largest, v);
  }
  m.error = std::sqrt(std::max(0.0, squares - m.mean * m.mean) / count);
  return m;
}

/// `lost` is what the mirrors of a path may absorb: 1e-4 at every reflection, as in pbrt.
void expect_nothing_to_be_seen(const Scene& scene, double lost = 2e-3) {
  for (const char* precision : {"float", "double"})
    for (const char* integrator : {"path", "iterative", "recursive"}) {
      SCOPED_TRACE(std::string(precision) + " " + integrator);
      Settings settings;
      settings.precision = precision;
      settings.integrator = integrator;
      settings.samples_per_pixel = 64;
      const Moments m = moments_of(render_bits(scene, settings));
      // The three channels of a pixel are equal, so the error of the mean is sqrt(3) times as large.
      EXPECT_NEAR(m.mean, 1, 4 * std::sqrt(3.0) * m.error + 1e-4);
      EXPECT_NEAR(m.mean, 1, 2e-3);
      if (std::string(integrator) == "path") continue;
      // BSDF sampling has no noise here: every path ends in the sky.
      EXPECT_GT(m.smallest, 1 - lost);
      EXPECT_LT(m.largest, 1 + 1e-4);
    }
}

TEST(Furnace, NothingCanBeSeen) { expect_nothing_to_be_seen(scene_of(furnace)); }

/// White clay and mirrors, inside and outside, sheared and in part. Some paths are reflected 30 times within a mirror.
TEST(Furnace, NothingCanBeSeenOfCylinders) {
  expect_nothing_to_be_seen(scene_of(sky + R"(Material "diffuse" "rgb reflectance" [ 1 1 1 ]
AttributeBegin
  Translate -0.8 0.7 0
  Rotate 50 1 0.5 0
  Shape "cylinder" "float radius" 0.7
AttributeEnd
AttributeBegin
  ConcatTransform [ 0.8 0 0 0  0.3 -0.6 0 0  0.1 0.2 0.7 0  0.8 -0.7 0 1 ]
  Shape "cylinder" "float phimax" 250
AttributeEnd
Material "conductor" "rgb reflectance" [ 1 1 1 ] "float roughness" 0
AttributeBegin
  Translate 0.8 0.7 0
  Rotate -60 1 0.5 0
  Shape "cylinder" "float radius" 0.5
AttributeEnd
AttributeBegin
  Translate -0.8 -0.7 0
  Scale -1 0.5 1
  Shape "cylinder" "float radius" 0.7 "float phimax" 200
AttributeEnd
)"),
                            5e-3);
}

/// The same for disks, and a can whose lid is ajar.
TEST(Furnace, NothingCanBeSeenOfDisks) {
  expect_nothing_to_be_seen(scene_of(sky + R"(Material "diffuse" "rgb reflectance" [ 1 1 1 ]
AttributeBegin
  Translate -0.8 0.7 0
  Rotate 50 1 0.5 0
  Shape "disk" "float radius" 0.7 "float innerradius" 0.3
AttributeEnd
AttributeBegin
  ConcatTransform [ 0.8 0 0 0  0.3 -0.6 0 0  0.1 0.2 0.7 0  0.8 -0.7 0 1 ]
  Shape "disk" "float phimax" 250
AttributeEnd
Material "conductor" "rgb reflectance" [ 1 1 1 ] "float roughness" 0
AttributeBegin
  Translate 0.8 0.7 0
  Rotate -60 1 0.5 0
  Shape "disk" "float radius" 0.5
AttributeEnd
Material "diffuse" "rgb reflectance" [ 1 1 1 ]
AttributeBegin
  Translate -0.8 -0.7 0
  Rotate -60 1 0.5 0
  Shape "cylinder" "float radius" 0.4 "float zmin" -0.3 "float zmax" 0.3
  Shape "disk" "float radius" 0.4 "float height" -0.3
  Shape "disk" "float radius" 0.4 "float height" 0.5
AttributeEnd
)"),
                            5e-3);
}

/// Microfacets of glass scatter light more than once, and it is not lost. Weights of samples vary little, even if paths
/// within a body are long.
TEST(Furnace, RoughGlassKeepsItsLight) {
  const auto ball = [](double x, double y, const std::string& glass) {
    return "AttributeBegin\nMaterial \"dielectric\" \"bool remaproughness\" false " + glass + "\nTranslate " +
           std::to_string(x) + " " + std::to_string(y) + " 0\nShape \"sphere\" \"float radius\" 0.7\nAttributeEnd\n";
  };
  const Scene scene = scene_of(sky + ball(-0.8, 0.7, "\"float eta\" 1.5 \"float roughness\" 0.3") +
                               ball(0.8, 0.7, "\"float eta\" 4 \"float roughness\" 1") +
                               ball(-0.8, -0.7, "\"float eta\" 1.1 \"float roughness\" 0.6") +
                               ball(0.8, -0.7, "\"float eta\" 1.5 \"float uroughness\" 0.1 \"float vroughness\" 0.5"));
  for (const char* precision : {"float", "double"})
    for (const char* integrator : {"path", "iterative", "recursive", "branching"}) {
      Settings settings;
      settings.precision = precision;
      settings.integrator = integrator;
      settings.samples_per_pixel = 64;
      const Moments m = moments_of(render_bits(scene, settings));
      EXPECT_NEAR(m.mean, 1, 1e-3) << precision << " " << integrator;
      EXPECT_LT(m.error, 1e-3) << precision << " " << integrator;
    }
}

/// A map that is 1 everywhere equals the constant sky.
TEST(Furnace, NothingCanBeSeenUnderAMap) {
  for (const int width : {8, 16}) {
    Scene scene = scene_of(furnace);
    scene.lights.clear();
    expect_nothing_to_be_seen(test::lit_by(std::move(scene), test::even_map(width, 8, 0.5f), test::map_askew(), 2));
  }
}

TEST(Furnace, GreyClayIsAsBrightAsItsAlbedo) {
  // A single ball: the light that it sends out was reflected once.
  const Scene scene = scene_of(R"(LookAt 0 0 6  0 0 0  0 1 0
Camera "perspective" "float fov" 10
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
PixelFilter "box"
WorldBegin
LightSource "infinite" "rgb L" [ 2 2 2 ]
Material "diffuse" "rgb reflectance" [ 0.25 0.25 0.25 ]
Shape "sphere" "float radius" 2
)");
  for (const char* integrator : {"path", "iterative", "recursive", "branching"}) {
    Settings settings;
    settings.integrator = integrator;
    settings.samples_per_pixel = 64;
    const Moments m = moments_of(render_bits(scene, settings));
    EXPECT_NEAR(m.mean, 0.5, 4 * std::sqrt(3.0) * m.error + 1e-5) << integrator;
    EXPECT_NEAR(m.mean, 0.5, 2e-3) << integrator;
  }
}

}  // namespace

}  // namespace alhazen::impl::test
