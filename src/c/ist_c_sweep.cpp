#include <cstring>
#include <optional>
#include <vector>

#include "c/objects.h"
#include "ist/capi/ist_sweep.h"
#include "sweep/merge_parts.h"
#include "sweep/sweep.h"

namespace ist::capi {
namespace {

struct SweepObject : OfHandle<ist_sweep, HandleKind::kSweep, HandleUse::kShared> {
  explicit SweepObject(const char* path) : sweep(path) {}
  Sweep sweep;
};

static_assert(static_cast<int>(PartState::kMissing) + IST_PART_MISSING == IST_PART_MISSING &&
              static_cast<int>(PartState::kDone) + IST_PART_MISSING == IST_PART_DONE &&
              static_cast<int>(PartState::kGivenUp) + IST_PART_MISSING == IST_PART_GIVEN_UP &&
              static_cast<int>(PartState::kDamaged) + IST_PART_MISSING == IST_PART_DAMAGED);
static_assert(static_cast<int>(ColumnType::kUint64) + IST_COLUMN_UINT64 == IST_COLUMN_UINT64 &&
              static_cast<int>(ColumnType::kInt32) + IST_COLUMN_UINT64 == IST_COLUMN_INT32 &&
              static_cast<int>(ColumnType::kFloat64) + IST_COLUMN_UINT64 == IST_COLUMN_FLOAT64);

template <std::size_t kSize>
void copy_text(const std::string& from, char (&to)[kSize]) {
  std::strncpy(to, from.c_str(), kSize - 1);
}

ist_sweep_info sweep_info_of(const SweepObject& object) {
  const Sweep& sweep = object.sweep;
  ist_sweep_info info{};
  info.rows = sweep.rows();
  info.rows_per_part = sweep.identity().rows_per_part;
  info.parts = sweep.parts();
  info.row_bytes = sweep.layout().bytes;
  info.columns = sweep.layout().columns.size();
  copy_text(sweep.identity().hash, info.hash);
  return info;
}

SweepFolder folder_of(const Sweep& sweep, const char* folder, SweepFolder::Access access) {
  return {folder, sweep.identity(), sweep.layout(), access};
}

ist_sweep_part part_of(const SweepFolder& folder, std::uint64_t part, const PartStatus& status) {
  ist_sweep_part result{};
  result.state = static_cast<std::int32_t>(status.state) + IST_PART_MISSING;
  result.starts = status.starts;
  result.rows = folder.identity().rows_of(part);
  result.seconds = status.seconds;
  return result;
}

void fail_part(Call& call, std::uint64_t part, std::uint64_t parts) {
  call.fail(IST_ARGUMENT_INVALID, "part is {}, and the sweep has {}: pass a smaller number", part,
            parts);
}

}  // namespace
}  // namespace ist::capi

using namespace ist::capi;

ist_status ist_sweep_open(const char* path, const ist_progress* progress,
                          ist_sweep** sweep) IST_NOEXCEPT {
  return read_object<SweepObject>(__func__, path, progress, sweep,
                                  [](const char* file) { return file; });
}

ist_status ist_sweep_free(ist_sweep* sweep) IST_NOEXCEPT {
  return give_back<SweepObject>(__func__, sweep);
}

ist_status ist_sweep_get_info(const ist_sweep* sweep, ist_sweep_info* info) IST_NOEXCEPT {
  return get_info<SweepObject>(__func__, sweep, info, sweep_info_of);
}

ist_status ist_sweep_get_column(const ist_sweep* sweep, uint64_t column,
                                ist_sweep_column* info) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    clear_sized(call, "info", info);
    const Held<SweepObject> held(call, "sweep", sweep);
    if (!held) return;
    const auto& columns = held->sweep.layout().columns;
    if (column >= columns.size()) {
      return call.fail(IST_ARGUMENT_INVALID,
                       "column is {}, and a row has {}: pass a smaller number", column,
                       columns.size());
    }
    const ist::Column& known = columns[column];
    ist_sweep_column made{};
    copy_text(known.name, made.name);
    made.type = static_cast<std::int32_t>(known.type) + IST_COLUMN_UINT64;
    made.offset = known.offset;
    write_sized(made, *info);
  });
}

