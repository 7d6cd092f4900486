#pragma once

#include <Eigen/Core>
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ist/base/api.h"
#include "ist/base/progress.h"
#include "ist/mesh/mesh.h"

namespace ist {

namespace detail {
struct Access;
struct TreeParts;
}  // namespace detail

/// How an octree node is read as a sphere.
enum class SpherePolicy : std::uint8_t {
  kSimple,  ///< the circumsphere of the node's cube
  kTable,   ///< the smallest ball round the children's cubes, from the lookup table
  /// Saved with the tree: of a leaf the ball round the triangles clipped to its cube, of an inner
  /// node a ball round its leaves' balls.
  kTight,
  kSlab,  ///< the tight ball, cut by a thin slab, saved too
};

/// All of them, from the loosest to the tightest.
inline constexpr std::array kSpherePolicies = {SpherePolicy::kSimple, SpherePolicy::kTable,
                                               SpherePolicy::kTight, SpherePolicy::kSlab};

/// Returns "simple", "table", "tight" or "slab".
[[nodiscard]] constexpr std::string_view to_string(SpherePolicy policy) noexcept {
  constexpr std::array<std::string_view, kSpherePolicies.size()> kNames = {"simple", "table",
                                                                           "tight", "slab"};
  const auto at = static_cast<std::size_t>(policy);
  return at < kNames.size() ? kNames[at] : "";
}

/// Returns the policy of that name, or nullopt for another text.
[[nodiscard]] constexpr std::optional<SpherePolicy> sphere_policy(std::string_view name) noexcept {
  for (const SpherePolicy policy : kSpherePolicies) {
    if (name == to_string(policy)) return policy;
  }
  return std::nullopt;
}

/// The file that a mesh was read from, and the unit of the mesh's lengths.
struct MeshSource {
  /// The file's name without its folder, empty if unknown: UTF-8, at most 255 bytes, without
  /// control characters, slashes and backslashes.
  std::string name = {};
  std::uint64_t hash = 0;                  ///< XXH3-64 of the file's bytes; 0 if unknown
  LengthUnit unit = LengthUnit::kUnknown;  ///< of the mesh's lengths

  /// Compares all members.
  friend bool operator==(const MeshSource&, const MeshSource&) = default;
};

/// A leaf of the fixed tree and a leaf of the moving tree whose bounds overlap, by their indices.
/// The surfaces in the two leaves are no farther apart than the answer's `resolution`.
struct LeafPair {
  std::uint32_t fixed,  ///< leaf of the fixed tree
      moving;           ///< leaf of the moving tree

  /// Orders pairs by fixed and then by moving leaf.
  friend auto operator<=>(const LeafPair&, const LeafPair&) = default;
};
static_assert(sizeof(LeafPair) == 8);

/// A body made ready for queries. Its triangles answer questions about the surface itself. Its
/// voxels, folded into an octree of bounding spheres, answer leaf pairs and contacts. It has either
/// or both.
///
/// The content never changes after it was built. Copies share it, and so do queries: a tree may be
/// moved, or go away, while a query uses it, and any number of threads may read it. A tree that was
/// moved from may only be assigned to or destroyed. Lengths are in mesh units.
class IST_API SphereTree {
 public:
  /// Whether the tree has voxels: it was built with a voxel size.
  [[nodiscard]] bool has_voxels() const noexcept;
  /// The edge of a voxel; 0 without voxels.
  [[nodiscard]] double voxel_size() const noexcept;
  /// The number of voxels that the surface meets; 0 without voxels.
  [[nodiscard]] std::uint32_t leaf_count() const noexcept;
  /// The level of the root; leaves are at level 0. It is 0 without voxels.
  [[nodiscard]] int depth() const noexcept;
  /// Whether the outer side of the surface is known or assumed.
  [[nodiscard]] Orientation orientation() const noexcept;
  /// The centres of all leaf cubes, mesh coordinates, in the order of the indices of LeafPair.
  /// Empty without voxels. Cost: 20 ns a leaf.
  [[nodiscard]] std::vector<Eigen::Vector3d> leaf_centres() const;

  /// The last of kSpherePolicies that the tree has. It has those before it too. Without voxels this
  /// is kSimple, and has() is false.
  [[nodiscard]] SpherePolicy tightest() const noexcept;
  /// Whether the tree has those spheres; false without voxels.
  [[nodiscard]] bool has(SpherePolicy policy) const noexcept {
    return has_voxels() && policy <= tightest();
  }
  /// Throws kPolicyMissing if the tree lacks those spheres. The error names `body` and the remedy.
  void require(SpherePolicy policy, std::string_view body) const;

  /// The triangles that the build oriented and, unless it was told not to, welded. They are the
  /// mesh's, in its order. Null without keep_triangles.
  [[nodiscard]] const TriangleMesh* triangles() const noexcept;
  /// The number of pairs of its triangles that meet beyond the corners and edges that they share,
  /// as check_mesh() counts them. The first call for a tree, or the first signed distance or depth,
  /// takes 1.2 µs a triangle and core. Throws kTrianglesMissing.
  [[nodiscard]] std::uint64_t self_intersections() const;
  /// The mesh's file and unit, as BuildOptions::source or the mesh told them.
  [[nodiscard]] const MeshSource& source() const noexcept;
  /// The frame of the mesh's coordinates; kUnknown if its file does not say it.
  [[nodiscard]] PatientFrame frame() const noexcept;
  /// Whether the tree holds proximity voxels (BuildOptions::proximity).
  [[nodiscard]] bool has_proximity() const noexcept;

