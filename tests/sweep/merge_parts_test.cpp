// The merge of all parts into one table: the order of rows, the checks, and no half-written file.

#include "sweep/merge_parts.h"

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "ist/base/checksum.h"
#include "support/errors.h"
#include "sweep/npy_file.h"
#include "sweep/start_mark.h"
#include "sweep/sweep_case.h"
#include "sweep/sweep_record.h"

namespace ist::test {
namespace {

using Merge = SweepTest;
using Numbers = std::vector<std::uint64_t>;

std::string rows_of(const SweepFolder& folder, const RowLayout& layout) {
  std::string rows = npy_header(layout, folder.identity().rows);
  for (std::uint64_t part = 0; part < folder.identity().parts(); ++part) {
    const std::string bytes = file_content(folder.part_file(part));
    rows += bytes.substr(npy_header(layout, folder.identity().rows_of(part)).size());
  }
  return rows;
}

TEST_F(Merge, HasAllRowsInOrder) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  for (const std::uint64_t part : {2U, 0U, 1U}) job.run_part(parts, part, 1);
  const MergeResult merged = merge_parts(parts, job.layout(), TableCheck::kSize);
  EXPECT_EQ(merged.outcome, MergeOutcome::kMerged);
  EXPECT_EQ(merged.rows, 10U);
  EXPECT_EQ(file_content(parts.path() / "rows.npy"), rows_of(parts, job.layout()));
}

TEST_F(Merge, TheManifestHasEveryChecksum) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  run_all(job, parts);
  merge_parts(parts, job.layout(), TableCheck::kSize);
  const auto manifest = nlohmann::json::parse(file_content(parts.path() / "manifest.json"));
  EXPECT_EQ(manifest["sweep"], job.identity().hash);
  EXPECT_EQ(manifest["rows"], 10);
  EXPECT_EQ(manifest["parts"], 3);
  EXPECT_EQ(manifest["xxh3_128"]["rows.npy"], hash_of_file(parts.path() / "rows.npy"));
  for (std::uint64_t part = 0; part < 3; ++part) {
    EXPECT_EQ(manifest["xxh3_128"]["parts"][part], hash_of_file(parts.part_file(part)));
  }
  EXPECT_EQ(file_content(parts.path() / "manifest.json").find("seconds"), std::string::npos);
}

TEST_F(Merge, AMissingPartIsNamedAndNothingWritten) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  job.run_part(parts, 1, 1);
  for (int start = 1; start <= 3; ++start) std::ofstream(parts.mark_file(2, start)).flush();
  const MergeResult merged = merge_parts(parts, job.layout(), TableCheck::kSize);
  EXPECT_EQ(merged.outcome, MergeOutcome::kIncomplete);
  EXPECT_EQ(merged.rows, 0U);
  EXPECT_EQ(merged.missing, Numbers{0});
  EXPECT_EQ(merged.given_up, Numbers{2});
  EXPECT_FALSE(std::filesystem::exists(parts.path() / "rows.npy"));
  EXPECT_FALSE(std::filesystem::exists(parts.path() / "manifest.json"));
}

TEST_F(Merge, DamagedPartsAreRefused) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  run_all(job, parts);
  const std::string sound = file_content(parts.part_file(1));
  const std::size_t header = npy_header(job.layout(), 4).size();
  for (const std::size_t at : {std::size_t{3}, header, header + 8, sound.size() - 1}) {
    std::string bad = sound;
    bad[at] = static_cast<char>(bad[at] ^ 1);
    std::ofstream(parts.part_file(1), std::ios::binary) << bad;
    const auto error = error_of([&] { merge_parts(parts, job.layout(), TableCheck::kSize); });
    ASSERT_TRUE(error) << at;
    EXPECT_EQ(error->code(), ErrorCode::kInputInvalid);
    EXPECT_NE(std::string(error->what()).find("part-000001.npy"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(parts.path() / "rows.npy"));
  }
}

// The rows of part 0 belong to other poses, and its record has their checksum.
TEST_F(Merge, RowsOfOtherNumbersAreRefused) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  run_all(job, parts);
  PartRecord record = read_part_record(parts.record_file(0));
  std::filesystem::copy_file(parts.part_file(1), parts.part_file(0),
                             std::filesystem::copy_options::overwrite_existing);
  record.checksum = hash_of_file(parts.part_file(0));
  std::ofstream(parts.record_file(0)) << json_of(record);
  ASSERT_EQ(parts.verify(0).state, PartState::kDone);
  EXPECT_EQ(error_name([&] { merge_parts(parts, job.layout(), TableCheck::kSize); }),
            "input-invalid");
}

TEST_F(Merge, OfNoRowsIsATableOfNone) {
  const Sweep job = sweep_with("count = 10", "count = 0");
  const SweepFolder parts = folder(job);
  EXPECT_EQ(merge_parts(parts, job.layout(), TableCheck::kSize).outcome, MergeOutcome::kMerged);
  EXPECT_EQ(file_content(parts.path() / "rows.npy"), npy_header(job.layout(), 0));
}

