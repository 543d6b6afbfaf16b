// Shapes that are too small to be seen leave the image of the others as it is: areas of boxes that are 0 in float do
// not spoil the trees.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/bits.h"
#include "support/scene_files.h"

namespace alhazen::impl::test {

namespace {

const std::string scene = R"(LookAt 0 -5 2  0 0 0.5  0 0 1
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 24 "integer yresolution" 20
WorldBegin
LightSource "infinite" "rgb L" [ 0.1 0.2 0.3 ]
Shape "trianglemesh" "point3 P" [ -2 -2 0  2 -2 0  2 2 0  -2 2 0 ] "integer indices" [ 0 1 2 0 2 3 ]
AttributeBegin Translate 0 0 0.7 Shape "sphere" "float radius" 0.5 AttributeEnd
)";

/// Shapes of this size about the origin.
std::string tiny(const std::string& size) {
  const std::string skew = "ConcatTransform [ 1 0.3 0 0  0 1 0.2 0  0.1 0 1 0  0 0 0 1 ]\n";
  const std::string scale = "Scale " + size + " " + size + " " + size + "\n";
  std::string text = "AttributeBegin " + skew + "Shape \"sphere\" \"float radius\" " + size + " AttributeEnd\n";
  for (const char* shape : {"sphere", "cylinder", "disk"})
    text += "AttributeBegin " + scale + "Shape \"" + shape + "\" AttributeEnd\n" + "AttributeBegin " + scale + skew +
            "Shape \"" + shape + "\" AttributeEnd\n";
  text += "ObjectBegin \"mesh\" " + skew + "Shape \"sphere\" ObjectEnd\nAttributeBegin\n" + scale;
  for (int i = 0; i < 20; ++i) text += "Rotate 20 1 2 3 ObjectInstance \"mesh\"\n";
  return text + "AttributeEnd\n";
}

TEST(TinyShapes, HideNothing) {
  for (const char* precision : {"float", "double"})
    for (const char* backend : {"serial", "cuda"}) {
      Settings settings;
      settings.precision = precision;
      settings.backend = backend;
      if (settings.backend == "cuda") settings.device = "host";
      settings.samples_per_pixel = 4;
      const Outcome expected = render_bits(scene_of(scene), settings);
      std::vector<std::string> sizes{"1e-15", "1e-18", "1e-21", "1e-25", "1e-30", "1e-37"};
      if (settings.precision == "double") sizes.insert(sizes.end(), {"1e-45", "1e-80", "1e-150"});
      for (const std::string& size : sizes)
        EXPECT_TRUE(same_bits(expected, render_bits(scene_of(scene + tiny(size)), settings)))
            << precision << ' ' << backend << ' ' << size;
    }
}

}  // namespace

}  // namespace alhazen::impl::test
