#pragma once

#include <Eigen/Geometry>
#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include "ist/query/contact.h"
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
  /// level and worker. The answer does not depend on it. The default keeps a level's frontier in a
  /// core's own cache, three quarters of a megabyte at most; a quarter as many cost a tenth of the
  /// time more where jaws are closed, four times as many gain nothing.
  std::size_t frontier_pairs = 1 << 16;
  /// 1: all is done in the calling thread. 2: a resident thread helps where it can, see
  /// SharedSearch.
  int workers = 1;
  /// With two workers: how soon after a query begins the next one is expected; 0 when they follow
  /// one another at once.
  std::chrono::nanoseconds period = std::chrono::milliseconds(1);
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
class CollisionQuery {
 public:
  /// Throws kPolicyMissing, kTargetMissing, kMemoryLimit; std::bad_alloc.
  CollisionQuery(const SphereTree& fixed, const SphereTree& moving,
                 const CollisionOptions& options = {});
  CollisionQuery(const CollisionQuery&) = delete;
  CollisionQuery& operator=(const CollisionQuery&) = delete;

  /// All pairs of leaves whose bounds touch.
  ///
  /// @param pose maps moving mesh coordinates to fixed mesh coordinates
  /// @param out  takes the contacts, sorted by fixed and then by moving leaf; where it is too
  ///             short, the first of them
  ///
  /// Allocates nothing, locks nothing and makes no system call. Cost: 1 to 3 ns a test of two
  /// bounds, 20 to 40 ns a pair of nodes.
  [[nodiscard]] QueryResult collide(const Eigen::Isometry3d& pose, std::span<Contact> out) noexcept;

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
  const SphereTree& fixed_;
  const SphereTree& moving_;
  SpherePolicy policy_;
  const Kernels& kernels_;
  SearchPlan plan_;
  std::variant<std::monostate, Search, SharedSearch> search_;  // made after the plan it refers to
};

}  // namespace ist
