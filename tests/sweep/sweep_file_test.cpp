// Sweep files: each value has its place, and a wrong one is refused with line and remedy.

#include "sweep/sweep_file.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "ist/base/checksum.h"
#include "support/errors.h"
#include "sweep/sweep_case.h"

namespace ist::test {
namespace {

using SweepFileTest = SweepTest;

TEST_F(SweepFileTest, HasDefaults) {
  const SweepFile file = sweep_with("rows_per_part = 4\n", "").file();
  EXPECT_TRUE(file.questions.intersects && file.questions.distance && file.questions.contacts);
  EXPECT_FALSE(file.questions.leaf_pairs || file.questions.penetration);
  EXPECT_EQ(file.questions.tolerance, 0.01);
  EXPECT_EQ(file.rows_per_part, 100000U);
  EXPECT_EQ(file.margin, 0);
  EXPECT_EQ(file.stiffness, 1);
  EXPECT_FALSE(file.spheres);
  EXPECT_EQ(file.questions.budget.tests, RowQuestions().budget.tests);
  EXPECT_EQ(file.fixed.tree, dir_.path() / "fixed.ist");
  EXPECT_EQ(file.fixed.hash, hash_of_file(dir_.path() / "fixed.ist"));
  EXPECT_EQ(file.fixed.hash.size(), 32U);
}

TEST_F(SweepFileTest, ReadsEveryKey) {
  const SweepFile file = sweep_with("tolerance = 0.01", R"(tolerance = 0.5
stiffness = 2.5
margin = 0.5
spheres = "tight"
tests = 1000)")
                             .file();
  EXPECT_EQ(file.questions.tolerance, 0.5);
  EXPECT_EQ(file.stiffness, 2.5);
  EXPECT_EQ(file.margin, 0.5);
  EXPECT_EQ(file.spheres, SpherePolicy::kTight);
  EXPECT_EQ(file.questions.budget.tests, 1000U);
}

TEST_F(SweepFileTest, AcceptsTheTreesOwnHash) {
  const std::string hash = hash_of_file(dir_.path() / "moving.ist");
  const Sweep sound =
      sweep_with("tree = \"moving.ist\"", "tree = \"moving.ist\"\nhash = \"" + hash + "\"");
  EXPECT_EQ(sound.identity().hash, sweep().identity().hash);
}

struct BadSweep {
  std::string part, by;
  int line;
  std::string said, remedy;
};

TEST_F(SweepFileTest, WrongValuesAreRefusedWithLineAndRemedy) {
  const std::string grid = "[[poses.axes]]\n", box = "[poses.box]\n";
  const std::vector<BadSweep> all = {
      {"tolerance", "tolerence", 2, "'tolerence' in the file is unknown", "'tolerance'"},
      {"[\"intersects\"", "[\"intersect\"", 1, "\"intersect\"", "\"intersects\""},
      {"[\"intersects\", \"distance\", \"contacts\"]", "[]", 1, "an array of 0", "some of"},
      {"answers = [\"intersects\", \"distance\", \"contacts\"]\n", "", 1, "no 'answers'",
       "some of"},
      {"tolerance = 0.01", "tolerance = -1", 2, "-1", "from 0"},
      {"tolerance = 0.01", "tolerance = nan", 2, "nan", "from 0"},
      {"tolerance = 0.01", "spheres = \"round\"", 2, "round", "\"slab\""},
      {"tolerance = 0.01", "margin = 3", 2, "3", "from 0 to 2"},
      {"tolerance = 0.01", "tests = 0", 2, "0", "from 1 on"},
      {"tolerance = 0.01", "tests = inf", 2, "inf", "a whole number, from 1 on"},
      {"rows_per_part = 4", "rows_per_part = 1.5", 3, "'rows_per_part' in the file is 1.5",
       "give a whole number, 1 to"},
      {"count = 10", "count = 9.3e18", 10, "9.3e+18", "to 1000000000000"},
      {"turns_within = [10, 20, 30]", "turns_wihtin = [1, 2, 3]\nabout = [0, 0, 0]", 13,
       "'turns_wihtin'", "did you mean 'turns_within'?"},
      {"rows_per_part = 4", "rows_per_part = 0", 3, "0", "1 to"},
      {"[fixed]\ntree = \"fixed.ist\"\n", "", 1, "no 'fixed'", "[fixed]"},
      {"tree = \"fixed.ist\"", "file = \"fixed.ist\"", 4, "no 'tree'", "the name of a tree file"},
      {"tree = \"fixed.ist\"", "tree = \"fixed.ist\"\nhash = \"00\"", 6, "changed", "begin anew"},
      {"seed = 7", "seed = -7", 9, "-7", "from 0 on"},
      {"seed = 7", "sede = 7", 9, "'sede'", "'seed'"},
      {"count = 10", "count = 1000000000001", 10, "1000000000001", "to 1000000000000"},
      {"count = 10\n", "", 8, "no 'count'", "a whole number"},
      {"from = [-3, -3, -3]", "from = [-3, 4, -3]", 12, "axis y", "'from' the smaller"},
      {"from = [-3, -3, -3]", "from = [-3, -3]", 11, "an array of 2", "three numbers"},
      {"turns_within = [10, 20, 30]", "turns_within = [10, 20, 91]", 13, "91", "from 0 to 90"},
      {"turns_within = [10, 20, 30]", "turns = \"all\"", 13, "not \"any\"", "turns_within"},
      {"seed = 7", "seed = 7\nturns = \"any\"", 10, "both", "one of them"},
      {"turns_within = [10, 20, 30]", "about = [0, 0, 0]", 13, "'about'", "known here"},
      {"[poses.box]", "[poses]\nfile = \"p.npy\"\n[poses.box]", 8, "more than one", "[poses.box]"},
      {"[poses.box]", "[poses]\n[other]", 8, "none", "[[poses.axes]]"},
      {"[poses.box]",
       "[poses]\n[[poses.axes]]\nmove = [0, 0, 1]\nturn = [1, 0, 0]\nfrom = 0\n"
       "to = 1\ncount = 2\n[poses.boxes]",
       11, "both", "give one"},
      {"[poses.box]", "[[poses.axes]]\nfrom = 0\nto = 1\ncount = 2\n[poses.boxes]", 8, "neither",
       "give one"},
      {"[poses.box]",
       "[[poses.axes]]\nmoev = [0, 0, 1]\nfrom = 0\nto = 1\ncount = 2\n[poses.boxes]", 9,
       "'moev' in [poses.axes.1] is unknown", "did you mean 'move'?"},
      {"[poses.box]",
       "[[poses.axes]]\ntrun = [0, 0, 1]\nfrom = 0\nto = 1\ncount = 2\n[poses.boxes]", 9,
       "'trun' in [poses.axes.1] is unknown", "did you mean 'turn'?"},
      {"[poses.box]",
       "[[poses.axes]]\nmove = [0, 0, 0]\nfrom = 0\nto = 1\ncount = 2\n[poses.boxes]", 9,
       "no length", "[0, 0, 1]"},
      {"[poses.box]",
       "[[poses.axes]]\nturn = [0, 0, 1]\nfrom = 0\nto = 361\ncount = 2\n[poses.boxes]", 11, "361",
       "degrees"},
      {"[poses.box]",
       "[[poses.axes]]\nmove = [0, 0, 1]\nfrom = 0\nto = 1\ncount = 1000000\n"
       "[[poses.axes]]\nmove = [0, 1, 0]\nfrom = 0\nto = 1\ncount = 1000001\n"
       "[poses.boxes]",
       17, "more than 1000000000000", "coarser"},
      {"[poses.box]",
       "[[poses.axes]]\nmove = [0, 0, 1]\nfrom = 0\nto = 1\ncount = 0\n[poses.boxes]", 12, "0",
       "1 to"},
      {"count = 10", "count = 4000001", 3, "more than 1000000 parts", "rows_per_part = 5"},
  };
  for (const BadSweep& bad : all) {
    SCOPED_TRACE(bad.by);
    const std::string text = sweep_text(bad.part, bad.by);
    const std::filesystem::path file = dir_.write("job.toml", text);
    const auto error = error_of([&] { static_cast<void>(read_sweep_file(file)); });
    ASSERT_TRUE(error) << "it is taken for sound";
    EXPECT_EQ(error->code(), ErrorCode::kInputInvalid);
    const std::string what = error->what();
    EXPECT_TRUE(what.starts_with(file.string() + ":" + std::to_string(bad.line) + ": "))
        << what << "\nis not at line " << bad.line;
    const std::size_t said = what.find(bad.said);
    EXPECT_NE(said, std::string::npos) << what << "\ndoes not say: " << bad.said;
    EXPECT_NE(what.find(bad.remedy), std::string::npos) << what << "\nhas no: " << bad.remedy;
  }
}

TEST_F(SweepFileTest, MissingFilesAreNamed) {
  const auto missing = [&](std::string_view part, std::string_view by, const char* name) {
    const auto error = error_of([&] { static_cast<void>(sweep_with(part, by)); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ErrorCode::kFileUnreadable);
    EXPECT_NE(std::string(error->what()).find(name), std::string::npos) << error->what();
  };
  missing("fixed.ist", "gone.ist", "gone.ist");
  missing("[poses.box]", "[poses]\nfile = \"gone.npy\"\n[moving.box]", "gone.npy");
}

// Every number and name that the rows depend on is in the hash of the sweep.
TEST_F(SweepFileTest, EachChangeIsAnotherSweep) {
  std::set<std::string> hashes = {sweep().identity().hash};
  const auto change = [&](std::string_view part, std::string_view by) {
    EXPECT_TRUE(hashes.insert(sweep_with(part, by).identity().hash).second) << by;
  };
  change("\"contacts\"", "\"leaf_pairs\"");
  change(", \"contacts\"", "");
  change("\"contacts\"", "\"penetration\"");
  change("[\"intersects\", ", "[");
  change("\"distance\", ", "");
  change("tolerance = 0.01", "tolerance = 0.010000000000000002");
  change("tolerance", "stiffness = 2\ntolerance");
  change("tolerance", "margin = 1\ntolerance");
  change("tolerance", "tests = 100\ntolerance");
  change("tolerance", "spheres = \"slab\"\ntolerance");
  change("tolerance", "spheres = \"tight\"\ntolerance");
  change("rows_per_part = 4", "rows_per_part = 5");
  change("tree = \"fixed.ist\"", "tree = \"moving.ist\"");
  change("seed = 7", "seed = 8");
  change("count = 10", "count = 11");
  change("from = [-3, -3, -3]", "from = [-3, -3, -3.0000000000000004]");
  change("to = [3, 3, 3]", "to = [3.0000000000000004, 3, 3]");
  change("turns_within = [10, 20, 30]", "turns_within = [10, 20, 29]");
  change("turns_within = [10, 20, 30]", "turns = \"any\"");
  change("turns_within = [10, 20, 30]", "");
  change("turns_within", "about = [1, 0, 0]\nturns_within");
  write_ball("moving.ist", 1.25);
  EXPECT_TRUE(hashes.insert(sweep().identity().hash).second);
}

// Neither names nor folders are.
TEST_F(SweepFileTest, TheSameContentIsTheSameSweep) {
  const std::string hash = sweep().identity().hash;
  std::filesystem::copy(dir_.path() / "moving.ist", dir_.path() / "other.ist");
  EXPECT_EQ(sweep_with("moving.ist", "other.ist").identity().hash, hash);
  EXPECT_EQ(sweep_with("tolerance = 0.01\n", "tolerance = 1e-2 # mm\n\n").identity().hash, hash);
  EXPECT_EQ(sweep_with("count = 10", "count = 1e1").identity().hash, hash);
  EXPECT_EQ(sweep_with("seed = 7", "seed = 7.0").identity().hash, hash);
}

}  // namespace
}  // namespace ist::test
