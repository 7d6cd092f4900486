#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "ist/base/api.h"
#include "ist/base/float_environment.h"
#include "ist/query/contact_sink.h"
#include "ist/query/contacts/ancestor_share.h"
#include "ist/query/contacts/contact_point.h"
#include "ist/query/contacts/contact_rates.h"
#include "ist/query/contacts/touched_leaves.h"

namespace ist {

struct ContactPointOptions {
  std::size_t points = 32;  ///< at most; 0: the sums alone, which take less time and memory
  /// Touched moving leaves that are told apart, 104 bytes each. Where there are more, they are told
  /// apart by their parents in the octree, or whatever ancestors there is room for.
  std::size_t touched_leaves = 1 << 15;
  /// Pairs less deep weigh nothing, and springs begin there: in parts of the mean voxel size, from
  /// -2, where all leaf pairs count, up to 1. What bears a load begins where surfaces meet; pairs
  /// that are merely near take a third of the time then.
  double least_depth = -2;
  /// Leaf pairs count whose bounds are no farther apart than this, in parts of the mean voxel size,
  /// at most 1. Bounds are tight, so without it pairs come and go with surfaces that cross; what
  /// bears a load keeps all that is as deep, or as high, as this.
  double growth = 0;
};

/// Contacts that a hand can use: every leaf pair of an answer, one after the other, reduced to sums
/// that are Lipschitz in the pose and to a few contact points (see cluster()).
///
/// A pair weighs s_f s_m · u · b · |e|, with s_f and s_m the two voxel sizes: u says how far the
/// two balls overlap (ball_share), b the least overlap of both slabs and of all ancestors' bounds,
/// and e is the mean of the two normals, each as long as it is coherent (pair_terms). Each factor
/// falls to 0, with a bounded slope, where the pair leaves the answer. Where normals cancel a
/// weight is 0. With another least depth than -2, so is that of a pair that is no deeper, and it
/// grows over a quarter of a voxel.
///
/// CollisionQuery::contact_points does all of it. A list of contacts that is at hand is reduced by
/// begin(), take() and finish(); it must be whole, and in order.
///
/// All memory is reserved by the constructor: 5.4 bytes a leaf of either tree, half a megabyte to
/// a megabyte for what was last looked at, and where there are points what TouchedLeaves takes. A
/// query allocates nothing and locks nothing. Holds references to both trees, which must outlive
/// it; one object belongs to one thread at a time. Cost: 40 to 100 ns a leaf pair, most where few
/// of them share a leaf.
class IST_API ContactPoints final : public ContactStream {
 public:
  /// `policy` is the query's. Throws kPolicyMissing; std::bad_alloc.
  ContactPoints(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                const ContactPointOptions& options = {});
  ContactPoints(const ContactPoints&) = delete;
  ContactPoints& operator=(const ContactPoints&) = delete;

  /// Begins a query; what is known of the one before is gone. False where `pose` is no rigid
  /// motion: then no contact is taken, and the sums are 0.
  [[nodiscard]] bool begin(const Eigen::Isometry3d& pose) noexcept;
  /// More contacts, sorted by fixed and then by moving leaf over all calls.
  bool take(std::span<const Contact> contacts) noexcept override;
  /// Makes the points.
  void finish() noexcept;

  /// After finish(), until the next begin().
  [[nodiscard]] std::span<const ContactPoint> points() const noexcept {
    return {points_.data(), count_};
  }
  [[nodiscard]] const ContactSums& sums() const noexcept { return sums_; }
  /// How fast the sums can change.
  [[nodiscard]] const ContactRates& rates() const noexcept { return rates_; }
  [[nodiscard]] const ContactScale& scale() const noexcept { return scale_; }

  [[nodiscard]] SpherePolicy policy() const noexcept { return policy_; }
  [[nodiscard]] bool is_between(const SphereTree& fixed, const SphereTree& moving) const noexcept {
    return &fixed == &fixed_ && &moving == &moving_;
  }
  /// Bytes reserved.
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  // A moving leaf in the fixed tree's frame, and the query it was moved in.
  struct MovedLeaf {
    std::uint32_t query = 0;
    std::uint32_t leaf;
    ContactLeaf at;
  };
  IST_LOCAL ContactPoints(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                          const ContactPointOptions& options,
                          const ScopedFloatEnvironment& environment);
  IST_LOCAL void take(const Contact& contact) noexcept;
  [[nodiscard]] IST_LOCAL ContactLeaf leaf_of(const SphereTree& tree, std::uint32_t leaf,
                                              const NodeParents& parents) const noexcept;
  [[nodiscard]] IST_LOCAL double share_of(const Contact& contact, const NodeBound& moving) noexcept;
  IST_LOCAL void add(const PairTerms& pair) noexcept;
  [[nodiscard]] IST_LOCAL const ContactLeaf& moved(std::uint32_t leaf) noexcept;
  IST_LOCAL void move(std::uint32_t leaf, MovedLeaf& to) const noexcept;

  const SphereTree& fixed_;
  const SphereTree& moving_;
  SpherePolicy policy_;
  ContactScale scale_;
  ContactRates rates_;
  NodeParents fixed_parents_, moving_parents_;
  AncestorShare ancestors_;
  std::vector<MovedLeaf> moved_;  // by the last bits of the leaf
  TouchedLeaves touched_;
  std::vector<ContactPoint> points_;

  RelativePose pose_;
  std::uint32_t query_ = 0;
  bool begun_ = false;
  std::uint32_t fixed_leaf_ = 0;  // the one that is at hand
  ContactLeaf fixed_at_;
  ContactSums sums_;
  std::size_t count_ = 0;
};

}  // namespace ist