TEST_F(Merge, ThatTheCallerEndsLeavesNoFile) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  run_all(job, parts);
  const std::size_t before = names_in(parts.path()).size();
  EXPECT_EQ(error_name([&] {
              merge_parts(parts, job.layout(), TableCheck::kSize, [](double) { return false; });
            }),
            "cancelled");
  EXPECT_EQ(names_in(parts.path()).size(), before);
}

class TableThere : public SweepTest {
 protected:
  TableThere() { run_all(job_, parts_); }
  [[nodiscard]] MergeOutcome merge(TableCheck check) const {
    return merge_parts(parts_, job_.layout(), check).outcome;
  }
  [[nodiscard]] std::filesystem::path file(const char* name) const { return parts_.path() / name; }

  const Sweep job_ = sweep();
  const SweepFolder parts_ = folder(job_);
};

TEST_F(TableThere, IsNotMergedAgain) {
  EXPECT_EQ(merge(TableCheck::kSize), MergeOutcome::kMerged);
  const std::vector<std::string> names = names_in(parts_.path());
  const auto written = std::filesystem::last_write_time(file("rows.npy"));
  for (const TableCheck check : {TableCheck::kSize, TableCheck::kChecksum}) {
    const MergeResult again = merge_parts(parts_, job_.layout(), check);
    EXPECT_EQ(again.outcome, MergeOutcome::kWasThere);
    EXPECT_EQ(again.rows, 10U);
  }
  EXPECT_EQ(std::filesystem::last_write_time(file("rows.npy")), written);
  EXPECT_EQ(names_in(parts_.path()), names);
}

TEST_F(TableThere, ThatIsNotWholeIsMergedAgain) {
  EXPECT_EQ(merge(TableCheck::kSize), MergeOutcome::kMerged);
  const std::string rows = file_content(file("rows.npy")),
                    manifest = file_content(file("manifest.json"));
  const auto mends = [&](TableCheck check) {
    EXPECT_EQ(merge(check), MergeOutcome::kMerged);
    EXPECT_EQ(file_content(file("rows.npy")), rows);
    EXPECT_EQ(file_content(file("manifest.json")), manifest);
  };
  std::filesystem::remove(file("rows.npy"));
  mends(TableCheck::kSize);
  std::filesystem::resize_file(file("rows.npy"), rows.size() - 1);
  mends(TableCheck::kSize);
  std::filesystem::remove(file("manifest.json"));
  mends(TableCheck::kSize);
  std::string other = manifest;
  other[manifest.rfind('"') - 1] = other[manifest.rfind('"') - 1] == '0' ? '1' : '0';
  for (const std::string& text : {std::string(), std::string("{}"), other}) {
    std::ofstream(file("manifest.json")) << text;
    mends(TableCheck::kSize);
  }
  std::string bad = rows;
  bad.back() = static_cast<char>(bad.back() ^ 1);
  std::ofstream(file("rows.npy"), std::ios::binary) << bad;
  EXPECT_EQ(merge(TableCheck::kSize), MergeOutcome::kWasThere);
  mends(TableCheck::kChecksum);
}

TEST_F(TableThere, AMergeWaitsForNoOther) {
  const MergeMark mark(parts_);
  ASSERT_TRUE(mark.is_held());
  EXPECT_EQ(merge(TableCheck::kSize), MergeOutcome::kBusy);
  EXPECT_FALSE(std::filesystem::exists(file("rows.npy")));
  const auto error = error_of([&] { fail_merging(parts_); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kPartBusy);
}

// A process that is killed leaves its mark without the lock.
TEST_F(TableThere, AMarkWithoutALockIsTakenOver) {
  std::ofstream(file("rows.start")).flush();
  EXPECT_EQ(merge(TableCheck::kSize), MergeOutcome::kMerged);
  EXPECT_FALSE(std::filesystem::exists(file("rows.start")));
}

TEST_F(TableThere, ManyMergesAtATimeMakeOneTable) {
  std::atomic<int> merged{0}, others{0};
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 8; ++i) {
      threads.emplace_back(
          [&] { ++(merge(TableCheck::kSize) == MergeOutcome::kMerged ? merged : others); });
    }
  }
  EXPECT_EQ(merged, 1);
  EXPECT_EQ(others, 7);
  EXPECT_EQ(file_content(file("rows.npy")), rows_of(parts_, job_.layout()));
  EXPECT_FALSE(std::filesystem::exists(file("rows.start")));
}

TEST(Checksum, TextIsXxh3Of128Bits) {
  // xxhsum -H2 of an empty file, and of "abc".
  EXPECT_EQ(Checksum().text(), "99aa06d3014798d86001c324468d497f");
  Checksum hash;
  hash.add("a", 1);
  hash.add("bc", 2);
  EXPECT_EQ(hash.text(), "06b05ab6733a618578af5f94892f3950");
}

}  // namespace
}  // namespace ist::test
