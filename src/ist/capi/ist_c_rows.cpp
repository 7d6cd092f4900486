#include <cmath>
#include <limits>
#include <vector>

#include "ist/capi/follower.h"
#include "ist/capi/ist_measure.h"
#include "ist/capi/measure_answers.h"
#include "ist/capi/objects.h"
#include "ist/measure/pose_rows.h"

namespace ist::capi {
namespace {

constexpr std::int32_t kAllQuestions = IST_ASK_INTERSECTS | IST_ASK_LEAF_PAIRS | IST_ASK_DISTANCE |
                                       IST_ASK_CONTACTS | IST_ASK_PENETRATION;
constexpr std::int32_t kMostThreads = 1024;

struct RowsAsked {
  RowQuestions questions;
  std::size_t threads = 0;
  double stiffness = 1;
  Follower follower;
};

ist_status read_rows_options(const Call& call, const ist_rows_options& given, RowsAsked& asked) {
  ist_rows_options known;
  if (const ist_status wrong = read_sized(call, "options", given, known)) return wrong;
  if (known.questions <= 0 || (known.questions & ~kAllQuestions) != 0) {
    return call.fail(IST_ARGUMENT_INVALID, "options->questions is {}: pass a sum of IST_ASK_...",
                     known.questions);
  }
  if (known.threads < 0 || known.threads > kMostThreads) {
    return call.fail(IST_ARGUMENT_INVALID,
                     "options->threads is {}: pass 1 to {}, or 0 for one for each core",
                     known.threads, kMostThreads);
  }
  if (!(known.tolerance >= 0)) {
    return call.fail(IST_ARGUMENT_INVALID, "options->tolerance is {}: pass a number of at least 0",
                     known.tolerance);
  }
  if (!std::isfinite(known.stiffness)) {
    return call.fail(IST_ARGUMENT_INVALID, "options->stiffness is {}: pass a finite number",
                     known.stiffness);
  }
  RowQuestions& questions = asked.questions;
  questions.intersects = (known.questions & IST_ASK_INTERSECTS) != 0;
  questions.leaf_pairs = (known.questions & IST_ASK_LEAF_PAIRS) != 0;
  questions.distance = (known.questions & IST_ASK_DISTANCE) != 0;
  questions.contacts = (known.questions & IST_ASK_CONTACTS) != 0;
  questions.penetration = (known.questions & IST_ASK_PENETRATION) != 0;
  questions.tolerance = known.tolerance;
  if (known.tests > 0) questions.budget.tests = known.tests;
  asked.threads = static_cast<std::size_t>(known.threads);
  if (known.stiffness != 0) asked.stiffness = known.stiffness;
  return read_follower(call, known.progress, asked.follower);
}

ist_row row_of(const PoseRow& found, double stiffness) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  ist_row row{};
  row.distance_lower = row.distance_upper = row.depth_lower = row.depth_upper = kNone;
  if (found.status != QueryStatus::kDone) {
    row.status = IST_POSE_INVALID;
    return row;
  }
  bool complete = true;
  const auto count = [&](const auto& answer) {
    complete = complete && answer.complete;
    row.sphere_tests += answer.sphere_tests;
  };
  if (found.intersects) {
    count(*found.intersects);
    row.intersects = static_cast<std::int32_t>(found.intersects->answer) + IST_ANSWER_NO;
  }
  if (found.leaf_pairs) {
    count(*found.leaf_pairs);
    row.leaf_pairs = found.leaf_pairs->leaf_pairs;
  }
  if (found.distance) {
    count(*found.distance);
    row.distance_lower = found.distance->distance.lower;
    row.distance_upper = found.distance->distance.upper;
  }
  if (found.contacts) {
    count(*found.contacts);
    if (!found.leaf_pairs) row.leaf_pairs = found.contacts->leaf_pairs;
    row.area = found.sums.weight;
    copy(stiffness * found.sums.spring.force, row.force);
    copy(stiffness * found.sums.spring.torque, row.torque);
  }
  if (found.penetration) {
    complete = complete && found.penetration->complete;
    row.not_closed = not_closed_of(*found.penetration);
    if (row.not_closed == IST_CLOSED) {
      row.depth_lower = found.penetration->lower;
      row.depth_upper = found.penetration->upper;
    }
  }
  row.complete = complete;
  return row;
}

}  // namespace
}  // namespace ist::capi

using namespace ist::capi;

ist_status ist_query_rows(ist_query* query, const double* poses, size_t count,
                          const ist_rows_options* options, ist_row* rows) IST_NOEXCEPT {
  return guarded(__func__, [&](const Call& call) -> ist_status {
    if (const ist_status missing = call.need_array("rows", rows, count)) return missing;
    if (const ist_status missing = call.need_array("poses", poses, count)) return missing;
    if (const ist_status missing = call.need({{"options", options}})) return missing;
    RowsAsked asked;
    if (const ist_status wrong = read_rows_options(call, *options, asked)) return wrong;
    const Held<QueryObject> held(call, "query", query);
    if (held.status() != IST_OK) return held.status();
    if (asked.questions.contacts && !held->manifold) return not_prepared(call);
    std::vector<Eigen::Isometry3d> at(count);
    for (std::size_t i = 0; i < count; ++i) at[i] = to_isometry(poses + 16 * i);
    ist::QueryOptions further = held->query_options;
    further.workers = 1;
    further.front_pairs = 0;
    std::vector<ist_row> made(count);
    const bool whole = followed(asked.follower, [&](const ist::Proceed& proceed) {
      ist::answer_rows(
          {held->query, further, held->contact_options}, at, asked.questions, asked.threads,
          [&](std::size_t index, const ist::PoseRow& row) {
            made[index] = row_of(row, asked.stiffness);
          },
          proceed);
    });
    if (!whole) return cancelled(call);
    std::copy(made.begin(), made.end(), rows);
    return IST_OK;
  });
}
