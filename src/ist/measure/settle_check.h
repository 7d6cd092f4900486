#pragma once

#include <array>

#include "ist/measure/settle.h"
#include "ist/measure/settle_frame.h"
#include "ist/query/query.h"

namespace ist {

/// A body's rest as its proof sees it. Lengths are in mesh units.
struct SettleClaim {
  const SettleFrame& frame;  ///< of the given pose
  Vector6 at;                ///< the coordinates of the rest
  Vector6 limits;            ///< the largest coordinates
  Eigen::Vector3d closing;   ///< unit vector, fixed axes
  std::array<bool, 6> held;  ///< coordinates
  double radius, reach, millimetre;
};

/// What is proven.
enum class SettleProof : std::uint8_t {
  kNone,
  kRests,   ///< contacts balance the load, and `remaining` is short
  kLeaves,  ///< the same if borders of the box push too
  kBusy,    ///< another thread is using the query
};

/// Returns whether bodies are free at a pose: no triangles meet, and if a body is closed, the other
/// one is not inside it. kYes: they are free.
[[nodiscard]] Answer is_free(Query& query, const Eigen::Isometry3d& pose);

/// Proves that a body rests, and fills in what holds at its pose: `free`, the distance, the
/// contacts with their forces, `residual`, `remaining`, `second_order`, `margin`, `rocks` and
/// `level`. It shares nothing with the search: it asks the query for near pairs, and finds forces
/// that balance the load.
///
/// A motion m of the load point and about it, of a size of at most `reach`, that ends at a free
/// pose has n · (v + w × arm) >= -(gap + bend) for each pair of parts with the normal n. `bend` is
/// what curved surfaces and curved ways allow. So with forces f >= 0 the load goes no farther than
/// Σ f gap + reach |load + Σ f wrench|, which is `remaining`, and Σ f bend, which is
/// `second_order`.
[[nodiscard]] SettleProof check_settled(Query& query, const SettleClaim& claim,
                                        Settlement& settled);

}  // namespace ist