ist_status ist_sweep_get_poses(const ist_sweep* sweep, uint64_t first, size_t count,
                               double* poses) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    call.need_array("poses", poses, count);
    const Held<SweepObject> held(call, "sweep", sweep);
    if (!held) return;
    const std::uint64_t rows = held->sweep.rows();
    if (first > rows || count > rows - first) {
      return call.fail(IST_ARGUMENT_INVALID,
                       "first is {} and count is {}, and the sweep has {} poses: pass fewer", first,
                       count, rows);
    }
    std::vector<Eigen::Isometry3d> made(count);
    held->sweep.poses(first, made);
    for (std::size_t i = 0; i < count; ++i) {
      std::memcpy(poses + 16 * i, made[i].data(), 16 * sizeof(double));
    }
  });
}

ist_status ist_sweep_run_part(const ist_sweep* sweep, const char* folder, uint64_t part,
                              int32_t threads, const ist_progress* progress,
                              ist_sweep_part* result) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    clear_sized(call, "result", result);
    call.need("folder", folder);
    check_threads(call, "threads", threads);
    const Follower follower = read_follower(call, progress);
    const Held<SweepObject> held(call, "sweep", sweep);
    if (!held) return;
    const ist::Sweep& known = held->sweep;
    if (part >= known.parts()) return fail_part(call, part, known.parts());
    std::optional<ist::SweepFolder> parts;
    auto outcome = ist::Sweep::Outcome::kStopped;
    followed(follower, [&](const ist::Proceed& proceed) {
      parts.emplace(known.open_folder(folder));
      outcome = known.run_part(*parts, part, static_cast<std::size_t>(threads), proceed);
    });
    if (outcome == ist::Sweep::Outcome::kStopped) return cancelled(call);
    // A caller who says stop when the part is there is too late.
    ist_sweep_part made = part_of(*parts, part, parts->look(part));
    made.made = outcome == ist::Sweep::Outcome::kMade;
    write_sized(made, *result);
  });
}

ist_status ist_sweep_get_part(const ist_sweep* sweep, const char* folder, uint64_t part,
                              int32_t verify, ist_sweep_part* result) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    clear_sized(call, "result", result);
    call.need("folder", folder);
    const Held<SweepObject> held(call, "sweep", sweep);
    if (!held) return;
    if (part >= held->sweep.parts()) return fail_part(call, part, held->sweep.parts());
    const ist::SweepFolder parts = folder_of(held->sweep, folder, ist::SweepFolder::Access::kRead);
    write_sized(part_of(parts, part, verify != 0 ? parts.verify(part) : parts.look(part)), *result);
  });
}

ist_status ist_sweep_merge(const ist_sweep* sweep, const char* folder, const ist_progress* progress,
                           ist_sweep_merge_result* result) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    clear_sized(call, "result", result);
    call.need("folder", folder);
    const Follower follower = read_follower(call, progress);
    const Held<SweepObject> held(call, "sweep", sweep);
    if (!held) return;
    // No part has made the folder of a sweep without poses.
    const auto access = held->sweep.parts() == 0 ? ist::SweepFolder::Access::kWrite
                                                 : ist::SweepFolder::Access::kRead;
    std::optional<ist_sweep_merge_result> made;
    followed(follower, [&](const ist::Proceed& proceed) {
      const ist::MergeResult merged =
          ist::merge_parts(folder_of(held->sweep, folder, access), held->sweep.layout(), proceed);
      made =
          ist_sweep_merge_result{0, merged.rows, merged.missing.size(), merged.given_up.size(), 0};
    });
    if (!made) return cancelled(call);
    write_sized(*made, *result);
  });
}
