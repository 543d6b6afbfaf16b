#pragma once

#include <string>

namespace alhazen::impl::study {

/// Figure 1 of the report, drawn anew as SVG: a camera, its image, rays through pixels, spheres of the three kinds of
/// material, bounces, and a light. Reflection and refraction are computed, so the angles are right.
std::string figure1_svg();
/// What the figure shows, for those who read it beside the figure or cannot see it.
std::string figure1_text();

}  // namespace alhazen::impl::study
