// The merge of all parts into one table: the order of rows, the checks, and no half-written file.

#include "sweep/merge_parts.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ist/base/checksum.h"
#include "support/errors.h"
#include "sweep/npy_file.h"
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
  const MergeResult merged = merge_parts(parts, job.layout());
  EXPECT_TRUE(merged.whole());
  EXPECT_EQ(merged.rows, 10U);
  EXPECT_EQ(file_content(parts.path() / "rows.npy"), rows_of(parts, job.layout()));
}

TEST_F(Merge, TheManifestHasEveryChecksum) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  run_all(job, parts);
  merge_parts(parts, job.layout());
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
  const MergeResult merged = merge_parts(parts, job.layout());
  EXPECT_FALSE(merged.whole());
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
    const auto error = error_of([&] { merge_parts(parts, job.layout()); });
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
  EXPECT_EQ(error_name([&] { merge_parts(parts, job.layout()); }), "input-invalid");
}

TEST_F(Merge, OfNoRowsIsATableOfNone) {
  const Sweep job = sweep_with("count = 10", "count = 0");
  const SweepFolder parts = folder(job);
  EXPECT_TRUE(merge_parts(parts, job.layout()).whole());
  EXPECT_EQ(file_content(parts.path() / "rows.npy"), npy_header(job.layout(), 0));
}

TEST_F(Merge, ThatTheCallerEndsLeavesNoFile) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  run_all(job, parts);
  const std::size_t before = names_in(parts.path()).size();
  EXPECT_EQ(error_name([&] { merge_parts(parts, job.layout(), [](double) { return false; }); }),
            "cancelled");
  EXPECT_EQ(names_in(parts.path()).size(), before);
}

TEST_F(Merge, CanBeMadeAgain) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  run_all(job, parts);
  merge_parts(parts, job.layout());
  const std::string rows = file_content(parts.path() / "rows.npy");
  const std::string manifest = file_content(parts.path() / "manifest.json");
  merge_parts(parts, job.layout());
  EXPECT_EQ(file_content(parts.path() / "rows.npy"), rows);
  EXPECT_EQ(file_content(parts.path() / "manifest.json"), manifest);
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
