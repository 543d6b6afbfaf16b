#include "images/metrics/image_parts.h"

#include <algorithm>

#include "util/diagnostics.h"
#include "util/quoted.h"

namespace alhazen::impl {

namespace {

/// What is before the last dot of a channel's name; "" for R, G, B, A and a channel named Y alone.
std::string layer_of_channel(const std::string& channel) {
  const size_t dot = channel.rfind('.');
  return dot == std::string::npos ? std::string() : channel.substr(0, dot);
}

/// Adds the planes of `image` whose channels are these of the layer, if all are there.
bool take_channels(const Image& image, const std::string& layer, const std::vector<const char*>& names, Image& into) {
  std::vector<int> found;
  for (const char* name : names) found.push_back(image.channel(layer.empty() ? name : layer + "." + name));
  if (std::find(found.begin(), found.end(), -1) != found.end()) return false;
  constexpr const char* colours[] = {"R", "G", "B"};
  for (size_t i = 0; i < found.size(); ++i) {
    into.channels.emplace_back(found.size() == 1 ? "Y" : colours[i]);
    into.planes.push_back(image.planes[static_cast<size_t>(found[i])]);
  }
  return true;
}

std::string shown(const std::string& layer) { return layer.empty() ? "the colours" : quoted(layer); }

}  // namespace

std::vector<std::string> layer_names(const Image& image) {
  std::vector<std::string> names;
  for (const std::string& channel : image.channels)
    if (const std::string name = layer_of_channel(channel); std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  return names;
}

Image layer_of(const Image& image, const std::string& layer, const std::string& file) {
  Image part{image.width, image.height, {}, {}};
  for (const std::vector<const char*>& names :
       {std::vector<const char*>{"R", "G", "B"}, {"X", "Y", "Z"}, {"Y"}, {"Z"}, {"V"}, {"A"}})
    if (take_channels(image, layer, names, part)) return part;
  std::string list;
  for (const std::string& name : layer_names(image)) list += (list.empty() ? "" : ", ") + shown(name);
  throw InputError({file}, "there is no layer " + shown(layer) + " with R G B, X Y Z, Y or Z; its layers are " + list);
}

Image region_of(const Image& image, const std::array<int64_t, 4>& bounds) {
  const auto [x0, y0, x1, y1] = bounds;
  if (x0 < 0 || y0 < 0 || x1 > image.width || y1 > image.height || x0 >= x1 || y0 >= y1)
    throw InputError("the region is not within the image of " + std::to_string(image.width) + " x " +
                     std::to_string(image.height) + " pixels: give x0,y0,x1,y1 with x0 < x1 and y0 < y1");
  Image part{static_cast<int>(x1 - x0), static_cast<int>(y1 - y0), image.channels, {}};
  part.chromaticities = image.chromaticities;
  for (const std::vector<float>& plane : image.planes) {
    std::vector<float> values;
    for (int64_t y = y0; y < y1; ++y) {
      const auto row = plane.begin() + static_cast<std::ptrdiff_t>(y * image.width);
      values.insert(values.end(), row + static_cast<std::ptrdiff_t>(x0), row + static_cast<std::ptrdiff_t>(x1));
    }
    part.planes.push_back(std::move(values));
  }
  return part;
}

}  // namespace alhazen::impl
