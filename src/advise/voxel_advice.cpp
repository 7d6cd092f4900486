#include "advise/voxel_advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "ist/base/float_environment.h"
#include "ist/base/platform/from_chars.h"
#include "ist/voxel/lattice.h"

namespace ist {
namespace {

using Clock = std::chrono::steady_clock;
using Poses = std::vector<Eigen::Isometry3d>;

double milliseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

std::uint64_t leaf_pairs_at(Query& query, const Eigen::Isometry3d& pose) {
  return query.leaf_pairs(pose, std::span<LeafPair>{}).leaf_pairs;
}

// Returns the median at the slowest pose, microseconds.
double slowest_query(Query& query, const Poses& poses, std::uint64_t room, double milliseconds) {
  constexpr int kLeastRounds = 5;
  std::vector<LeafPair> leaf_pairs(room + 1);
  std::vector<std::vector<double>> times(poses.size());
  const Clock::time_point begin = Clock::now();
  for (int round = 0; round < kLeastRounds || milliseconds_since(begin) < milliseconds; ++round) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Clock::time_point asked = Clock::now();
      static_cast<void>(query.leaf_pairs(poses[i], leaf_pairs));
      times[i].push_back(1e3 * milliseconds_since(asked));
    }
  }
  double slowest = 0;
  for (std::vector<double>& of_pose : times) {
    const auto middle = of_pose.begin() + static_cast<std::ptrdiff_t>(of_pose.size() / 2);
    std::nth_element(of_pose.begin(), middle, of_pose.end());
    slowest = std::max(slowest, *middle);
  }
  return slowest;
}

DistanceInterval distance(Query& exact, const Eigen::Isometry3d& pose, double tolerance) {
  exact.forget();  // no answer depends on the pose before
  return exact.distance(pose, tolerance).distance;
}

// Returns poses from first contact outward. The steps are 1/16 of a voxel, or 1/64 of the way if
// that is more.
Poses opening(Query& exact, const ClosingPath& path, double voxel_size, double resolution) {
  Poses poses;
  for (double way = voxel_size / 16;; way += std::max(voxel_size / 16, way / 64)) {
    poses.push_back(path.pose(path.first_contact + way));
    const DistanceInterval apart = distance(exact, poses.back(), voxel_size / 1024);
    if (apart.lower > resolution || !(apart.upper > 0)) return poses;
  }
}

double largest_error(Query& exact, Query& query, const Poses& poses) {
  constexpr int kHalvings = 16;
  double error = 0;
  std::optional<std::size_t> with, without;  // the last pose with leaf pairs, and without
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const bool has = leaf_pairs_at(query, poses[i]) > 0;
    if (has) error = std::max(error, distance(exact, poses[i], 0).upper);
    (has ? with : without) = i;
    const std::optional<std::size_t>& other = has ? without : with;
    if (i == 0 || other != i - 1 || poses[i].linear() != poses[i - 1].linear()) continue;
    Eigen::Isometry3d near = poses[*with];
    Eigen::Vector3d far = poses[*without].translation();
    for (int halving = 0; halving < kHalvings; ++halving) {
      Eigen::Isometry3d middle = near;
      middle.translation() = 0.5 * (near.translation() + far);
      if (leaf_pairs_at(query, middle) > 0) {
        near = middle;
      } else {
        far = middle.translation();
      }
    }
    error = std::max(error, distance(exact, near, 0).upper);
  }
  return error;
}

// Rounds to two significant digits, by at most a tenth.
double two_digits(double size, bool up) {
  double rounded = 0;
  from_chars(fmt::format("{:.1e}", up ? 1.05 * size : size / 1.05), rounded);
  return rounded;
}

// A size, and its value if it could be built.
struct Tried {
  double size;
  std::optional<double> value;
};

// Returns the size whose value should be `limit`, or the middle if a value is unknown.
double between(const Tried& coarse, const Tried& fine, double limit) {
  double part = 0.5;
  if (fine.value && *fine.value > 0 && *coarse.value > 0) {
    part = std::log(limit / *coarse.value) / std::log(*fine.value / *coarse.value);
  }
  return coarse.size * std::pow(fine.size / coarse.size, std::clamp(part, 0.1, 0.9));
}

}  // namespace