  /// The origin of the tree's frame in mesh coordinates: the centre of the root cube; without
  /// voxels the middle of the box round the vertices that triangles use.
  [[nodiscard]] Eigen::Vector3d origin() const noexcept;
  /// No sphere of the tree extends farther than this from the origin of the tree's frame; without
  /// voxels no triangle does.
  [[nodiscard]] double bounding_radius() const noexcept;
  /// The radius of the largest leaf sphere; 0 without voxels. Precondition: has(policy), or the
  /// tree lacks voxels.
  [[nodiscard]] double largest_leaf_radius(SpherePolicy policy) const noexcept;
  /// Bytes in memory, with outer balls if there are any (prepare_depth()), without the 24 a
  /// triangle that ist/measure.h adds at its first use.
  [[nodiscard]] std::uint64_t bytes() const noexcept;

 private:
  friend struct detail::Access;
  explicit SphereTree(detail::TreeParts parts);

  std::shared_ptr<const detail::TreeParts> parts_;
};

/// The options of build_tree().
struct BuildOptions {
  /// Edge of a voxel, mesh units; 0: the tree gets no voxels. Only leaf pairs and contacts need
  /// them. A build without them is faster.
  double voxel_size = 0;
  /// The tightest spheres to save, round voxels; implicit ones cost nothing.
  SpherePolicy spheres = SpherePolicy::kSlab;
  /// For exact answers: 48 bytes a triangle for its clusters, 25 for the mesh, and 4 for each leaf
  /// that it meets: 80 with large voxels, 150 with 0.2 mm on a jaw of 107,000 triangles.
  /// kArgumentInvalid if it is false and the voxel size is 0.
  bool keep_triangles = true;
  /// Proximity voxels besides surface voxels. kArgumentInvalid if the voxel size is 0.
  bool proximity = false;
  /// Vertices at exactly one position count as one, as in files: weld(). Without it, triangles are
  /// neighbours only if they share indices.
  bool weld = true;
  std::uint64_t max_memory = std::uint64_t{4} << 30;  ///< bytes, for voxels, bounds and clusters
  /// Kept by the tree; nothing is converted. If its unit is unknown, the tree keeps the mesh's.
  /// kArgumentInvalid if both are known and differ.
  MeshSource source = {};
  /// A mesh of the other known frame is turned into this one: x and y change their signs. A mesh
  /// of unknown frame stays as it is, and kUnknown turns none.
  PatientFrame frame = PatientFrame::kUnknown;
};

/// The stages of a build, and the repairs of its mesh.
struct BuildReport {
  /// A stage of a build.
  struct Stage {
    const char* name;     ///< a literal, such as Progress::stage() returns
    double milliseconds;  ///< wall time
  };
  std::vector<Stage> stages;          ///< in the order of building
  std::size_t turned_components = 0;  ///< closed components that were inside out
};

/// Builds a tree from a mesh: welds it, turns it outward and puts its triangles into clusters. With
/// a voxel size it finds the voxels, folds them into an octree and makes the bounds that are saved.
///
/// @param mesh     the surface, mesh units
/// @param options  voxel size, bounds, memory
/// @param report   filled in, if not null
/// @param progress written during the build, if not null; Progress::stop() ends the build
///
/// Cost: on two cores, for a jaw of 107,000 triangles and 1.76 million voxels, 0.5 s; with kTight
/// 1.3 s more, with kSlab 2 s more; without voxels 0.2 s. Throws kMeshEmpty, kMeshPointsOnly,
/// kMeshNotFinite, kMeshBadIndex, kMeshExtent, kVoxelSizeInvalid, kVoxelSizeTooSmall, kMemoryLimit,
/// kCancelled, and kArgumentInvalid for options that contradict each other, for a source whose name
/// is not as MeshSource says, or whose unit is not one.
[[nodiscard]] IST_API SphereTree build_tree(TriangleMesh mesh, const BuildOptions& options = {},
                                            BuildReport* report = nullptr,
                                            Progress* progress = nullptr);

/// Whether build_tree() would give a tree: the voxel size is 0 or one for this mesh, and the tree
/// fits the memory that is allowed. Cost: a tenth of the build.
[[nodiscard]] IST_API bool can_build_tree(const TriangleMesh& mesh, const BuildOptions& options,
                                          Progress* progress = nullptr);

/// The version of the tree file (`.ist`) that this library writes and reads.
inline constexpr std::uint32_t kTreeFileVersion = 5;

/// Writes the file whole or not at all. Throws kFileUnwritable. Cost: bound by the disk.
/// Returns the bytes written.
IST_API std::uint64_t write_tree(const SphereTree& tree, const std::filesystem::path& file);

/// Reads a tree into memory of its own. The checksum and then every count, index and number is
/// verified before the tree is made, so no file can make a query crash or never end. Whether bounds
/// and clusters hold the triangles, or nodes their leaves, is not verified: a file that this
/// library did not write may give an answer that lacks pairs.
///
/// Cost: 1 ns a byte. Throws kFileUnreadable, kNotATree, kTreeVersion, kTreeTruncated,
/// kTreeCorrupt.
[[nodiscard]] IST_API SphereTree read_tree(const std::filesystem::path& file);

/// Returns the bytes of the tree's file. Cost: 1 ns a byte.
[[nodiscard]] IST_API std::vector<std::byte> tree_to_bytes(const SphereTree& tree);

/// Reads a tree from the bytes of a tree file, by the rules of read_tree().
///
/// @param bytes the whole file
/// @param name  names the bytes in errors
[[nodiscard]] IST_API SphereTree tree_from_bytes(std::span<const std::byte> bytes,
                                                 const std::string& name = "the bytes of a tree");

/// Whether a file begins as a tree file does. Throws kFileUnreadable.
[[nodiscard]] IST_API bool is_tree_file(const std::filesystem::path& file);

}  // namespace ist
