// The parts of a sweep: their rows, and that they are there and whole or not there.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "ist/measure/row_numbers.h"
#include "support/errors.h"
#include "support/shapes.h"
#include "sweep/npy_file.h"
#include "sweep/start_mark.h"
#include "sweep/sweep_case.h"
#include "sweep/sweep_record.h"

namespace ist::test {
namespace {

using SweepParts = SweepTest;
using Outcome = Sweep::Outcome;

// The rows of a part's file.
std::string rows_in(const SweepFolder& folder, std::uint64_t part, const RowLayout& layout) {
  const std::string bytes = file_content(folder.part_file(part));
  const std::string header = npy_header(layout, folder.identity().rows_of(part));
  EXPECT_EQ(bytes.substr(0, header.size()), header);
  EXPECT_EQ(bytes.size(), folder.bytes_of_part(part));
  return bytes.substr(header.size());
}

TEST_F(SweepParts, HaveTheRowsOfTheSingleCalls) {
  const Sweep job = sweep_with("\"contacts\"", "\"contacts\", \"leaf_pairs\", \"penetration\"");
  const SweepFolder parts = folder(job);
  run_all(job, parts);
  std::string rows;
  for (std::uint64_t part = 0; part < 3; ++part) rows += rows_in(parts, part, job.layout());
  ASSERT_EQ(rows.size(), 10 * job.layout().bytes);
  const SphereTree fixed = read_tree(job.file().fixed.file),
                   moving = read_tree(job.file().moving.file);
  int met = 0;
  for (std::uint64_t i = 0; i < 10; ++i) {
    Eigen::Isometry3d pose;
    job.poses(i, {&pose, 1});
    // Each question by a query that knows no other.
    PoseRow row;
    Query intersects(fixed, moving), pairs(fixed, moving), apart(fixed, moving),
        pushed(fixed, moving), deep(fixed, moving);
    row.intersects = intersects.intersects(pose);
    row.leaf_pairs = pairs.leaf_pairs(pose, std::span<LeafPair>());
    row.distance = apart.distance(pose, 0.01);
    ContactManifold manifold(fixed, moving, pushed.policy(), {.points = 0});
    row.contacts = pushed.contacts(pose, manifold);
    row.sums = manifold.sums();
    row.penetration = penetration(deep, pose, 0.01);
    met += row.intersects->answer == Answer::kYes;
    std::vector<std::byte> known(job.layout().bytes);
    write_row(job.file().questions, {.index = i, .pose = pose}, numbers_of(row, 1), known);
    EXPECT_EQ(std::memcmp(known.data(), rows.data() + i * known.size(), known.size()), 0) << i;
  }
  EXPECT_GT(met, 0);
  EXPECT_LT(met, 10);
}

TEST_F(SweepParts, TheirBytesDependOnNoThread) {
  // More than are computed at a time, so that blocks follow each other.
  const Sweep job =
      sweep(sweep_text("rows_per_part = 4", "rows_per_part = 9000")
                .replace(sweep_text("rows_per_part = 4", "rows_per_part = 9000").find("count = 10"),
                         10, "count = 10001"));
  const SweepFolder one = folder(job, "one"), two = folder(job, "two");
  run_all(job, one, 1);
  run_all(job, two, 2);
  for (std::uint64_t part = 0; part < 2; ++part) {
    EXPECT_EQ(file_content(one.part_file(part)), file_content(two.part_file(part)));
    EXPECT_EQ(one.look(part).checksum, two.look(part).checksum);
  }
  EXPECT_EQ(rows_in(one, 1, job.layout()).size(), 1001 * job.layout().bytes);
  const std::string rows = rows_in(one, 0, job.layout());
  for (std::uint64_t row = 0; row < 9000; ++row) {
    std::uint64_t index = 0;
    std::memcpy(&index, rows.data() + row * job.layout().bytes, sizeof(index));
    ASSERT_EQ(index, row);
  }
}

TEST_F(SweepParts, AreCutByTheSweepFileAlone) {
  struct Cut {
    const char* count;
    std::vector<std::uint64_t> rows;
  };
  for (const Cut& cut : {Cut{"0", {}}, Cut{"1", {1}}, Cut{"3", {3}}, Cut{"4", {4}},
                         Cut{"5", {4, 1}}, Cut{"8", {4, 4}}, Cut{"9", {4, 4, 1}}}) {
    const Sweep job = sweep_with("count = 10", std::string("count = ") + cut.count);
    ASSERT_EQ(job.parts(), cut.rows.size());
    const SweepFolder parts = folder(job, std::string("out") + cut.count);
    run_all(job, parts);
    for (std::uint64_t part = 0; part < job.parts(); ++part) {
      EXPECT_EQ(rows_in(parts, part, job.layout()).size(), cut.rows[part] * job.layout().bytes);
    }
  }
}

TEST_F(SweepParts, ThatAreThereStay) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  run_all(job, parts);
  const auto written = std::filesystem::last_write_time(parts.part_file(1));
  EXPECT_EQ(job.run_part(parts, 1, 1), Outcome::kWasThere);
  EXPECT_EQ(std::filesystem::last_write_time(parts.part_file(1)), written);
}

TEST_F(SweepParts, LeaveOnlyTheirFiles) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  run_all(job, parts);
  EXPECT_EQ(names_in(parts.path()),
            (std::vector<std::string>{"part-000000.json", "part-000000.npy", "part-000001.json",
                                      "part-000001.npy", "part-000002.json", "part-000002.npy",
                                      "sweep.json"}));
  for (const std::string& name : names_in(parts.path())) {
    EXPECT_EQ(file_content(parts.path() / name).find(dir_.path().string()), std::string::npos)
        << name << " holds a path";
  }
}