std::optional<SizeMeasure> measure_size(Query& exact, const Poses& poses,
                                        const std::optional<ClosingPath>& path, double voxel_size,
                                        const MeasureOptions& options, Progress& progress) {
  const ScopedFloatEnvironment environment;
  const TriangleMesh &fixed_mesh = *exact.fixed().triangles(),
                     &moving_mesh = *exact.moving().triangles();
  BuildOptions build;
  build.voxel_size = voxel_size;
  build.keep_triangles = false;
  build.max_memory = options.max_memory;
  if (!can_build_tree(fixed_mesh, build, &progress) ||
      !can_build_tree(moving_mesh, build, &progress)) {
    return std::nullopt;
  }
  SizeMeasure measured{.voxel_size = voxel_size};
  const Clock::time_point begin = Clock::now();
  const SphereTree fixed = build_tree(fixed_mesh, build, nullptr, &progress);
  const SphereTree moving = build_tree(moving_mesh, build, nullptr, &progress);
  measured.build_milliseconds = milliseconds_since(begin);
  measured.bytes = fixed.bytes() + moving.bytes();

  QueryOptions asked;
  asked.target = options.target;
  asked.workers = options.workers;
  asked.period = {};  // one query follows the other
  Query query(fixed, moving, asked);
  progress.begin_stage("timing queries, and comparing with triangles", 0);
  measured.resolution = query.leaf_pairs(poses.front(), std::span<LeafPair>{}).resolution;
  for (const Eigen::Isometry3d& pose : poses) {
    measured.max_leaf_pairs = std::max(measured.max_leaf_pairs, leaf_pairs_at(query, pose));
  }
  measured.slowest_query =
      slowest_query(query, poses, measured.max_leaf_pairs, options.milliseconds);
  measured.error = largest_error(
      exact, query, path ? opening(exact, *path, voxel_size, measured.resolution) : poses);
  return measured;
}

std::optional<double> coarsest_size(double fixed_extent, double moving_extent) {
  const auto [smaller, larger] = std::minmax(fixed_extent, moving_extent);
  const double coarsest = std::min(larger / 16, 0.5 * Lattice::kMaxRelativeSize * smaller);
  if (!(2 * larger / Lattice::kMaxCells < coarsest)) return std::nullopt;
  return coarsest;
}

VoxelAdvice advise_voxel_size(
    const AdviceGoal& goal, double coarsest,
    const std::function<std::optional<SizeMeasure>(double voxel_size)>& measure) {
  constexpr int kSizes = 5, kBetween = kMostSizes - kSizes;
  const ScopedFloatEnvironment environment;
  const bool coarse_is_safe = goal.of == AdviceGoal::Of::kSlowestQuery;
  VoxelAdvice advice;
  std::optional<Tried> coarse, fine;  // the neighbours of the best size
  const auto try_size = [&](double size) {
    const std::optional<SizeMeasure> measured = measure(size);
    if (!measured) {
      advice.too_fine = size;
      fine = Tried{size, std::nullopt};
      return;
    }
    advice.measured.push_back(*measured);
    (goal.holds(*measured) == coarse_is_safe ? coarse : fine) = Tried{size, goal.value(*measured)};
  };
  for (int i = 0; i < kSizes && !fine; ++i) {
    try_size(two_digits(coarsest / (1 << 2 * i), coarse_is_safe));
  }
  for (int i = 0; i < kBetween && coarse && fine; ++i) {
    const double size = two_digits(between(*coarse, *fine, goal.limit), coarse_is_safe);
    if (size <= fine->size || size >= coarse->size) break;
    try_size(size);
  }
  std::ranges::sort(advice.measured, std::greater{}, &SizeMeasure::voxel_size);
  for (std::size_t i = 0; i < advice.measured.size(); ++i) {
    const bool is_better = coarse_is_safe || !advice.recommended;
    if (is_better && goal.holds(advice.measured[i])) advice.recommended = i;
  }
  return advice;
}

}  // namespace ist
