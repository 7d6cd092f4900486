#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <span>
#include <vector>

#include "ist/base/api.h"
#include "ist/base/progress.h"
#include "ist/measure/settle.h"

namespace ist {

/// Settles from many poses, on all cores: as settle() from each. Results stand in the order of the
/// poses, and do not depend on the number of threads. `options.proceed` is not asked.
///
/// @param query   of two trees with triangles
/// @param poses   as of settle()
/// @param options with a load point: else each pose has a load of its own
/// @param proceed asked every few poses; if it ends the call, the rest is kStopped
///
/// Throws as settle(). Each further thread makes a query of its own.
[[nodiscard]] IST_API std::vector<Settlement> settle_all(Query& query,
                                                         std::span<const Eigen::Isometry3d> poses,
                                                         const SettleOptions& options,
                                                         const Proceed& proceed = {});

/// Rests that are one: they close as far, and have the same contacts.
struct SettleGroup {
  std::size_t best;                  ///< the one with the least `remaining`, by its index
  std::vector<std::size_t> members;  ///< all of them, ascending
  double height;  ///< of the best one's load point along the closing direction, fixed coordinates
};

/// Groups the results that rest. Two are in one group if their load points are as far along the
/// closing direction, to within 10 µm, and their contacts with a force are at the same places of
/// the moving body, to within 0.5 mm. The group that closes farthest comes first.
///
/// @param settled of one pair of bodies, with one load
/// @param closing as the options had it
/// @param millimetre the length of 1 mm, mesh units
[[nodiscard]] IST_API std::vector<SettleGroup> group_settled(std::span<const Settlement> settled,
                                                             const Eigen::Vector3d& closing,
                                                             double millimetre);

}  // namespace ist