TEST_F(SweepParts, ThatTheCallerEndsLeaveNoFile) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  EXPECT_EQ(job.run_part(parts, 0, 1, [](double) { return false; }), Outcome::kStopped);
  EXPECT_EQ(names_in(parts.path()), std::vector<std::string>{"sweep.json"});
  // Which is no start that was lost.
  EXPECT_EQ(parts.look(0).starts, 0);
  EXPECT_EQ(job.run_part(parts, 0, 1), Outcome::kMade);
}

TEST_F(SweepParts, SayHowFarTheyAre) {
  const Sweep job =
      sweep(sweep_text("rows_per_part = 4", "rows_per_part = 9000")
                .replace(sweep_text("rows_per_part = 4", "rows_per_part = 9000").find("count = 10"),
                         10, "count = 9000"));
  std::vector<double> said;
  job.run_part(folder(job), 0, 1, [&](double part) {
    said.push_back(part);
    return true;
  });
  ASSERT_GE(said.size(), 3U);
  EXPECT_EQ(said.front(), 0);
  EXPECT_TRUE(std::is_sorted(said.begin(), said.end()));
  EXPECT_GT(said.back(), 8000.0 / 9000);
  EXPECT_LT(said.back(), 1);
}

TEST_F(SweepParts, OfATreeThatChangedAreNotMade) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  write_ball("moving.ist", 1.5);
  const auto error = error_of([&] { job.run_part(parts, 0, 1); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kInputInvalid);
  EXPECT_NE(std::string(error->what()).find("moving.ist changed since the sweep was opened"),
            std::string::npos);
  EXPECT_EQ(names_in(parts.path()), std::vector<std::string>{"sweep.json"});
}

TEST_F(SweepParts, OfPosesThatChangedAreNotMade) {
  std::string file = npy_header({{{"x", ColumnType::kFloat64, 0}}, 8}, 2);
  const std::string text = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 4, 4), }";
  file.replace(10, file.size() - 11, text + std::string(file.size() - 11 - text.size(), ' '));
  std::vector<double> numbers(32, 0);
  for (const std::size_t i : {0U, 5U, 10U, 15U, 16U, 21U, 26U, 31U}) numbers[i] = 1;
  file.append(reinterpret_cast<const char*>(numbers.data()), 256);
  const std::filesystem::path poses = dir_.write("poses.npy", file);
  const Sweep job = sweep(
      sweep_text("[poses.box]", "[poses]\nfile = \"poses.npy\"\n")
          .substr(0, sweep_text("[poses.box]", "[poses]\nfile = \"poses.npy\"\n").find("seed")));
  ASSERT_EQ(job.rows(), 2U);
  const SweepFolder parts = folder(job);
  std::ofstream(poses, std::ios::in | std::ios::out).seekp(200).put('x');
  std::filesystem::last_write_time(
      poses, std::filesystem::last_write_time(poses) + std::chrono::seconds(1));
  EXPECT_EQ(error_name([&] { job.run_part(parts, 0, 1); }), "input-invalid");
  EXPECT_EQ(names_in(parts.path()), std::vector<std::string>{"sweep.json"});
}

