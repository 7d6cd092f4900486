#include "advise/calibration.h"

#include <algorithm>
#include <utility>

#include "ist/base/assert.h"
#include "ist/base/float_environment.h"
#include "ist/tree/sphere_tree.h"

namespace ist {
namespace {

using Clock = std::chrono::steady_clock;

double microseconds(Clock::duration time) {
  return std::chrono::duration<double, std::micro>(time).count();
}

double median(std::vector<double>& times) {
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  return *middle;
}

std::uint64_t max_leaf_pairs(Query& query, const std::vector<Eigen::Isometry3d>& poses) {
  std::uint64_t most = 0;
  for (const Eigen::Isometry3d& pose : poses) {
    most = std::max(most, query.leaf_pairs(pose, std::span<LeafPair>{}).leaf_pairs);
  }
  return most;
}

// Returns the median at the slowest pose, microseconds.
double slowest_query(Query& query, const std::vector<Eigen::Isometry3d>& poses, std::uint64_t room,
                     const CalibrationOptions& options, Progress& progress) {
  constexpr std::size_t kLeastRounds = 5;
  std::vector<LeafPair> leaf_pairs(room + 1);
  std::vector<std::vector<double>> times(poses.size());
  progress.begin_stage("timing queries", options.rounds);
  const Clock::time_point end = options.now() + options.time;
  for (std::size_t round = 0;
       round < kLeastRounds || (round < options.rounds && options.now() < end); ++round) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Clock::time_point begin = options.now();
      static_cast<void>(query.leaf_pairs(poses[i], leaf_pairs));
      times[i].push_back(microseconds(options.now() - begin));
    }
    progress.add(1);
  }
  double slowest = 0;
  for (std::vector<double>& of_pose : times) slowest = std::max(slowest, median(of_pose));
  return slowest;
}

constexpr int kHalvings = 16;

bool has_leaf_pairs(Query& query, const Eigen::Isometry3d& pose) {
  return query.leaf_pairs(pose, std::span<LeafPair>{}).leaf_pairs > 0;
}

// Bisects the straight way from a pose with leaf pairs to one without, down to 2^-16 of its length;
// returns its end with leaf pairs.
Eigen::Isometry3d first_contact(Query& query, Eigen::Isometry3d with, Eigen::Isometry3d without) {
  for (int i = 0; i < kHalvings; ++i) {
    Eigen::Isometry3d middle = with;
    middle.translation() = 0.5 * (with.translation() + without.translation());
    (has_leaf_pairs(query, middle) ? with : without) = middle;
  }
  return with;
}

}  // namespace

double closing_error(ExactBodies& bodies, Query& query, double voxel_size,
                     const ClosingPath& path) {
  constexpr double kStep = 1.0 / 16, kOfTheWay = 1.0 / 64, kTolerance = 0x1p-10;
  const ScopedFloatEnvironment environment;
  const double tolerance = kTolerance * voxel_size;
  const auto next = [&](double offset) {
    return offset + std::max(kStep * voxel_size, kOfTheWay * (offset - path.first_contact));
  };
  double error = 0, last = path.first_contact;
  for (double offset = next(path.first_contact);; offset = next(offset)) {
    const DistanceInterval distance = bodies.distance(path.pose(offset), tolerance);
    if (!(distance.upper > 0)) break;
    const QueryResult result = query.leaf_pairs(path.pose(offset), std::span<LeafPair>{});
    if (result.leaf_pairs > 0) {
      error = std::max(error, distance.upper);
      last = offset;
    } else if (distance.lower > result.resolution) {
      break;
    }
  }
  const Eigen::Isometry3d first = first_contact(query, path.pose(last), path.pose(next(last)));
  return std::max(error, bodies.distance(first, tolerance).upper);
}

double error_at_poses(ExactBodies& bodies, Query& query, std::span<const Eigen::Isometry3d> poses) {
  const ScopedFloatEnvironment environment;
  double error = 0;
  std::vector<bool> leaf_pairs;
  for (const Eigen::Isometry3d& pose : poses) {
    leaf_pairs.push_back(has_leaf_pairs(query, pose));
    if (leaf_pairs.back()) error = std::max(error, bodies.distance(pose, 0).upper);
  }
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (leaf_pairs[i] == leaf_pairs[i - 1] || poses[i].linear() != poses[i - 1].linear()) continue;
    const std::size_t with = leaf_pairs[i] ? i : i - 1, without = leaf_pairs[i] ? i - 1 : i;
    const Eigen::Isometry3d first = first_contact(query, poses[with], poses[without]);
    error = std::max(error, bodies.distance(first, 0).upper);
  }
  return error;
}

Calibration::Calibration(ExactBodies& bodies, const ClosingPath& path,
                         const CalibrationOptions& options)
    : bodies_(bodies), paths_(paths_beside(bodies, path)), poses_(path.poses()), options_(options) {
  paths_.push_back(path);
}

Calibration::Calibration(ExactBodies& bodies, std::vector<Eigen::Isometry3d> poses,
                         const CalibrationOptions& options)
    : bodies_(bodies), poses_(std::move(poses)), options_(options) {
  IST_ASSERT(!poses_.empty());
}

std::optional<SizeMeasure> Calibration::measure(double voxel_size, Progress* progress) {
  Progress unseen;
  Progress& shown = progress != nullptr ? *progress : unseen;
  BuildOptions build;
  build.voxel_size = voxel_size;
  build.keep_triangles = false;
  build.max_memory = options_.max_memory;
  if (!can_build_tree(bodies_.fixed(), build, &shown) ||
      !can_build_tree(bodies_.moving(), build, &shown)) {
    return std::nullopt;
  }
  const Clock::time_point begin = options_.now();
  const SphereTree fixed = build_tree(bodies_.fixed(), build, nullptr, &shown);
  const SphereTree moving = build_tree(bodies_.moving(), build, nullptr, &shown);
  SizeMeasure measured;
  measured.build_milliseconds = 1e-3 * microseconds(options_.now() - begin);
  measured.voxel_size = voxel_size;
  measured.bytes = fixed.bytes() + moving.bytes();

  QueryOptions options;
  options.target = options_.target;
  options.workers = options_.workers;
  options.period = {};  // one query follows the other
  Query query(fixed, moving, options);
  measured.resolution = query.leaf_pairs(poses_.front(), std::span<LeafPair>{}).resolution;
  measured.max_leaf_pairs = max_leaf_pairs(query, poses_);
  measured.slowest_query = slowest_query(query, poses_, measured.max_leaf_pairs, options_, shown);
  shown.begin_stage("comparing with triangles", paths_.size());
  if (paths_.empty()) measured.error = error_at_poses(bodies_, query, poses_);
  for (const ClosingPath& path : paths_) {
    measured.error = std::max(measured.error, closing_error(bodies_, query, voxel_size, path));
    shown.add(1);
  }
  return measured;
}

}  // namespace ist
