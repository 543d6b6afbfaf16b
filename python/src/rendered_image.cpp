#include "rendered_image.h"

#include <algorithm>
#include <utility>

#include "alhazen/read_image.h"
#include "convert.h"
#include "interruptible.h"

namespace alhazen::python {

namespace {

/// The part of a channel's name that is its layer's, and the rest: "albedo", "R". R, G, B and A have an empty layer,
/// and other names without a dot are layers.
std::pair<std::string, std::string> split(const std::string& channel) {
  const size_t dot = channel.rfind('.');
  if (dot != std::string::npos) return {channel.substr(0, dot), channel.substr(dot + 1)};
  const bool is_colour = channel.size() == 1 && std::string("RGBA").find(channel) != std::string::npos;
  return is_colour ? std::pair(std::string(), channel) : std::pair(channel, std::string());
}

/// The place of a component among those of its layer: files may have them in the order of the alphabet.
size_t rank_of(const std::string& component) {
  static const std::string order = "RGBXYZUVWrgbxyzuvwAa";
  return component.size() == 1 ? order.find(component) : std::string::npos;
}

std::vector<ImageLayer> layers_of(const std::vector<std::string>& channels) {
  std::vector<ImageLayer> layers;
  for (size_t i = 0; i < channels.size(); ++i) {
    const std::string name = split(channels[i]).first;
    auto found = std::find_if(layers.begin(), layers.end(), [&](const ImageLayer& each) { return each.name == name; });
    if (found == layers.end()) found = layers.insert(layers.end(), ImageLayer{name, {}, {}});
    found->planes.push_back(i);
  }
  for (ImageLayer& layer : layers) {
    std::stable_sort(layer.planes.begin(), layer.planes.end(), [&](size_t a, size_t b) {
      return rank_of(split(channels[a]).second) < rank_of(split(channels[b]).second);
    });
    for (const size_t plane : layer.planes) layer.channels.push_back(channels[plane]);
  }
  return layers;
}

/// `array` as an image of R, G, B and perhaps A, or of Y.
RenderedImage image_of_array(const char* name, const py::object& given) {
  const py::array array = py::array::ensure(given);
  if (!array || array.dtype().kind() != 'f')
    refuse(name, "must be an alhazen.RenderedImage, the name of a file, or an array of floats (linear values)");
  const bool has_channels = array.ndim() == 3;
  const py::ssize_t count = has_channels ? array.shape(2) : 1;
  if ((array.ndim() != 2 && !has_channels) || (has_channels && count != 1 && count != 3 && count != 4))
    refuse(name, "must have the shape (height, width), (height, width, 3) or (height, width, 4), not " +
                     py::cast<std::string>(py::str(array.attr("shape"))));
  const auto values = py::array_t<float, py::array::c_style | py::array::forcecast>::ensure(array);
  if (!values) throw py::error_already_set();
  if (values.shape(0) > 1 << 20 || values.shape(1) > 1 << 20)
    refuse(name, "is too large: a side is over 1048576 pixels");
  RenderedImage image;
  image.height = static_cast<int>(values.shape(0));
  image.width = static_cast<int>(values.shape(1));
  if (count == 1)
    image.channels = {"Y"};
  else
    image.channels = {"R", "G", "B"};
  if (count == 4) image.channels.emplace_back("A");
  const size_t pixels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height),
               step = image.channels.size();
  image.planes.assign(step, std::vector<float>(pixels));
  for (size_t i = 0; i < pixels; ++i)
    for (size_t c = 0; c < step; ++c) image.planes[c][i] = values.data()[i * step + c];
  return image;
}

}  // namespace

PythonRenderedImage::PythonRenderedImage(RenderedImage&& image)
    : image_(std::make_shared<const RenderedImage>(std::move(image))), layers_(layers_of(image_->channels)) {}

bool PythonRenderedImage::has_layer(const std::string& name) const {
  return std::any_of(layers_.begin(), layers_.end(), [&](const ImageLayer& layer) { return layer.name == name; });
}

const ImageLayer& PythonRenderedImage::find(const std::string& name) const {
  std::string list;
  for (const ImageLayer& layer : layers_) {
    if (layer.name == name) return layer;
    if (!layer.name.empty()) list += (list.empty() ? "" : ", ") + layer.name;
  }
  throw py::key_error(name.empty() ? "the image has no channels R, G and B: its layers are " + list
                      : list.empty()
                          ? "there is no layer '" + name + "': the image has no layers; name them in 'layers' to render"
                          : "there is no layer '" + name + "': the layers are " + list);
}

py::array PythonRenderedImage::plane(const py::object& self, size_t index) const {
  const std::vector<float>& values = image_->planes[index];
  return read_only(py::array(py::dtype::of<float>(), {image_->height, image_->width}, values.data(), self));
}

py::array PythonRenderedImage::channel(const py::object& self, const std::string& name) const {
  const auto found = std::find(image_->channels.begin(), image_->channels.end(), name);
  if (found == image_->channels.end()) throw py::key_error("there is no channel '" + name + "'");
  return plane(self, static_cast<size_t>(found - image_->channels.begin()));
}

py::array PythonRenderedImage::layer(const py::object& self, const std::string& name) const {
  if (name.empty() && image_->channels.empty())  // stopped before any sample
    return read_only(py::array_t<float>(std::vector<py::ssize_t>{0, 0, 3}));
  const bool is_grey_alone = name.empty() && layers_.size() == 1 && layers_[0].planes.size() == 1;
  const ImageLayer& layer = is_grey_alone ? layers_[0] : find(name);
  if (layer.planes.size() == 1) return plane(self, layer.planes[0]);
  if (const auto found = interleaved_.find(layer.name); found != interleaved_.end()) return found->second;
  const size_t step = layer.planes.size();
  py::array_t<float> array({static_cast<size_t>(image_->height), static_cast<size_t>(image_->width), step});
  float* const values = array.mutable_data();
  {
    const Unlocked unlocked;
    const size_t pixels = image_->planes[layer.planes[0]].size();
    for (size_t c = 0; c < step; ++c) {
      const float* const from = image_->planes[layer.planes[c]].data();
      for (size_t i = 0; i < pixels; ++i) values[i * step + c] = from[i];
    }
  }
  return interleaved_.insert_or_assign(layer.name, read_only(std::move(array))).first->second;
}

py::object python_image(RenderedImage&& image) {
  return py::cast(std::make_shared<PythonRenderedImage>(std::move(image)));
}

std::shared_ptr<const RenderedImage> image_argument(const char* name, const py::object& given) {
  if (py::isinstance<PythonRenderedImage>(given)) return py::cast<const PythonRenderedImage&>(given).shared();
  if (!is_file_name(given)) return std::make_shared<const RenderedImage>(image_of_array(name, given));
  const std::string file = file_name(name, given);
  const Unlocked unlocked;
  return std::make_shared<const RenderedImage>(alhazen::read_image(file));
}

}  // namespace alhazen::python
