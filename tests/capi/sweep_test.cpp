// Sweeps by the C interface: observably those of the library, with every argument checked.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "c_bodies.h"
#include "ist/capi/ist_sweep.h"
#include "listener.h"
#include "sweep/sweep_case.h"

namespace ist::test {
namespace {

using Names = std::vector<std::string>;

class CSweep : public SweepTest {
 protected:
  CSweep() { sweep_ = open(kSoundSweep); }
  ~CSweep() override { EXPECT_EQ(name(ist_sweep_free(sweep_)), "ok"); }

  [[nodiscard]] ist_sweep* open(std::string_view text) const {
    ist_sweep* made = nullptr;
    const std::string file = dir_.write("job.toml", text).string();
    EXPECT_EQ(name(ist_sweep_open(file.c_str(), nullptr, &made)), "ok") << ist_last_error_message();
    return made;
  }
  [[nodiscard]] ist_status run(std::uint64_t part) {
    return ist_sweep_run_part(sweep_, folder_.c_str(), part, 1, nullptr, &part_);
  }
  [[nodiscard]] ist_status look(std::uint64_t part, bool verify = false) {
    return ist_sweep_get_part(sweep_, folder_.c_str(), part, verify, &part_);
  }
  [[nodiscard]] ist_status merge() {
    return ist_sweep_merge(sweep_, folder_.c_str(), nullptr, &merged_);
  }

