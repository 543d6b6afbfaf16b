// Selects the colour channels of an image with many channels.

#include <algorithm>
#include <array>
#include <cctype>
#include <map>

#include "images/codecs/decoders.h"

namespace alhazen::impl {

namespace {

/// The channels of one layer, by the component after the last dot of their names; -1 if absent.
struct Layer {
  int red = -1, green = -1, blue = -1, luminance = -1, alpha = -1;
  bool has_chroma = false, is_vector = false;

  bool has_colour() const { return red >= 0 && green >= 0 && blue >= 0; }
  /// CIE XYZ, or the components of a vector: Y alone is not the image.
  bool is_xyz() const { return is_vector && luminance >= 0 && !has_colour(); }
  /// If chroma is stored too, the luminance alone is not the image.
  bool has_grey() const { return luminance >= 0 && !has_chroma; }
};

/// Layers by name, in alphabetical order; the base layer is "".
std::map<std::string, Layer> layers_of(const Image& image) {
  std::map<std::string, Layer> layers;
  for (size_t i = 0; i < image.channels.size(); ++i) {
    const std::string& name = image.channels[i];
    const size_t dot = name.rfind('.');
    Layer& layer = layers[dot == std::string::npos ? "" : name.substr(0, dot)];
    const std::string component = dot == std::string::npos ? name : name.substr(dot + 1);
    const int index = static_cast<int>(i);
    if (component == "R") layer.red = index;
    if (component == "G") layer.green = index;
    if (component == "B") layer.blue = index;
    if (component == "Y") layer.luminance = index;
    if (component == "A") layer.alpha = index;
    layer.is_vector |= component == "X";
    layer.has_chroma |= component == "RY" || component == "BY";
  }
  return layers;
}

ColourChannels channels_of(const Layer& layer) {
  if (layer.has_colour()) return {{layer.red, layer.green, layer.blue}, layer.alpha, {}};
  return {{layer.luminance, layer.luminance, layer.luminance}, layer.alpha, {}};
}

/// Returns whether programs use this name for the whole image beside layers of its parts.
bool is_whole_image(const std::string& layer) {
  const size_t dot = layer.rfind('.');
  std::string name = dot == std::string::npos ? layer : layer.substr(dot + 1);
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name == "combined" || name == "beauty" || name == "rgba" || name == "rgb";
}

/// The only layer for which `has` holds, or the only one of them that is named like a whole image.
template <class Has>
ColourChannels only_layer(const std::map<std::string, Layer>& layers, const Has& has) {
  const Layer* whole = nullptr;
  const Layer* any = nullptr;
  int count = 0, whole_count = 0;
  std::string names;
  for (const auto& [name, layer] : layers) {
    if (!has(layer)) continue;
    any = &layer;
    ++count;
    names += (names.empty() ? "'" : ", '") + name + "'";
    if (!is_whole_image(name)) continue;
    whole = &layer;
    ++whole_count;
  }
  if (count == 1) return channels_of(*any);
  if (whole_count == 1) return channels_of(*whole);
  ColourChannels none;
  if (count > 1)
    none.fault =
        "has colours in several layers (" + names + ") and none without a name: write the intended one as R, G, B";
  return none;
}

/// What the file has instead of colours.
std::string fault_of(const std::map<std::string, Layer>& layers) {
  const auto any = [&](const auto& is) {
    return std::any_of(layers.begin(), layers.end(), [&](const auto& entry) { return is(entry.second); });
  };
  if (any([](const Layer& layer) { return layer.luminance >= 0 && layer.has_chroma; }))
    return "has luminance and chroma (Y, RY, BY), which are not supported: convert it to R, G, B";
  if (any([](const Layer& layer) { return layer.is_xyz(); }))
    return "has X, Y, Z and no R, G, B; neither CIE XYZ nor vectors are supported: convert it to R, G, B";
  return "has neither channels R, G, B nor grey in Y or a single channel";
}

}  // namespace

ColourChannels colour_channels(const Image& image) {
  if (image.channels.size() == 1) return {{0, 0, 0}, -1, {}};
  const std::map<std::string, Layer> layers = layers_of(image);
  if (const auto base = layers.find("");
      base != layers.end() && (base->second.has_colour() || base->second.has_grey()) && !base->second.is_xyz())
    return channels_of(base->second);
  ColourChannels found = only_layer(layers, [](const Layer& layer) { return layer.has_colour(); });
  if (!found && found.fault.empty())
    found = only_layer(layers, [](const Layer& layer) { return layer.has_grey() && !layer.is_vector; });
  if (!found && found.fault.empty()) found.fault = fault_of(layers);
  return found;
}

}  // namespace alhazen::impl
