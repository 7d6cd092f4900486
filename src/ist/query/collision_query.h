#pragma once

#include <Eigen/Geometry>
#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include "ist/base/api.h"
#include "ist/base/float_environment.h"
#include "ist/query/contact.h"
#include "ist/query/contacts/contact_points.h"
#include "ist/query/exact/exact_search.h"
#include "ist/query/root_test.h"
#include "ist/query/search.h"
#include "ist/query/shared_search.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

struct CollisionOptions {
  std::optional<SpherePolicy> policy;  ///< by default the tightest that both trees have
  /// An instruction set of all_kernels(); empty: IST_TARGET's, or the best. All give the same
  /// answer.
  std::string target;
  /// Pairs of nodes that are alive at one level before they are searched further; 12 bytes each, a
  /// level and worker, and at least as many as the moving tree has nodes there. The answer does not
  /// depend on it. The default keeps what is used of a level's frontier in a core's own cache; a
  /// quarter as many cost a tenth of the time more where jaws are closed, four times as many gain
  /// nothing.
  std::size_t frontier_pairs = 1 << 16;
  /// 1: all is done in the calling thread. 2: a resident thread helps where it can, see
  /// SharedSearch. Anything else is a bug of the caller.
  int workers = 1;
  /// With two workers: how soon after a query begins the next one is expected; 0 when they follow
  /// one another at once.
  std::chrono::nanoseconds period = std::chrono::milliseconds(1);
  /// Where both trees have triangles: pairs of them that are told apart at a time, 20 to 36 bytes
  /// each. Where more are near each other, all is searched again for each part of them.
  std::size_t triangle_pairs = 1 << 18;
};

/// Where two bodies touch, fast: the breadth-first search down both trees, in batches of spheres.
///
/// It keeps the promises that ReferenceQuery keeps, in the same order of contacts; the two may
/// differ in pairs whose geometry does not meet. For one pair of trees and one pose the answer is
/// the same, bit by bit, on every instruction set, with one worker or two, and whatever the options
/// for memory.
///
/// All memory is reserved by the constructor, which also makes the first call of the kernels, so
/// that no query is slower for being the first. Holds references to both trees, which must outlive
/// it. Trees may be shared by many threads; one query object belongs to one thread at a time.
class IST_API CollisionQuery {
 public:
  /// Throws kPolicyMissing, kTargetMissing, kMemoryLimit; std::bad_alloc.
  CollisionQuery(const SphereTree& fixed, const SphereTree& moving,
                 const CollisionOptions& options = {});
  ~CollisionQuery();
  CollisionQuery(const CollisionQuery&) = delete;
  CollisionQuery& operator=(const CollisionQuery&) = delete;

  /// All pairs of leaves whose bounds touch.
  ///
  /// @param pose maps moving mesh coordinates to fixed mesh coordinates
  /// @param out  takes the contacts, sorted by fixed and then by moving leaf; where it is too
  ///             short, the first of them. What is behind the last one may be overwritten
  ///
  /// Allocates nothing, locks nothing and makes no system call. Cost: 1 to 3 ns a test of two
  /// bounds, 20 to 40 ns a pair of nodes.
  [[nodiscard]] QueryResult collide(const Eigen::Isometry3d& pose, std::span<Contact> out) noexcept;

  /// Likewise, but all of them go to `stream`, in the same order, until it wants no more: for what
  /// needs every contact and has no room for them. Where it stops the query that is not complete;
  /// how many contacts it was given by then, and the tests, depend on memory and workers.
  [[nodiscard]] QueryResult collide(const Eigen::Isometry3d& pose, ContactStream& stream) noexcept;

  /// Likewise, until the budget is spent: then what is known by then. `gap` is always given.
  [[nodiscard]] QueryResult collide(const Eigen::Isometry3d& pose, std::span<Contact> out,
                                    const Budget& budget) noexcept;

  /// Likewise, and reduces them all to contact points and to the sums that forces are made of; none
  /// of it is kept where the pose is no rigid motion. `points` is of the same trees and policy.
  /// Cost: that of collide(), and 50 to 120 ns a contact.
  [[nodiscard]] QueryResult contact_points(const Eigen::Isometry3d& pose,
                                           ContactPoints& points) noexcept;

  /// Likewise, until the budget is spent. Where the result is not complete neither are the points,
  /// and no force should come of them. `gap` is that of the roots, and where there are contacts no
  /// more than the resolution.
  ///
  /// It may make some 1,000 tests or 512 contacts, or one long row of them, more than the budget
  /// allows; with two workers, which share what has a deadline alone, 3,000 tests or 20 µs. Where
  /// the clock stopped it, a budget of as many tests as it tells stops it at the same place.
  [[nodiscard]] QueryResult contact_points(const Eigen::Isometry3d& pose, ContactPoints& points,
                                           const Budget& budget) noexcept;

