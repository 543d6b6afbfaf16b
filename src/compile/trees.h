#pragma once

// The part of compiling that builds the trees of the world and of its objects.

#include <array>
#include <cstdint>
#include <vector>

#include "compile/compile_scene.h"
#include "compile/scene_arrays.h"

namespace alhazen::impl {

/// How many elements of each array belong to the tree of the world, which come first.
struct TreeSizes {
  size_t primitives = 0, bvh2_nodes = 0, cwbvh_nodes = 0, cwbvh_primitives = 0, bvh8_nodes = 0;
  std::array<size_t, Bvh8Child::kinds> blocks{};  ///< by Bvh8Child::Kind
};

/// What it takes to build the tree of the world again.
template <class Real>
struct WorldTree {
  TreeSizes sizes;
  /// By triangle of the world, in the order of the leaves: its index before it was brought into that order.
  std::vector<uint32_t> triangle_order;
  std::vector<Bounds3<Real>> object_boxes;
};

/// Fills the trees that `options` asks for and `primitives`, and brings triangles into the order of the leaves. The
/// world's triangles must come first in out.triangles, then those of each object one after the other; the roots are
/// written into out.objects. Adds what statistics say of trees.
template <class Real>
void build_trees(const CompileOptions& options, SceneArrays<Real>& out, SceneStatistics& statistics,
                 WorldTree<Real>* world = nullptr);

/// The same for the tree of the world alone, with `out` holding its triangles, other primitives and instances, and no
/// objects: `world` has their boxes.
template <class Real>
void build_world_tree(const CompileOptions& options, SceneArrays<Real>& out, WorldTree<Real>& world);

/// Counts nodes and bytes of all trees.
template <class Real>
void count_trees(const CompileOptions& options, const SceneView<Real>& view, SceneStatistics& statistics);

}  // namespace alhazen::impl
