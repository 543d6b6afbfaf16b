#pragma once

// Cameras of scenes as pages know them, and back.

#include <array>
#include <string>

#include "alhazen/camera.h"
#include "view/protocol.h"

namespace alhazen::impl {

/// Where a scene is.
struct SceneExtent {
  ::alhazen::Vec3 middle;
  double radius = 1;
  ::alhazen::Vec3 up{0, 1, 0};  ///< of unit length
};

SceneExtent extent_of(const ::alhazen::Box& bounds, const ::alhazen::Vec3& up);

bool is_left_handed(const ::alhazen::Camera& camera);

/// As it is when the shutter opens. What it looks at is at its focus if its lens has a radius, else as far away as the
/// middle of the scene.
PageCamera page_camera(const ::alhazen::Camera& camera, const SceneExtent& extent);

/// `base`, placed as a page wants it. It stands still, and its handedness is kept.
::alhazen::Camera placed_camera(const ::alhazen::Camera& base, const PageCamera& wanted);

/// The options of the command line that place a camera there.
std::string camera_options(const PageCamera& camera);

/// A part of an image, in pixels: from (x, y) on.
struct PixelRegion {
  int x = 0, y = 0, width = 0, height = 0;
};

/// The camera that sees, as its whole image, as much of the region of an image of that size as so many coarser pixels
/// show, each of step x step of the image's. Of cameras for the whole sphere, which have no window, the camera itself.
::alhazen::Camera coarse_camera(const ::alhazen::Camera& camera, int full_width, int full_height,
                                const PixelRegion& region, int step);

}  // namespace alhazen::impl
