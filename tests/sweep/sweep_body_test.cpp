// The bodies of a sweep: meshes whose trees the first part builds, beside trees of files.

#include "sweep/sweep_body.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "support/errors.h"
#include "support/shapes.h"
#include "sweep/npy_file.h"
#include "sweep/sweep_case.h"

namespace ist::test {
namespace {

// Two balls in mesh files, of radius 2 and 1.
class MeshSweep : public SweepTest {
 protected:
  MeshSweep() {
    write_stl(icosphere(2, 2), dir_.path() / "fixed.stl");
    write_stl(icosphere(2, 1), dir_.path() / "moving.stl");
  }

  // The sound sweep, with other questions and with these texts in place of its bodies.
  [[nodiscard]] Sweep sweep_of(const std::string& answers, const std::string& fixed,
                               const std::string& moving) const {
    return sweep("answers = [" + answers + "]\ntolerance = 0.01\nrows_per_part = 4\n" + fixed +
                 moving + std::string(kSoundSweep.substr(kSoundSweep.find("[poses.box]"))));
  }
  static std::string body(const std::string& name, const std::string& keys) {
    return "[" + name + "]\n" + keys + "\n";
  }
  // The error of a sweep that is opened and begun.
  [[nodiscard]] std::optional<Error> refusal(const std::string& answers, const std::string& fixed,
                                             const std::string& moving) const {
    return error_of([&] { static_cast<void>(sweep_of(answers, fixed, moving).open_folder(out_)); });
  }
  // The numbers of a column of all rows.
  [[nodiscard]] std::vector<double> column(const Sweep& job, const std::string& name) const {
    const SweepFolder parts = folder(job, "of " + job.identity().hash);
    for (std::uint64_t part = 0; part < job.parts(); ++part) job.run_part(parts, part, 1);
    std::vector<double> numbers;
    for (const Column& each : job.layout().columns) {
      if (each.name != name) continue;
      for (std::uint64_t row = 0; row < job.rows(); ++row) {
        const std::uint64_t part = row / job.identity().rows_per_part;
        const std::uint64_t header = npy_header(job.layout(), job.identity().rows_of(part)).size();
        const std::string bytes = file_content(parts.part_file(part));
        const char* at = bytes.data() + header +
                         (row % job.identity().rows_per_part) * job.layout().bytes + each.offset;
        std::int32_t code = 0;
        double real = 0;
        std::memcpy(&code, at, sizeof(code));
        if (each.type == ColumnType::kFloat64) std::memcpy(&real, at, sizeof(real));
        numbers.push_back(each.type == ColumnType::kFloat64 ? real : code);
      }
    }
    return numbers;
  }

