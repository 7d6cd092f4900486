#include "sweep/sweep_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "ist/base/checksum.h"
#include "ist/base/direction.h"
#include "ist/base/float_environment.h"
#include "ist/tree/tree_stream.h"
#include "loop/scene/table_reader.h"
#include "loop/scene/toml_document.h"
#include "sweep/npy_file.h"

namespace ist {
namespace {

constexpr double kMany = std::numeric_limits<double>::infinity();
constexpr NumberRange kPlaces{-1e12, 1e12, "in mesh units"};
constexpr NumberRange kSmallTurn{0, 90, "degrees"};
constexpr NumberRange kTurn{-360, 360, "degrees"};
constexpr NumberRange kDirection{-1e300, 1e300, ""};
constexpr NumberRange kTolerance{0, 1e12, "in mesh units"};
constexpr NumberRange kMargin{0, 2, "mean voxel sizes"};
constexpr NumberRange kSpring{-1e12, 1e12, "N/mm³"};
constexpr NumberRange kSeeds{0, kMany, ""};
constexpr NumberRange kTests{1, kMany, ""};
constexpr NumberRange kCount{0, static_cast<double>(kMostRows), "poses"};
constexpr NumberRange kSteps{1, static_cast<double>(kMostRows), ""};
constexpr NumberRange kRowsPerPart{1, 1e9, "rows"};

constexpr std::string_view kAnswers =
    R"(some of "intersects", "leaf_pairs", "distance", "contacts" and "penetration")";

std::filesystem::path beside(const TableReader& table, const std::string& name) {
  return table.file().parent_path() / name;
}

SweepFile::Body read_body(TableReader& sweep, std::string_view key) {
  TableReader table = sweep.table(key);
  SweepFile::Body body{beside(table, table.text("tree", "the name of a tree file")), ""};
  const bool named = table.has("hash");
  const std::string expected =
      named ? table.text("hash", "the 32 hexadecimal digits of the file's XXH3-128") : "";
  // What is no tree is found before a folder is made for it.
  static_cast<void>(TreeReader(body.tree));
  body.hash = hash_of_file(body.tree);
  if (named && expected != body.hash) {
    table.fail("hash",
               fmt::format("the tree {} changed: its hash is {}, not {}", body.tree.string(),
                           body.hash, expected),
               "take the tree that the sweep was made for, or write the new hash and begin anew");
  }
  return body;
}

RowQuestions read_questions(TableReader& sweep) {
  RowQuestions questions;
  struct Known {
    std::string_view name;
    bool RowQuestions::*question;
  };
  constexpr std::array<Known, 5> kKnown = {{{"intersects", &RowQuestions::intersects},
                                            {"leaf_pairs", &RowQuestions::leaf_pairs},
                                            {"distance", &RowQuestions::distance},
                                            {"contacts", &RowQuestions::contacts},
                                            {"penetration", &RowQuestions::penetration}}};
  for (const std::string& name : sweep.texts("answers", kAnswers)) {
    const auto known = std::find_if(kKnown.begin(), kKnown.end(),
                                    [&](const Known& each) { return each.name == name; });
    if (known == kKnown.end()) {
      sweep.fail("answers", fmt::format("'answers' has \"{}\"", name),
                 fmt::format("give {}", kAnswers));
    }
    questions.*(known->question) = true;
  }
  questions.tolerance = sweep.number("tolerance", kTolerance, 0);
  if (sweep.has("tests")) questions.budget.tests = sweep.whole_number("tests", kTests);
  return questions;
}

PoseGrid::Axis read_axis(TableReader& table) {
  PoseGrid::Axis axis;
  axis.turns = table.has("turn");
  if (axis.turns == table.has("move")) {
    table.refuse_misspelt();
    table.fail(axis.turns ? "turn" : "move",
               fmt::format("{} has {}", table.name(),
                           axis.turns ? "both 'move' and 'turn'" : "neither 'move' nor 'turn'"),
               "give one: move = [x, y, z] along a direction, or turn = [x, y, z] about one");
  }
  const std::string_view key = axis.turns ? "turn" : "move";
  axis.direction = table.vector(key, kDirection);
  if (!direction_of(axis.direction)) {
    table.fail(key, fmt::format("'{}' in {} has no length", key, table.name()),
               "give a direction, such as [0, 0, 1]");
  }
  if (axis.turns) axis.about = table.vector("about", kPlaces, axis.about);
  const NumberRange& range = axis.turns ? kTurn : kPlaces;
  axis.from = table.number("from", range);
  axis.to = table.number("to", range);
  axis.count = table.whole_number("count", kSteps);
  return axis;
}

std::shared_ptr<const PoseSource> read_grid(TableReader& poses) {
  std::vector<PoseGrid::Axis> axes;
  std::uint64_t count = 1;
  for (TableReader& table : poses.tables("axes")) {
    axes.push_back(read_axis(table));
    if (axes.back().count > kMostRows / count) {
      table.fail("count", fmt::format("the grid has more than {} poses", kMostRows),
                 "make it coarser, or make several sweeps of it");
    }
    count *= axes.back().count;
  }
  return std::make_shared<PoseGrid>(std::move(axes));
}

std::shared_ptr<const PoseSource> read_box(TableReader& poses) {
  TableReader table = poses.table("box");
  PoseBox::Settings box;
  box.seed = table.whole_number("seed", kSeeds, box.seed);
  box.count = table.whole_number("count", kCount);
  box.from = table.vector("from", kPlaces);
  box.to = table.vector("to", kPlaces);
  for (int axis = 0; axis < 3; ++axis) {
    if (box.from[axis] <= box.to[axis]) continue;
    table.fail("to",
               fmt::format("'to' in {} is {} on axis {}, below 'from'", table.name(), box.to[axis],
                           "xyz"[axis]),
               "give 'from' the smaller number");
  }
  const bool any = table.has("turns"), within = table.has("turns_within");
  if (any && within) {
    table.fail("turns", fmt::format("{} has both 'turns' and 'turns_within'", table.name()),
               "give one of them");
  }
  if (any && table.text("turns", "\"any\"") != "any") {
    table.fail("turns", fmt::format("'turns' in {} is not \"any\"", table.name()),
               "give \"any\", or take it out and give 'turns_within'");
  }
  if (any) box.turns = PoseBox::Turns::kAny;
  if (within) {
    box.turns = PoseBox::Turns::kWithin;
    box.within = table.vector("turns_within", kSmallTurn);
  }
  if (any || within) box.about = table.vector("about", kPlaces, box.about);
  return std::make_shared<PoseBox>(box);
}

std::shared_ptr<const PoseSource> read_poses(TableReader& sweep) {
  TableReader poses = sweep.table("poses");
  const bool grid = poses.has("axes"), box = poses.has("box"), file = poses.has("file");
  if (grid + box + file == 0) poses.refuse_unknown();  // a misspelling
  if (grid + box + file != 1) {
    sweep.fail("poses",
               fmt::format("[poses] names {} of 'axes', 'box' and 'file'",
                           grid + box + file == 0 ? "none" : "more than one"),
               "give one: [[poses.axes]] for a grid, [poses.box] for random poses, or file = "
               "\"poses.npy\"");
  }
  if (grid) return read_grid(poses);
  if (box) return read_box(poses);
  return std::make_shared<NpyPoses>(beside(poses, poses.text("file", "the name of a .npy file")));
}

}  // namespace

SweepFile read_sweep_file(const std::filesystem::path& file) {
  const ScopedFloatEnvironment environment;
  TomlTable document = read_toml(file);
  TableReader reader(file, document);
  SweepFile sweep;
  sweep.file = file;
  sweep.questions = read_questions(reader);
  if (reader.has("spheres")) {
    sweep.spheres =
        reader.choice("spheres", sphere_policy, R"("simple", "table", "tight" or "slab")");
  }
  sweep.margin = reader.number("margin", kMargin, sweep.margin);
  sweep.stiffness = reader.number("stiffness", kSpring, sweep.stiffness);
  sweep.rows_per_part = reader.whole_number("rows_per_part", kRowsPerPart, sweep.rows_per_part);
  // Typing errors are found before large files are read.
  for (const std::string_view key : {"fixed", "moving"}) {
    TableReader body = reader.table(key);
    static_cast<void>(body.text("tree", "the name of a tree file"));
    static_cast<void>(body.has("hash"));
  }
  sweep.poses = read_poses(reader);
  reader.refuse_unknown();
  const std::uint64_t rows = sweep.poses->count();
  if (rows > sweep.rows_per_part * kMostParts) {
    reader.fail("rows_per_part",
                fmt::format("{} poses make more than {} parts of {} rows", rows, kMostParts,
                            sweep.rows_per_part),
                fmt::format("set rows_per_part = {} or more", (rows - 1) / kMostParts + 1));
  }
  sweep.fixed = read_body(reader, "fixed");
  sweep.moving = read_body(reader, "moving");
  return sweep;
}

}  // namespace ist
