#include "alhazen/read_image.h"

#include "api/caller_errors.h"
#include "api/rendered_image.h"
#include "images/image.h"

namespace ALHAZEN_NAMESPACE {

RenderedImage read_image(const std::string& file) {
  return impl::rendered_image(impl::for_caller([&] { return impl::read_image({file}); }));
}

}  // namespace ALHAZEN_NAMESPACE
