#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ist/base/progress.h"
#include "ist/mesh/mesh.h"
#include "ist/tree/sphere_tree.h"
#include "viewer/engine/reply.h"

namespace ist::viewer {

/// A body of the page: a mesh, or a tree that was read, and the tree that was taken last.
class PageBody {
 public:
  /// Reads a mesh or a tree, and checks it. Throws as read_mesh() and read_tree() do.
  /// @param unit of a mesh whose file names none, and of such a tree
  /// @param to_frame a mesh of the other known frame is turned into it; such a tree is refused
  PageBody(const std::filesystem::path& file, LengthUnit unit,
           PatientFrame to_frame = PatientFrame::kUnknown);

  /// Whether it holds triangles, of which a tree can be made.
  [[nodiscard]] bool rebuilds() const noexcept { return mesh_.has_value(); }
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] const MeshSource& source() const noexcept { return source_; }
  [[nodiscard]] double extent() const noexcept { return extent_; }
  /// The tree of the last take(), or the one that was read.
  [[nodiscard]] const std::optional<SphereTree>& tree() const noexcept { return tree_; }

  /// The tree that `ist occlusion` takes, whose answers need triangles alone: as it was read, or of
  /// the mesh without voxels. Made at its first use.
  [[nodiscard]] const SphereTree& whole();

  struct Built {
    SphereTree tree;
    double milliseconds;
  };
  /// Makes a tree of the triangles; where there are none, gives the one that was read. Throws as
  /// build_tree() does.
  [[nodiscard]] Built built(double voxel_size, Progress& progress) const;
  /// Takes the tree as its own.
  void take(Built built);

  /// Describes the body as it was read: BodyFacts of page/protocol.js.
  [[nodiscard]] nlohmann::ordered_json facts(Reply& reply) const;
  /// Describes its tree: TreeFacts. Precondition: tree().
  [[nodiscard]] nlohmann::ordered_json tree_facts() const;

 private:
  [[nodiscard]] BuildOptions options(double voxel_size) const;

  std::string name_;
  MeshSource source_;
  std::optional<TriangleMesh> mesh_;
  std::optional<SphereTree> tree_, whole_;
  nlohmann::ordered_json info_;
  std::vector<std::string> warnings_;
  double extent_ = 0, milliseconds_ = 0;
};

}  // namespace ist::viewer