TEST_F(SweepParts, ThatAreMadeMeanwhileAreRefused) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  std::string refusal;
  EXPECT_EQ(job.run_part(parts, 0, 1,
                         [&](double) {
                           if (refusal.empty()) {
                             const auto error = error_of([&] { job.run_part(parts, 0, 1); });
                             refusal =
                                 error ? to_string(error->code()) + std::string(" ") + error->what()
                                       : "none";
                             EXPECT_TRUE(parts.look(0).running);
                           }
                           return true;
                         }),
            Outcome::kMade);
  EXPECT_TRUE(refusal.starts_with("part-busy ")) << refusal;
  EXPECT_NE(refusal.find("shares overlap"), std::string::npos) << refusal;
  EXPECT_EQ(names_in(parts.path()),
            (std::vector<std::string>{"part-000000.json", "part-000000.npy", "sweep.json"}));
}

// A process that is killed leaves its mark, without the lock.
TEST_F(SweepParts, AreGivenUpAfterThreeStartsThatWereLost) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  for (int start = 1; start <= 3; ++start) {
    EXPECT_EQ(parts.look(0).state, PartState::kMissing) << start;
    std::ofstream(parts.mark_file(0, start)).flush();
    EXPECT_EQ(parts.look(0).starts, start);
  }
  EXPECT_EQ(parts.look(0).state, PartState::kGivenUp);
  EXPECT_EQ(job.run_part(parts, 0, 1), Outcome::kGivenUp);
  EXPECT_FALSE(std::filesystem::exists(parts.part_file(0)));
  EXPECT_EQ(job.run_part(parts, 1, 1), Outcome::kMade);
  std::filesystem::remove(parts.mark_file(0, 2));
  EXPECT_EQ(job.run_part(parts, 0, 1), Outcome::kMade);
  EXPECT_EQ(names_in(parts.path()),
            (std::vector<std::string>{"part-000000.json", "part-000000.npy", "part-000001.json",
                                      "part-000001.npy", "sweep.json"}));
}

TEST_F(SweepParts, TheMarksOfAPartThatIsThereAreRemoved) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  run_all(job, parts);
  std::ofstream(parts.mark_file(2, 1)).flush();
  EXPECT_EQ(job.run_part(parts, 2, 1), Outcome::kWasThere);
  EXPECT_FALSE(std::filesystem::exists(parts.mark_file(2, 1)));
}

TEST_F(SweepParts, ThreadsShareASweep) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job), alone = folder(job, "alone");
  run_all(job, alone);
  std::atomic<int> made{0};
  {
    std::vector<std::jthread> threads;
    for (std::uint64_t part = 0; part < 3; ++part) {
      threads.emplace_back([&, part] { made += job.run_part(parts, part, 1) == Outcome::kMade; });
    }
  }
  EXPECT_EQ(made, 3);
  for (std::uint64_t part = 0; part < 3; ++part) {
    EXPECT_EQ(file_content(parts.part_file(part)), file_content(alone.part_file(part)));
  }
}

TEST_F(SweepParts, NeedWhatTheQuestionsNeed) {
  write_tree(build_tree(icosphere(1, 1), {.voxel_size = 0.4, .keep_triangles = false}),
             dir_.path() / "moving.ist");
  const Sweep deep = sweep_with("\"contacts\"", "\"penetration\"");
  EXPECT_EQ(error_name([&] { static_cast<void>(deep.open_folder(dir_.path() / "deep")); }),
            "triangles-missing");
  write_tree(build_tree(icosphere(1, 1), {.voxel_size = 0.4, .spheres = SpherePolicy::kTable}),
             dir_.path() / "moving.ist");
  const Sweep slab = sweep_with("tolerance", "spheres = \"slab\"\ntolerance");
  EXPECT_EQ(error_name([&] { static_cast<void>(slab.open_folder(dir_.path() / "slab")); }),
            "policy-missing");
  write_tree(build_tree(icosphere(1, 1)), dir_.path() / "moving.ist");
  const Sweep felt = sweep_with("tolerance", "tolerance");
  EXPECT_EQ(error_name([&] { static_cast<void>(felt.open_folder(dir_.path() / "felt")); }),
            "voxels-missing");
  // Nothing stays that would refuse the sweep once its trees are right.
  EXPECT_FALSE(std::filesystem::exists(dir_.path() / "felt"));
  EXPECT_FALSE(std::filesystem::exists(dir_.path() / "deep"));
  EXPECT_FALSE(std::filesystem::exists(dir_.path() / "slab"));
}

}  // namespace
}  // namespace ist::test
