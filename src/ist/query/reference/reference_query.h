#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <span>

#include "ist/base/api.h"
#include "ist/base/pose.h"
#include "ist/query/results.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

namespace detail {
struct ReferenceState;
}

/// The source of the reference query's spheres.
enum class SphereSource : std::uint8_t {
  kOnTheFly,  ///< derived from the octree, or unpacked, at each visit: as published
  kSaved,     ///< made once, at construction: the article's first proposal. Slabs are unpacked at
              ///< each visit all the same
};

/// Returns whether the bounds that the published query tests are nested: the table's are not.
[[nodiscard]] constexpr bool published_are_nested(SpherePolicy policy) noexcept {
  return policy != SpherePolicy::kTable;
}

/// The published query, plain and in double: a depth-first traversal of both trees at once, which
/// tests each overlapping pair of nodes child by child. It specifies the answer of every faster
/// query.
///
/// It departs from the publication in three things. Leaf pairs are sorted at the end, so that every
/// engine has one order. Where one cube has over √2 times the other's edge, only the larger is
/// descended; with equal voxel sizes both always are, as published. With kSlab, a pair whose balls
/// overlap is rejected all the same where one ball lies outside the other's slab.
///
/// With kTable it tests the published balls, which are not nested: its answer lies inside that of
/// Query, but for pairs within the pad, and lacks no pair whose geometry meets.
///
/// It shares the content of both trees. One object belongs to one thread. Source:
/// E. Ruffaldi et al., The implicit sphere tree, World Haptics 2005, section II.E.
class IST_API ReferenceQuery {
 public:
  /// Throws kPolicyMissing, and kArgumentInvalid if the trees have different units or different
  /// frames. Cost: none with kOnTheFly; with kSaved 32 bytes a node.
  ReferenceQuery(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                 SphereSource source = SphereSource::kOnTheFly);
  ~ReferenceQuery();
  ReferenceQuery(ReferenceQuery&&) noexcept;  ///< the other may then only be assigned or destroyed
  ReferenceQuery& operator=(ReferenceQuery&&) noexcept;  ///< as the constructor

  /// Finds all pairs of leaves whose bounds overlap.
  ///
  /// @param pose maps moving mesh coordinates to fixed mesh coordinates
  /// @param out  takes the pairs, sorted by fixed and then by moving leaf; where it is too short,
  ///             the first of them
  ///
  /// Cost: 5 to 20 ns a sphere test, 20 ns a pair for the order. Allocates, and can throw
  /// std::bad_alloc: it is the specification, not the fast path.
  [[nodiscard]] QueryResult leaf_pairs(const Eigen::Isometry3d& pose, std::span<LeafPair> out);

 private:
  std::unique_ptr<detail::ReferenceState> state_;
};

}  // namespace ist
