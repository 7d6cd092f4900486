#include <cmath>
#include <vector>

#include "c/follower.h"
#include "c/objects.h"
#include "ist/capi/ist_measure.h"
#include "ist/measure/pose_rows.h"
#include "ist/measure/row_numbers.h"

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

ist_row row_of(const RowNumbers& numbers) noexcept {
  ist_row row{};
  row.status = numbers.pose_is_valid ? IST_OK : IST_POSE_INVALID;
  row.intersects = numbers.intersects;
  row.complete = numbers.complete;
  row.not_closed = numbers.not_closed;
  row.leaf_pairs = numbers.leaf_pairs;
  row.sphere_tests = numbers.sphere_tests;
  row.distance_lower = numbers.distance_lower;
  row.distance_upper = numbers.distance_upper;
  row.depth_lower = numbers.depth_lower;
  row.depth_upper = numbers.depth_upper;
  row.area = numbers.area;
  copy(numbers.force, row.force);
  copy(numbers.torque, row.torque);
  row.rotation_error = numbers.rotation_error;
  row.self_intersecting = numbers.self_intersecting;
  row.capped = numbers.capped;
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
    if (asked.questions.contacts) {
      if (const ist_status wrong = need_contacts(call, *held)) return wrong;
    }
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
            made[index] = row_of(ist::numbers_of(row, asked.stiffness));
          },
          proceed);
    });
    if (!whole) return cancelled(call);
    std::copy(made.begin(), made.end(), rows);
    return IST_OK;
  });
}