  /// The distance between the surfaces, until the interval is no wider than `tolerance`, mesh
  /// units, or without triangles until the leaves are reached. With triangles it is that of two
  /// triangles where TrianglePairs puts them, to within 2^-24 of it and of the longest edge.
  ///
  /// The distance is Lipschitz in the pose: it changes by no more than a point of the moving body
  /// moves, at most |how far the origin of the moving tree's frame goes| + SphereTree::reach() of
  /// it · |angle in radians|. So intervals of two poses are no farther apart than that, and those
  /// of one pose, whatever they were made from, have a point in common. Without triangles none is
  /// wider than `tolerance` or twice resolution(), whichever is more.
  ///
  /// Bodies so far apart that float cannot tell their leaves from each other have the interval of
  /// their roots. The distance of two triangles errs by 2^-24 of it and of the longest edge, and by
  /// 2^-48 of how far the scene is from the origin, and no interval is narrower than twice that;
  /// except that it is 0 where triangles meet as collide_exact() finds them. Cost: 0.2 to 0.7 ms
  /// for jaws that are apart, 0.02 to 0.3 ms where they meet.
  [[nodiscard]] GapResult gap(const Eigen::Isometry3d& pose, double tolerance) noexcept;

  /// Whether both trees have triangles.
  [[nodiscard]] bool is_exact() const noexcept { return exact_.has_value(); }

  /// All pairs of triangles that have a point in common, exactly (TrianglePairs), by the calling
  /// thread alone. Where not is_exact() that is the status.
  ///
  /// @param out takes the pairs, sorted by fixed and then by moving triangle; where it is too
  ///            short, the first of them
  ///
  /// Where bodies are less than 5e-9 of how far they are from the origin, a moved vertex is rounded
  /// by more than leaves are, and triangles may meet so where collide() finds no leaves that do.
  ///
  /// Cost: some 1.2 µs a pair that meets, of jaws that are closed, with voxels no larger than
  /// triangles; much more with larger ones (NodeTriangles).
  [[nodiscard]] ExactResult collide_exact(const Eigen::Isometry3d& pose,
                                          std::span<TrianglePair> out) noexcept;

  /// Whether the bodies touch: ends at the first certain answer. Exact where is_exact(), and then
  /// never kPossible.
  [[nodiscard]] Touch touches(const Eigen::Isometry3d& pose) noexcept;

  /// Surfaces in a contact are no farther apart, mesh units: 2 (rA + rB) + pad, with rA and rB the
  /// largest leaf radii of the two trees.
  [[nodiscard]] double resolution(const QueryResult& result) const noexcept;

  [[nodiscard]] SpherePolicy policy() const noexcept { return policy_; }
  [[nodiscard]] const char* target() const noexcept { return kernels_.target; }
  [[nodiscard]] int workers() const noexcept {
    return std::holds_alternative<SharedSearch>(search_) ? 2 : 1;
  }
  /// How often the second worker helped; nothing with one worker.
  [[nodiscard]] SharedSearch::Sharing sharing() const noexcept;
  /// Bytes reserved.
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  // The two bodies as a query finds them.
  struct Approach {
    RelativePose relative;
    RootTest roots;
    double grow;  // what every reach is grown by
  };
  IST_LOCAL CollisionQuery(const SphereTree& fixed, const SphereTree& moving,
                           const CollisionOptions& options,
                           const ScopedFloatEnvironment& environment);
  [[nodiscard]] IST_LOCAL std::optional<Approach> approach(const Eigen::Isometry3d& pose,
                                                           double grow = 0) const noexcept;
  // What a triangle may be off that is moved in double, where both trees have any.
  [[nodiscard]] IST_LOCAL double triangle_error(const Eigen::Isometry3d& pose) const noexcept;
  [[nodiscard]] IST_LOCAL SearchPose narrowed(const Approach& approach,
                                              double grow = 0) const noexcept;
  [[nodiscard]] IST_LOCAL double pad_of(const SearchPose& pose) const noexcept;
  // Bounds touch that are no farther apart than `grow`.
  [[nodiscard]] IST_LOCAL QueryResult search(const Eigen::Isometry3d& pose, ContactSink& sink,
                                             double grow) noexcept;
  IST_LOCAL void set_steps(std::size_t made, QueryResult& result) const noexcept;
  IST_LOCAL void nearest_leaves(const Approach& approach, double tolerance,
                                GapResult& result) noexcept;
  [[nodiscard]] IST_LOCAL Search& alone() noexcept;

  const SphereTree& fixed_;
  const SphereTree& moving_;
  SpherePolicy policy_;
  const Kernels& kernels_;
  SearchPlan plan_;
  std::variant<std::monostate, Search, SharedSearch> search_;  // made after the plan it refers to
  std::optional<ExactSearch> exact_;
  double largest_coordinate_ = 0;  // of a moving vertex
  std::vector<Contact> window_;    // that streams look through
};

}  // namespace ist
