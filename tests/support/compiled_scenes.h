#pragma once

// Compiles scenes from a text in pbrt's format or from a description. Any warning fails the test.

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "compile/compile_scene.h"
#include "io/pbrt/pbrt.h"

namespace alhazen::impl::test {

inline void expect_no_warnings(const Diagnostics& diagnostics) {
  for (const Diagnostics::Warning& warning : diagnostics.warnings()) ADD_FAILURE() << warning.to_string();
}

/// Compiles in world space even if the scene is far from the origin, since the tests construct rays there.
template <class Real>
CompiledScene<Real> compiled_scene(Scene scene, int threads = 1) {
  Diagnostics diagnostics;
  CompileOptions options;
  options.threads = threads;
  options.layouts = {BvhLayout::bvh2, BvhLayout::bvh8, BvhLayout::cwbvh};
  options.in_render_space = false;
  CompiledScene<Real> flat = compile_scene<Real>(std::move(scene), options, diagnostics);
  expect_no_warnings(diagnostics);
  return flat;
}

inline Scene described_scene(const std::string& text) {
  Diagnostics diagnostics;
  Scene scene = parse_pbrt(text, "test.pbrt", "no-such-folder", diagnostics);
  expect_no_warnings(diagnostics);
  return scene;
}

template <class Real>
CompiledScene<Real> compiled_scene_of(const std::string& text) {
  return compiled_scene<Real>(described_scene(text));
}

/// Returns a film that does not scale radiance, so that pixel values are in the units of the lights.
inline std::string film_of(int width, int height) {
  return "Film \"rgb\" \"integer xresolution\" " + std::to_string(width) + " \"integer yresolution\" " +
         std::to_string(height) + "\nPixelFilter \"box\"\n";
}

}  // namespace alhazen::impl::test
