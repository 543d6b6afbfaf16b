#pragma once

// BSDFs for the tests, and directions in which to evaluate them.

#include <string>
#include <vector>

#include "core/materials/bsdf.h"

namespace alhazen::impl::test {

/// Returns a frame whose normal is along no axis, so that errors in the shading frame are visible.
template <class Real>
Frame<Real> tilted_frame() {
  return frame_about(normalize(Vec3<Real>{Real(0.36), Real(-0.48), Real(0.8)}));
}

template <class Real>
struct NamedBsdf {
  std::string name;
  Bsdf<Real> bsdf;
};

template <class Real>
NamedBsdf<Real> diffuse_bsdf(double albedo) {
  NamedBsdf<Real> named{"diffuse", {MaterialKind::diffuse, tilted_frame<Real>()}};
  named.bsdf.diffuse = {splat(static_cast<Real>(albedo))};
  return named;
}

/// A conductor with the complex index of refraction of gold in three channels.
template <class Real>
NamedBsdf<Real> metal_bsdf(double alpha) {
  NamedBsdf<Real> named{"metal, alpha " + std::to_string(alpha), {MaterialKind::conductor, tilted_frame<Real>()}};
  named.bsdf.conductor = {
      {Real(0.143), Real(0.375), Real(1.442)}, {Real(3.983), Real(2.386), Real(1.603)}, static_cast<Real>(alpha)};
  return named;
}

/// A conductor that reflects (nearly) everything at every angle.
template <class Real>
NamedBsdf<Real> white_metal_bsdf(double alpha) {
  NamedBsdf<Real> white = metal_bsdf<Real>(alpha);
  white.name = "white " + white.name;
  white.bsdf.conductor.eta = splat(Real(1));
  white.bsdf.conductor.k = splat(Real(1e6));
  return white;
}

template <class Real>
NamedBsdf<Real> glass_bsdf(double alpha, double ior = 1.5) {
  NamedBsdf<Real> named{"glass, alpha " + std::to_string(alpha), {MaterialKind::dielectric, tilted_frame<Real>()}};
  named.bsdf.dielectric = {static_cast<Real>(ior), static_cast<Real>(alpha)};
  return named;
}

/// Returns the world-space direction with the given cosine to the normal of `frame` and the given azimuth.
template <class Real>
Vec3<Real> direction_at(const Frame<Real>& frame, double cosine, double azimuth) {
  const double sine = safe_sqrt(1 - cosine * cosine);
  return normalize(frame.to_world(convert<Real>(Vec3d{sine * std::cos(azimuth), sine * std::sin(azimuth), cosine})));
}

/// From normal to grazing incidence.
inline constexpr double cosines[] = {1, 0.8, 0.5, 0.2, 0.05, 0.01};

}  // namespace alhazen::impl::test
