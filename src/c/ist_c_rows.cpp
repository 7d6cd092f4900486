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

struct RowsAsked {
  RowQuestions questions;
  std::size_t threads = 0;
  double stiffness = 1;
  Follower follower;
};

RowsAsked read_rows_options(Call& call, const ist_rows_options* given) {
  const ist_rows_options known = read_sized(call, "options", given);
  if (known.questions <= 0 || (known.questions & ~kAllQuestions) != 0) {
    call.fail(IST_ARGUMENT_INVALID, "options->questions is {}: pass a sum of IST_ASK_...",
              known.questions);
  }
  check_threads(call, "options->threads", known.threads);
  check_tolerance(call, "options->tolerance", known.tolerance);
  check_finite(call, "options->stiffness", known.stiffness);
  RowsAsked asked;
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
  asked.follower = read_follower(call, known.progress);
  return asked;
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
  return guarded(__func__, [&](Call& call) {
    call.need_array("rows", rows, count);
    call.need_array("poses", poses, count);
    call.need("options", options);
    const RowsAsked asked = read_rows_options(call, options);
    const Held<QueryObject> held(call, "query", query);
    if (!held) return;
    if (asked.questions.contacts && !gives_contacts(call, *held)) return;
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
  });
}