  const std::filesystem::path out_ = dir_.path() / "out";
  const std::string tables_ = body("fixed", "file = \"fixed.stl\"\nvoxel_size = 0.4") +
                              body("moving", "file = \"moving.stl\"\nvoxel_size = 0.4"),
                    names_ = "fixed = \"fixed.stl\"\nmoving = \"moving.stl\"\n";
};

TEST_F(MeshSweep, ItsRowsAreThoseOfTheTrees) {
  for (const char* name : {"fixed", "moving"}) {
    const std::filesystem::path stem = dir_.path() / name;
    write_tree(build_tree(read_mesh(stem.string() + ".stl"), {.voxel_size = 0.4}),
               stem.string() + ".ist");
  }
  const std::string all = R"("intersects", "leaf_pairs", "distance", "contacts", "penetration")";
  const Sweep of_meshes = sweep_of(all, tables_, ""),
              of_trees = sweep_of(all, "fixed = \"fixed.ist\"\nmoving = \"moving.ist\"\n", "");
  EXPECT_NE(of_meshes.identity().hash, of_trees.identity().hash);
  const SweepFolder meshes = folder(of_meshes, "meshes"), trees = folder(of_trees, "trees");
  run_all(of_meshes, meshes);
  run_all(of_trees, trees);
  for (std::uint64_t part = 0; part < 3; ++part) {
    EXPECT_EQ(file_content(meshes.part_file(part)), file_content(trees.part_file(part))) << part;
  }
}

TEST_F(MeshSweep, NeedsNoVoxelsForWhatTrianglesAnswer) {
  const std::string asked = R"("intersects", "distance", "penetration")";
  const Sweep without = sweep_of(asked, names_, ""), with = sweep_of(asked, tables_, "");
  EXPECT_EQ(column(without, "intersects"), column(with, "intersects"));
  for (const std::string of : {"distance", "depth"}) {
    const std::vector<double> low = column(without, of + "_lower"),
                              high = column(without, of + "_upper"),
                              other_low = column(with, of + "_lower"),
                              other_high = column(with, of + "_upper");
    for (std::size_t i = 0; i < low.size(); ++i) {
      EXPECT_LE(low[i], other_high[i]) << of << i;
      EXPECT_LE(other_low[i], high[i]) << of << i;
      EXPECT_LE(high[i] - low[i], 0.0101) << of << i;
    }
  }
}

TEST_F(MeshSweep, AMeshAndATreeAnswerTogether) {
  const std::string asked = R"("intersects", "contacts")";
  const Sweep mixed = sweep_of(asked, tables_.substr(0, tables_.find("[moving]")),
                               "[moving]\ntree = \"moving.ist\"\n");
  const std::vector<double> meet = column(mixed, "intersects");
  EXPECT_EQ(std::set<double>(meet.begin(), meet.end()), (std::set<double>{1, 3}));
}

TEST_F(MeshSweep, EachOptionIsAnotherSweep) {
  std::set<std::string> hashes;
  const auto add = [&](const std::string& keys) {
    const std::string hash =
        sweep_of("\"intersects\"", body("fixed", keys), "[moving]\nfile = \"moving.stl\"\n")
            .identity()
            .hash;
    EXPECT_TRUE(hashes.insert(hash).second) << keys;
    return hash;
  };
  const std::string plain = add("file = \"fixed.stl\"");
  add("file = \"fixed.stl\"\nvoxel_size = 0.4");
  add("file = \"fixed.stl\"\nvoxel_size = 0.4000000000000001");
  add("file = \"fixed.stl\"\nunit = \"mm\"");
  add("file = \"fixed.stl\"\nframe = \"ras\"");
  add("file = \"moving.stl\"");
  add("file = \"fixed.ist\"");
  EXPECT_EQ(sweep_of("\"intersects\"", names_, "").identity().hash, plain);
  std::filesystem::rename(dir_.path() / "fixed.stl", dir_.path() / "other.stl");
  EXPECT_EQ(sweep_of("\"intersects\"", "fixed = \"other.stl\"\nmoving = \"moving.stl\"\n", "")
                .identity()
                .hash,
            plain);
  write_stl(icosphere(2, 2.5), dir_.path() / "other.stl");
  EXPECT_NE(sweep_of("\"intersects\"", "fixed = \"other.stl\"\nmoving = \"moving.stl\"\n", "")
                .identity()
                .hash,
            plain);
}

TEST_F(MeshSweep, BadBodiesAreRefusedWithLineKeyAndRemedy) {
  struct Bad {
    std::string answers, fixed, moving;
    int line;
    std::vector<std::string> said;
  };
  const std::string asked = "\"intersects\"", mesh = "file = \"fixed.stl\"\n",
                    sound = "[moving]\nfile = \"moving.stl\"\n";
  dir_.write("lps.obj", "# SPACE=LPS\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  dir_.write("text.stl", "no mesh");
  dir_.write("flat.obj", "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n");
  write_tree(build_tree(icosphere(1, 1), {.voxel_size = 0.4, .keep_triangles = false}),
             dir_.path() / "bounds.ist");
  write_tree(build_tree(icosphere(1, 1)), dir_.path() / "plain.ist");
  write_tree(
      build_tree(icosphere(1, 1), {.voxel_size = 0.4, .source = {.unit = LengthUnit::kMetre}}),
      dir_.path() / "metres.ist");
  const std::vector<Bad> all = {
      {asked,
       "fixed = \"gone.stl\"\nmoving = \"moving.stl\"\n",
       "",
       4,
       {"there is no file", "gone.stl", "check 'fixed'"}},
      {asked, body("fixed", "file = \"gone.stl\""), sound, 5, {"there is no file", "check 'file'"}},
      {asked, body("fixed", mesh + "voxel_size = 0"), sound, 6, {"'voxel_size'", "is 0"}},
      {asked, body("fixed", mesh + "voxel_size = \"a\""), sound, 6, {"'voxel_size'", "a number"}},
      {asked, body("fixed", mesh + "unit = \"cm\""), sound, 6, {"'unit'", "\"mm\""}},
      {asked, body("fixed", mesh + "frame = \"RAS\""), sound, 6, {"'frame'", "\"ras\" or \"lps\""}},
      {asked,
       body("fixed", mesh + "hash = \"00\""),
       sound,
       6,
       {"changed: its hash is", "begin anew"}},
      {asked,
       body("fixed", "file = \"fixed.ist\"\nunit = \"mm\""),
       sound,
       6,
       {"'unit' is for a mesh", "take the key out"}},
      {"\"contacts\"",
       body("fixed", mesh),
       sound,
       5,
       {"fixed.stl is a mesh", "need voxels", "give [fixed] a 'voxel_size'"}},
      {"\"leaf_pairs\"",
       "fixed = \"fixed.ist\"\nmoving = \"moving.stl\"\n",
       "",
       5,
       {"moving.stl is a mesh", "give [moving] a 'voxel_size'"}},
      {asked,
       body("fixed", "mesh = \"fixed.stl\""),
       sound,
       5,
       {"'mesh' in [fixed] is unknown, and there is no 'file'", "give 'file'"}},
      {"\"leaf_pairs\"",
       body("fixed", "file = \"plain.ist\""),
       body("moving", "file = \"moving.stl\"\nvoxel_size = 0.2"),
       5,
       {"'file' in [fixed]", "plain.ist: the tree holds no voxels", "build it with a voxel size"}},
      {asked, body("fixed", "file = \"text.stl\""), sound, 5, {"'file' in [fixed]", "text.stl"}},
      {asked, body("fixed", "file = \"flat.obj\""), sound, 5, {"'file' in [fixed]"}},
      {asked,
       body("fixed", "file = \"lps.obj\"\nframe = \"ras\""),
       sound,
       5,
       {"lps.obj says that its frame is lps, and 'frame' says ras", "take the key out"}},
      {asked,
       body("fixed", "file = \"lps.obj\""),
       body("moving", "file = \"moving.stl\"\nframe = \"ras\""),
       7,
       {"moving.stl is in the frame ras", "lps.obj is in lps", "build both in one frame"}},
      {asked,
       body("fixed", mesh + "unit = \"mm\""),
       body("moving", "tree = \"metres.ist\""),
       8,
       {"metres.ist is in m,", "fixed.stl is in mm", "convert one mesh"}},
      {asked,
       body("fixed", mesh),
       body("moving", "tree = \"bounds.ist\""),
       5,
       {"fixed.stl is a mesh without voxels", "bounds.ist is a tree without triangles",
        "give the mesh a 'voxel_size'"}},
      {asked, body("fixed", mesh + "voxel_size = 1e-6"), sound, 5, {"'file' in [fixed]", "voxel"}},
  };
  for (const Bad& bad : all) {
    SCOPED_TRACE(bad.fixed + bad.moving);
    const std::optional<Error> error = refusal(bad.answers, bad.fixed, bad.moving);
    ASSERT_TRUE(error) << "it is taken for sound";
    const std::string what = error->what();
    const std::string place =
        (dir_.path() / "job.toml").string() + ":" + std::to_string(bad.line) + ": ";
    EXPECT_TRUE(what.starts_with(place)) << what;
    for (const std::string& said : bad.said) {
      EXPECT_NE(what.find(said), std::string::npos) << what << "\ndoes not say: " << said;
    }
    EXPECT_FALSE(std::filesystem::exists(out_));
  }
}

TEST_F(MeshSweep, ATreeWithoutTrianglesAnswersAMeshWithVoxels) {
  write_tree(build_tree(icosphere(2, 1), {.voxel_size = 0.4, .keep_triangles = false}),
             dir_.path() / "moving.ist");
  const Sweep job = sweep_of("\"intersects\"", tables_.substr(0, tables_.find("[moving]")),
                             "[moving]\nfile = \"moving.ist\"\n");
  const std::vector<double> meet = column(job, "intersects");
  EXPECT_EQ(std::set<double>(meet.begin(), meet.end()), (std::set<double>{1, 2}));
}

TEST_F(MeshSweep, AMeshThatChangedIsRefused) {
  const Sweep job = sweep_of("\"intersects\"", names_, "");
  write_stl(icosphere(2, 1.5), dir_.path() / "moving.stl");
  const auto error = error_of([&] { static_cast<void>(job.open_folder(out_)); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kInputInvalid);
  EXPECT_NE(std::string(error->what()).find("moving.stl changed since the sweep was opened"),
            std::string::npos)
      << error->what();
  EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(MeshSweep, ItsRowsHaveTheirPoses) {
  const Sweep job = sweep_of("\"intersects\"", names_, "");
  std::vector<Eigen::Isometry3d> poses(job.rows());
  job.poses(0, poses);
  const std::vector<double> x = column(job, "x"), w = column(job, "qw");
  ASSERT_EQ(x.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(x[i], poses[i](0, 3)) << i;
    EXPECT_NEAR(4 * w[i] * w[i], 1 + poses[i].linear().trace(), 1e-14) << i;
  }
}

}  // namespace
}  // namespace ist::test
