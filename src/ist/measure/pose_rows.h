#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <span>

#include "ist/base/api.h"
#include "ist/base/progress.h"
#include "ist/measure/penetration.h"
#include "ist/query/manifold.h"
#include "ist/query/query.h"

namespace ist {

/// The questions that are asked at every pose.
struct RowQuestions {
  bool intersects = false, leaf_pairs = false, distance = false, contacts = false,
       penetration = false;
  double tolerance = 0;  ///< of distances and depths, mesh units
  Budget budget = {};    ///< of each search of bounds or triangles; tests alone
};

/// The answers at one pose; empty where nothing was asked.
struct PoseRow {
  QueryStatus status = QueryStatus::kDone;
  std::optional<IntersectionResult> intersects = std::nullopt;
  std::optional<QueryResult> leaf_pairs = std::nullopt;  ///< counted
  std::optional<DistanceResult> distance = std::nullopt;
  std::optional<QueryResult> contacts = std::nullopt;
  ContactSums sums = {};
  std::optional<Penetration> penetration = std::nullopt;
  double rotation_error = 0;  ///< of the given pose (rotation_error())
};

/// A query, and the options of those that further threads make.
struct RowSearch {
  Query& query;  ///< the calling thread's, which forgets what earlier poses left
  QueryOptions query_options;
  ManifoldOptions manifold_options;
};

/// Answers the same questions at many poses, on several threads: each answer is that of a query
/// that has just forgotten all earlier ones, so that rows depend neither on each other nor on the
/// threads.
///
/// @param give    takes the row of a pose, by its index; called from all threads, once for each
/// pose
/// @param threads the most threads, of all loops of the process meanwhile; 0: one for each core
/// @param proceed asked every 20 ms, or every few poses where these take longer; false ends the
/// call
///
/// Returns whether all rows were given. Throws kTrianglesMissing, kVoxelsMissing, kArgumentInvalid
/// (tolerance), kMemoryLimit. Cost: that of the verbs; each further thread makes a query of its
/// own, a few ms.
IST_LOOP_API bool answer_rows(
    const RowSearch& search, std::span<const Eigen::Isometry3d> poses,
    const RowQuestions& questions, std::size_t threads,
    const std::function<void(std::size_t index, const PoseRow& row)>& give,
    const Proceed& proceed = {});

}  // namespace ist
