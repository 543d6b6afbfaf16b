#pragma once

// What an image decides about how it is displayed: its exposure and its white balance.

#include "images/display/exposure_meter.h"
#include "images/image.h"
#include "render/renderer.h"

namespace alhazen::impl {

/// What is left to the image.
struct DisplayChoice {
  ExposureRule exposure = ExposureRule::given;
  bool estimates_white = false;
};

/// Sets the exposure and the white balance of `how` as far as they are left to the image, and returns what it then is.
/// Both are metered from the image as it is written, denoised or not, on the surfaces that it shows (see
/// ExposureMeter).
DisplayStatistics choose_display(const Rendering& rendering, const DisplayChoice& choice, WriteOptions& how);

}  // namespace alhazen::impl