  ist_sweep* sweep_ = nullptr;
  const std::string folder_ = (dir_.path() / "out").string();
  ist_sweep_info info_ = sized<ist_sweep_info>();
  ist_sweep_column column_ = sized<ist_sweep_column>();
  ist_sweep_part part_ = sized<ist_sweep_part>();
  ist_sweep_merge_result merged_ = sized<ist_sweep_merge_result>();
  std::vector<double> poses_ = std::vector<double>(160);
};

TEST_F(CSweep, SaysWhatTheLibrarySays) {
  const Sweep known = sweep();
  ASSERT_EQ(name(ist_sweep_get_info(sweep_, &info_)), "ok");
  EXPECT_EQ(info_.rows, 10U);
  EXPECT_EQ(info_.rows_per_part, 4U);
  EXPECT_EQ(info_.parts, 3U);
  EXPECT_EQ(info_.row_bytes, known.layout().bytes);
  EXPECT_EQ(std::string(info_.hash), known.identity().hash);
  ASSERT_EQ(info_.columns, known.layout().columns.size());
  for (std::uint64_t i = 0; i < info_.columns; ++i) {
    ASSERT_EQ(name(ist_sweep_get_column(sweep_, i, &column_)), "ok");
    const Column& column = known.layout().columns[i];
    EXPECT_EQ(column_.name, column.name);
    EXPECT_EQ(column_.offset, column.offset);
    EXPECT_EQ(column_.type, column.type == ColumnType::kUint64  ? IST_COLUMN_UINT64
                            : column.type == ColumnType::kInt32 ? IST_COLUMN_INT32
                                                                : IST_COLUMN_FLOAT64);
  }
}

TEST_F(CSweep, GivesThePosesOfTheLibrary) {
  std::vector<Eigen::Isometry3d> known(10);
  sweep().poses(0, known);
  ASSERT_EQ(name(ist_sweep_get_poses(sweep_, 0, 10, poses_.data())), "ok");
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(std::memcmp(poses_.data() + 16 * i, known[i].data(), 128), 0) << i;
  }
  ASSERT_EQ(name(ist_sweep_get_poses(sweep_, 9, 1, poses_.data())), "ok");
  EXPECT_EQ(std::memcmp(poses_.data(), known[9].data(), 128), 0);
  EXPECT_EQ(name(ist_sweep_get_poses(sweep_, 10, 0, nullptr)), "ok");
}

TEST_F(CSweep, MakesThePartsOfTheLibrary) {
  for (const std::uint64_t part : {0U, 1U, 2U}) {
    ASSERT_EQ(name(run(part)), "ok") << ist_last_error_message();
    EXPECT_EQ(part_.state, IST_PART_DONE);
    EXPECT_EQ(part_.made, 1);
    EXPECT_EQ(part_.rows, part == 2 ? 2U : 4U);
    EXPECT_GT(part_.seconds, 0);
  }
  ASSERT_EQ(name(run(1)), "ok");
  EXPECT_EQ(part_.made, 0);
  EXPECT_EQ(part_.state, IST_PART_DONE);
  const Sweep known = sweep();
  const SweepFolder other = folder(known, "other");
  run_all(known, other);
  for (std::uint64_t part = 0; part < 3; ++part) {
    EXPECT_EQ(file_content(other.part_file(part)),
              file_content(dir_.path() / "out" / other.part_file(part).filename()));
  }
  ASSERT_EQ(name(merge()), "ok");
  EXPECT_EQ(merged_.rows, 10U);
  EXPECT_EQ(merged_.missing + merged_.given_up, 0U);
  EXPECT_TRUE(std::filesystem::exists(dir_.path() / "out" / "rows.npy"));
}

TEST_F(CSweep, MergesNoPartIntoATableOfNoRows) {
  ist_sweep* none = open(sweep_text("count = 10", "count = 0"));
  EXPECT_EQ(name(ist_sweep_merge(none, folder_.c_str(), nullptr, &merged_)), "ok")
      << ist_last_error_message();
  EXPECT_EQ(merged_.rows + merged_.missing + merged_.given_up, 0U);
  EXPECT_EQ(names_in(folder_),
            (std::vector<std::string>{"manifest.json", "rows.npy", "sweep.json"}));
  EXPECT_EQ(name(ist_sweep_free(none)), "ok");
}

TEST_F(CSweep, SaysHowPartsStand) {
  ASSERT_EQ(name(run(0)), "ok");
  for (int start = 1; start <= 3; ++start) {
    std::ofstream(dir_.path() / "out" / ("part-000001.start-" + std::to_string(start))).flush();
  }
  ASSERT_EQ(name(look(1)), "ok");
  EXPECT_EQ(part_.state, IST_PART_GIVEN_UP);
  EXPECT_EQ(part_.starts, 3);
  ASSERT_EQ(name(run(1)), "ok");
  EXPECT_EQ(part_.state, IST_PART_GIVEN_UP);
  EXPECT_EQ(part_.made, 0);
  ASSERT_EQ(name(look(2)), "ok");
  EXPECT_EQ(part_.state, IST_PART_MISSING);
  EXPECT_TRUE(std::isnan(part_.seconds));
  ASSERT_EQ(name(merge()), "ok");
  EXPECT_EQ(merged_.rows, 0U);
  EXPECT_EQ(merged_.missing, 1U);
  EXPECT_EQ(merged_.given_up, 1U);
  const std::filesystem::path file = dir_.path() / "out" / "part-000000.npy";
  std::string bytes = file_content(file);
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  std::ofstream(file, std::ios::binary) << bytes;
  ASSERT_EQ(name(look(0)), "ok");
  EXPECT_EQ(part_.state, IST_PART_DONE);
  ASSERT_EQ(name(look(0, true)), "ok");
  EXPECT_EQ(part_.state, IST_PART_DAMAGED);
}

TEST_F(CSweep, EndsAsItsFollowerAsks) {
  Listener listener{.stop_at = 1};
  const auto progress = sized<ist_progress>({0, Listener::hear, &listener});
  EXPECT_EQ(name(ist_sweep_run_part(sweep_, folder_.c_str(), 0, 1, &progress, &part_)),
            "cancelled");
  listener = {.stop_at = 1};
  ist_sweep* none = sweep_;
  const std::string file = (dir_.path() / "job.toml").string();
  EXPECT_EQ(name(ist_sweep_open(file.c_str(), &progress, &none)), "cancelled");
  EXPECT_EQ(none, nullptr);
}

TEST_F(CSweep, EndsMidway) {
  std::size_t runs = 0;
  ist_sweep* made = nullptr;
  expect_ends_midway([&](std::size_t work, const ist_progress* progress) {
    EXPECT_EQ(name(ist_sweep_free(made)), "ok");
    std::string text(kSoundSweep);
    const std::string count = std::to_string(500 * work);
    text.replace(text.find("count = 10"), 10, "count = " + count);
    text.replace(text.find("rows_per_part = 4"), 17, "rows_per_part = " + count);
    made = open(text);
    const std::string out = (dir_.path() / ("run" + std::to_string(++runs))).string();
    const ist_status status = ist_sweep_run_part(made, out.c_str(), 0, 1, progress, &part_);
    if (status == IST_CANCELLED) {
      const Names left = std::filesystem::exists(out) ? names_in(out) : Names{};
      EXPECT_TRUE(left.empty() || left == Names{"sweep.json"}) << *left.begin();
    }
    return status;
  });
  EXPECT_EQ(name(ist_sweep_free(made)), "ok");
}

TEST_F(CSweep, RefusesNumbersOutOfRange) {
  const char* out = folder_.c_str();
  const auto invalid = [](ist_status status, const char* said) {
    EXPECT_EQ(name(status), "argument-invalid");
    EXPECT_NE(std::string(ist_last_error_message()).find(said), std::string::npos)
        << ist_last_error_message();
  };
  ASSERT_EQ(name(ist_sweep_get_info(sweep_, &info_)), "ok");
  invalid(ist_sweep_get_column(sweep_, info_.columns, &column_), "column is 22");
  invalid(ist_sweep_get_poses(sweep_, 10, 1, poses_.data()), "first is 10");
  invalid(ist_sweep_get_poses(sweep_, 0, 11, poses_.data()), "count is 11");
  invalid(ist_sweep_get_poses(sweep_, ~std::uint64_t{0}, 1, poses_.data()), "the sweep has 10");
  invalid(run(3), "part is 3");
  invalid(ist_sweep_run_part(sweep_, out, 0, -1, nullptr, &part_), "threads is -1");
  invalid(ist_sweep_run_part(sweep_, out, 0, 1025, nullptr, &part_), "threads is 1025");
  invalid(look(3), "part is 3");
  EXPECT_FALSE(std::filesystem::exists(folder_));
}

// Structs of a younger and of an older caller.
TEST_F(CSweep, FillsStructsOfAnySize) {
  ASSERT_EQ(name(run(0)), "ok");
  ASSERT_EQ(name(merge()), "ok");
  const auto check = [](auto known, const char* what,
                        const std::function<ist_status(void*)>& call) {
    using Struct = decltype(known);
    SCOPED_TRACE(what);
    for (const std::size_t size : {std::size_t{16}, sizeof(Struct), sizeof(Struct) + 8}) {
      std::vector<std::uint64_t> words(sizeof(Struct) / 8 + 2, ~std::uint64_t{0});
      words[0] = size;
      EXPECT_EQ(name(call(words.data())), "ok");
      const std::size_t common = std::min(size, sizeof(Struct));
      EXPECT_EQ(std::memcmp(&words[1], reinterpret_cast<const char*>(&known) + 8, common - 8), 0);
      if (size > sizeof(Struct)) {
        EXPECT_EQ(words[sizeof(Struct) / 8], 0U);
      }
      EXPECT_EQ(words[size / 8], ~std::uint64_t{0}) << "written beyond the struct";
    }
    for (const std::size_t size : {std::size_t{0}, std::size_t{8}, sizeof(Struct) + 4}) {
      std::vector<std::uint64_t> words(sizeof(Struct) / 8 + 2, 0);
      words[0] = size;
      EXPECT_EQ(name(call(words.data())), "struct-size") << size;
    }
  };
  ASSERT_EQ(name(ist_sweep_get_info(sweep_, &info_)), "ok");
  check(info_, "info",
        [&](void* out) { return ist_sweep_get_info(sweep_, static_cast<ist_sweep_info*>(out)); });
  ASSERT_EQ(name(ist_sweep_get_column(sweep_, 3, &column_)), "ok");
  check(column_, "column", [&](void* out) {
    return ist_sweep_get_column(sweep_, 3, static_cast<ist_sweep_column*>(out));
  });
  ASSERT_EQ(name(look(0)), "ok");
  check(part_, "part", [&](void* out) {
    return ist_sweep_get_part(sweep_, folder_.c_str(), 0, 0, static_cast<ist_sweep_part*>(out));
  });
  check(part_, "run", [&](void* out) {
    return ist_sweep_run_part(sweep_, folder_.c_str(), 0, 1, nullptr,
                              static_cast<ist_sweep_part*>(out));
  });
  check(merged_, "merge", [&](void* out) {
    return ist_sweep_merge(sweep_, folder_.c_str(), nullptr,
                           static_cast<ist_sweep_merge_result*>(out));
  });
}

TEST_F(CSweep, NamesEachFailure) {
  const auto opened = [&](std::string_view text) {
    ist_sweep* none = sweep_;
    const std::string file = dir_.write("bad.toml", text).string();
    const ist_status status = ist_sweep_open(file.c_str(), nullptr, &none);
    EXPECT_EQ(none, nullptr);
    return name(status);
  };
  EXPECT_EQ(opened("answers = 1"), "input-invalid");
  EXPECT_EQ(opened(sweep_text("fixed.ist", "gone.ist")), "input-invalid");
  // A folder of another sweep, and one that cannot be one.
  ASSERT_EQ(name(run(0)), "ok");
  ist_sweep* other = open(sweep_text("seed = 7", "seed = 8"));
  EXPECT_EQ(name(ist_sweep_run_part(other, folder_.c_str(), 0, 1, nullptr, &part_)),
            "input-invalid");
  EXPECT_EQ(name(ist_sweep_get_part(other, folder_.c_str(), 0, 0, &part_)), "input-invalid");
  EXPECT_EQ(name(ist_sweep_merge(other, folder_.c_str(), nullptr, &merged_)), "input-invalid");
  EXPECT_EQ(part_.state, 0);
  EXPECT_EQ(merged_.rows, 0U);
  const std::string file = dir_.write("file", "").string(), gone = (dir_.path() / "gone").string();
  EXPECT_EQ(name(ist_sweep_run_part(other, file.c_str(), 0, 1, nullptr, &part_)), "input-invalid");
  EXPECT_EQ(name(ist_sweep_get_part(other, gone.c_str(), 0, 0, &part_)), "file-unreadable");
  EXPECT_EQ(name(ist_sweep_merge(other, gone.c_str(), nullptr, &merged_)), "file-unreadable");
  EXPECT_EQ(name(ist_sweep_free(other)), "ok");
  // The first part of a sweep loads its trees.
  ist_sweep* changed = open(sweep_text("seed = 7", "seed = 9"));
  write_ball("moving.ist", 1.5);
  const std::string out = (dir_.path() / "changed").string();
  EXPECT_EQ(name(ist_sweep_run_part(changed, out.c_str(), 0, 1, nullptr, &part_)), "input-invalid");
  EXPECT_FALSE(std::filesystem::exists(out)) << "it would refuse the sweep of the right tree";
  EXPECT_EQ(name(ist_sweep_free(changed)), "ok");
  // A tree whose content is wrong, and one that is no tree at all.
  std::string tree = file_content(dir_.path() / "moving.ist");
  tree.back() = static_cast<char>(tree.back() ^ 1);
  dir_.write("moving.ist", tree);
  ist_sweep* broken = open(sweep_text("seed = 7", "seed = 10"));
  const std::string again = (dir_.path() / "broken").string();
  EXPECT_EQ(name(ist_sweep_run_part(broken, again.c_str(), 0, 1, nullptr, &part_)), "tree-corrupt");
  EXPECT_EQ(name(ist_sweep_free(broken)), "ok");
  dir_.write("moving.ist", "no tree");
  EXPECT_EQ(opened(kSoundSweep), "not-a-tree");
}

TEST_F(CSweep, AFullDiskIsAnUnwritableFile) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  ASSERT_EQ(name(run(0)), "ok");
  ASSERT_EQ(name(run(1)), "ok");
  ASSERT_EQ(name(run(2)), "ok");
  std::filesystem::create_symlink("/dev/full", dir_.path() / "out" / "rows.npy");
  EXPECT_EQ(name(merge()), "file-unwritable");
  EXPECT_FALSE(std::filesystem::exists(dir_.path() / "out" / "manifest.json"));
}

}  // namespace
}  // namespace ist::test
