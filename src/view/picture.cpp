#include "view/picture.h"

#include <algorithm>
#include <utility>

namespace alhazen::impl {

std::string layer_of(const std::string& channel) {
  if (channel == "R" || channel == "G" || channel == "B") return "color";
  if (channel == "A") return "alpha";
  return channel.substr(0, channel.rfind('.'));
}

const PictureLayer* Picture::layer(const std::string& name) const {
  const auto found = std::find_if(layers.begin(), layers.end(), [&](const PictureLayer& l) { return l.name == name; });
  return found == layers.end() ? nullptr : &*found;
}

std::shared_ptr<Picture> make_picture(RenderedImage&& image) {
  auto picture = std::make_shared<Picture>();
  picture->width = image.width;
  picture->height = image.height;
  picture->full_width = image.full_width > 0 ? image.full_width : image.width;
  picture->full_height = image.full_height > 0 ? image.full_height : image.height;
  picture->x = image.x;
  picture->y = image.y;
  picture->samples = image.samples;
  picture->is_final = image.complete;
  for (size_t i = 0; i < image.channels.size(); ++i) {
    const std::string name = layer_of(image.channels[i]);
    auto at = std::find_if(picture->layers.begin(), picture->layers.end(),
                           [&](const PictureLayer& layer) { return layer.name == name; });
    if (at == picture->layers.end()) at = picture->layers.insert(at, PictureLayer{name, {}, {}});
    // "A" and "alpha.Y" have the same values, and an image may have both.
    if (name == "alpha" && !at->channels.empty()) continue;
    at->channels.push_back(std::move(image.channels[i]));
    at->planes.push_back(std::move(image.planes[i]));
  }
  return picture;
}

}  // namespace alhazen::impl
