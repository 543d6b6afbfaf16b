#include "alhazen/read_image.h"

#include <utility>

#include "api/caller_errors.h"
#include "images/image.h"

namespace ALHAZEN_NAMESPACE {

RenderedImage read_image(const std::string& file) {
  impl::Image read = impl::for_caller([&] { return impl::read_image({file}); });
  RenderedImage image;
  image.width = read.width;
  image.height = read.height;
  image.channels = std::move(read.channels);
  image.planes = std::move(read.planes);
  return image;
}

}  // namespace ALHAZEN_NAMESPACE
