#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "ist/base/api.h"
#include "ist/query/contact.h"
#include "ist/query/relative_pose.h"
#include "ist/tree/saved_spheres.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// Where the reference takes its spheres from.
enum class SphereSource : std::uint8_t {
  kOnTheFly,  ///< derived from the octree at each visit, as published, or unpacked from the tree
  kSaved,     ///< made once, at construction, and read back: the article's first proposal. Slabs
              ///< are unpacked at each visit all the same
};

/// The published query, plain and in double: depth first down both trees at once, each colliding
/// pair of nodes tested child by child. It specifies the answer that every faster engine must give.
///
/// It departs from what is published in three things. Contacts are sorted at the end, so that there
/// is one order for every engine. Where the voxel sizes differ, so that one cube has over √2 times
/// the other's edge, only the larger is opened; with equal sizes both always are, as published.
/// With kSlab, a pair whose balls touch is dropped all the same where one's ball lies outside the
/// other's slab.
///
/// Holds references to both trees, which must outlive it. One query object belongs to one thread.
/// Source: the article that the method comes from, section II.E.
class IST_API ReferenceQuery {
 public:
  /// Both trees must have `policy` (SphereTree::require). Cost: none with kOnTheFly; with kSaved 32
  /// bytes a node.
  ReferenceQuery(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                 SphereSource source = SphereSource::kOnTheFly);

  /// All pairs of leaves whose spheres touch.
  ///
  /// @param pose maps moving mesh coordinates to fixed mesh coordinates
  /// @param out  takes the contacts, sorted by fixed and then by moving leaf; where it is too
  ///             short, the first of them
  ///
  /// Cost: 5 to 20 ns a sphere test, 10 ns a contact for the order. Allocates when a pose has
  /// more contacts than any before, and can throw std::bad_alloc; this is the specification, not
  /// the fast path.
  [[nodiscard]] QueryResult collide(const Eigen::Isometry3d& pose, std::span<Contact> out);

  /// Surfaces in a contact are no farther apart, mesh units: 2 (rA + rB) + pad, with rA and rB the
  /// largest leaf radii of the two trees.
  [[nodiscard]] double resolution(const QueryResult& result) const noexcept;

 private:
  struct Node {
    int level;
    std::uint32_t index;
    Eigen::Vector3d cube_centre;  // in voxel edges from the root cube's centre
    Ball ball;                    // in the fixed tree's frame
    Slab slab;                    // likewise; with kSlab alone
  };
  struct Children {
    int count;
    Node nodes[8];
  };

  // Finds the bounds of a node that is child `slot` of `parent`.
  IST_LOCAL void bound(const SphereTree& tree, const SavedSpheres& saved, std::uint32_t parent,
                       int slot, Node& node) const;
  [[nodiscard]] IST_LOCAL Node root(const SphereTree& tree, const SavedSpheres& saved) const;
  IST_LOCAL void open(const SphereTree& tree, const SavedSpheres& saved, const Node& node,
                      Children& children) const;
  IST_LOCAL void to_fixed_frame(Node& node) const noexcept;
  [[nodiscard]] IST_LOCAL bool touch(const Node& a, const Node& b) noexcept;
  IST_LOCAL void descend(const Node& a, const Node& b);

  const SphereTree& fixed_;
  const SphereTree& moving_;
  SpherePolicy policy_;
  SavedSpheres saved_fixed_, saved_moving_;  // empty with kOnTheFly
  RelativePose pose_;
  double slack_ = 0;  // what a test may err by, and a reach is grown by
  std::uint64_t tests_ = 0;
  std::vector<Contact> found_, sorted_;
};

}  // namespace ist
