#include "ist/query/advice/calibration.h"

#include <algorithm>
#include <utility>

#include "ist/base/assert.h"
#include "ist/query/advice/contact_error.h"
#include "ist/tree/tree_builder.h"

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

std::uint64_t most_contacts(CollisionQuery& query, const std::vector<Eigen::Isometry3d>& poses) {
  std::uint64_t most = 0;
  for (const Eigen::Isometry3d& pose : poses) {
    most = std::max(most, query.collide(pose, std::span<Contact>{}).contacts);
  }
  return most;
}

// Microseconds.
double slowest_query(CollisionQuery& query, const std::vector<Eigen::Isometry3d>& poses,
                     std::uint64_t room, const CalibrationOptions& options, Progress& progress) {
  constexpr std::size_t kLeastRounds = 5;
  std::vector<Contact> contacts(room + 1);
  std::vector<std::vector<double>> times(poses.size());
  progress.begin_stage("timing answers", options.rounds);
  const Clock::time_point end = Clock::now() + options.time;
  for (std::size_t round = 0;
       round < kLeastRounds || (round < options.rounds && Clock::now() < end); ++round) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Clock::time_point begin = Clock::now();
      static_cast<void>(query.collide(poses[i], contacts));
      times[i].push_back(microseconds(Clock::now() - begin));
    }
    progress.add(1);
  }
  double slowest = 0;
  for (std::vector<double>& of_pose : times) slowest = std::max(slowest, median(of_pose));
  return slowest;
}

}  // namespace

Calibration::Calibration(ExactBodies& bodies, const ClosingPath& path,
                         const CalibrationOptions& options)
    : bodies_(bodies),
      paths_(paths_beside(bodies, path)),
      poses_(path.poses(kPoses)),
      options_(options) {
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
  build.max_memory = options_.max_memory;
  if (!can_build_tree(bodies_.fixed(), build, &shown) ||
      !can_build_tree(bodies_.moving(), build, &shown)) {
    return std::nullopt;
  }
  const Clock::time_point begin = Clock::now();
  const SphereTree fixed = build_tree(bodies_.fixed(), build, nullptr, &shown);
  const SphereTree moving = build_tree(bodies_.moving(), build, nullptr, &shown);
  SizeMeasure measured;
  measured.build_milliseconds = 1e-3 * microseconds(Clock::now() - begin);
  measured.voxel_size = voxel_size;
  measured.bytes = fixed.bytes() + moving.bytes();

  CollisionOptions options;
  options.target = options_.target;
  options.workers = options_.workers;
  options.period = {};  // one query follows the other
  CollisionQuery query(fixed, moving, options);
  measured.resolution = query.resolution(query.collide(poses_.front(), std::span<Contact>{}));
  measured.most_contacts = most_contacts(query, poses_);
  measured.slowest_query = slowest_query(query, poses_, measured.most_contacts, options_, shown);
  shown.begin_stage("comparing with triangles", paths_.size());
  if (paths_.empty()) measured.error = error_at_poses(bodies_, query, poses_);
  for (const ClosingPath& path : paths_) {
    measured.error = std::max(measured.error, closing_error(bodies_, query, voxel_size, path));
    shown.add(1);
  }
  return measured;
}

}  // namespace ist
