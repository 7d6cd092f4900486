#pragma once

#include <Eigen/Geometry>
#include <cstring>
#include <vector>

#include "ist/query/pair_cache/cache_filler.h"
#include "ist/query/traversal/search_pose.h"
#include "ist/tree/tree_parts.h"
#include "query/query_cases.h"
#include "query/scenes.h"

namespace ist::test {

/// Two trees with what the search for a cache takes.
struct CacheCase {
  CacheCase(const SphereTree& fixed_tree, const SphereTree& moving_tree, SpherePolicy with,
            const char* target = "")
      : fixed(fixed_tree),
        moving(moving_tree),
        policy(with),
        plan(fixed, moving, with),
        kernels(select_kernels(target)) {}

  [[nodiscard]] RelativePose relative(const Eigen::Isometry3d& pose) const {
    return *relative_pose(pose, parts_of(fixed).origin, parts_of(moving).origin);
  }
  [[nodiscard]] CacheFiller::Wanted wanted(
      const RelativePose& centre, double extent,
      std::uint64_t most = std::numeric_limits<std::uint64_t>::max()) const {
    const SearchPose pose = to_float(centre, fixed_lengths, moving_lengths, extent);
    return {centre, pose, extent, Measured::kUpper, most};
  }

  const SphereTree& fixed;
  const SphereTree& moving;
  SpherePolicy policy;
  SearchPlan plan;
  const Kernels& kernels;
  TreeLengths fixed_lengths = lengths_of(fixed, policy),
              moving_lengths = lengths_of(moving, policy);
  double voxel = std::min(fixed.voxel_size(), moving.voxel_size());
};

/// Whether two caches hold the same pairs in the same order, float for float, and tell the same of
/// the distance.
[[nodiscard]] inline bool same_cache(const PairCache& a, const PairCache& b, bool slabs) {
  const CacheLanes &p = a.lanes, &q = b.lanes;
  if (p.pair_count != q.pair_count || p.row_count != q.row_count || a.upper != b.upper ||
      a.extent != b.extent) {
    return false;
  }
  const auto same = [](const auto* x, const auto* y, std::size_t count) {
    return std::memcmp(x, y, count * sizeof *x) == 0;
  };
  const CacheLanes::Moving &m = p.moving, &n = q.moving;
  const CacheLanes::Fixed &f = p.fixed, &g = q.fixed;
  bool all = same(m.id, n.id, p.pair_count) && same(m.row, n.row, p.pair_count) &&
             same(f.id, g.id, p.row_count) && same(f.address, g.address, p.row_count);
  for (std::size_t lane = 0; lane < (slabs ? kLanes : kNormalX); ++lane) {
    all &= same(m.lane[lane], n.lane[lane], p.pair_count) &&
           same(f.lane[lane], g.lane[lane], p.row_count);
  }
  for (const auto& [x, y] : {std::pair{m.x, n.x},
                             {m.y, n.y},
                             {m.z, n.z},
                             {m.normal_x, n.normal_x},
                             {m.normal_y, n.normal_y},
                             {m.normal_z, n.normal_z}}) {
    all &= same(x, y, p.pair_count);
  }
  for (const auto& [x, y] :
       {std::pair{f.normal_x, g.normal_x}, {f.normal_y, g.normal_y}, {f.normal_z, g.normal_z}}) {
    all &= same(x, y, p.row_count);
  }
  return all;
}

}  // namespace ist::test
