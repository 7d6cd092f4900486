#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include "ablation/pointer_query.h"
#include "ist/query/results.h"
#include "ist/tree/sphere_tree.h"

namespace ist::bench {

/// Both bodies of a scene, with all that any variant reads.
struct Bodies {
  const SphereTree& fixed;
  const SphereTree& moving;
  PointerTree fixed_pointers, moving_pointers;
};

/// The parts of a query.
struct Parts {
  enum class Search {
    kPointers,  ///< depth first, node by node, by pointers: PointerQuery
    kLinear,    ///< depth first, on the linear octree: ReferenceQuery
    kBatches,   ///< breadth first, in batches of spheres: Query
  };
  Search search;
  SpherePolicy policy;
  std::string target = "scalar";  ///< of kBatches; the others have none
  int workers = 1;                ///< of kBatches; the others have one

  friend bool operator==(const Parts&, const Parts&) = default;
};

/// A query made of these parts. Refers to the bodies.
class Variant {
 public:
  Variant(const Bodies& bodies, const Parts& parts);

  [[nodiscard]] QueryResult leaf_pairs(const Eigen::Isometry3d& pose, std::span<LeafPair> out) {
    QueryResult result = collide_(pose, out);
    max_leaf_pairs_ = std::max<std::size_t>(max_leaf_pairs_, result.leaf_pairs);
    return result;
  }

  /// Of what it reads of both trees, and of its own memory by now.
  [[nodiscard]] std::size_t bytes() const;

 private:
  std::function<QueryResult(const Eigen::Isometry3d&, std::span<LeafPair>)> collide_;
  std::size_t tree_bytes_ = 0;
  std::size_t reserved_ = 0;               // of a query that reserves its memory
  std::size_t max_leaf_pairs_ = 0;         // of any answer
  std::size_t bytes_for_a_leaf_pair_ = 0;  // of one that does not
};

}  // namespace ist::bench
