#include "sweep/sweep_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "ist/base/direction.h"
#include "ist/base/float_environment.h"
#include "loop/scene/table_reader.h"
#include "loop/scene/toml_document.h"
#include "sweep/npy_file.h"
#include "sweep/pose_source.h"
#include "sweep/row_layout.h"

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

constexpr std::string_view kColumnName =
    "a name of at most 23 letters, digits and _, a letter first";

std::filesystem::path beside(const TableReader& table, const std::string& name) {
  return table.file().parent_path() / name;
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
  if (table.has("name")) axis.name = table.text("name", kColumnName);
  return axis;
}

// Refuses the name of an axis that cannot be the name of a column.
void check_name(const TableReader& table, const std::string& name,
                const std::vector<PoseGrid::Axis>& before) {
  constexpr std::size_t kMost = 23;  // bytes: ist_sweep_column::name holds it
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const bool is_word = std::all_of(name.begin(), name.end(), [&](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '_';
  });
  if (!is_word || name.empty() || !is_letter(name.front()) || name.size() > kMost) {
    table.fail("name", fmt::format("'name' in {} is no name of a column", table.name()),
               fmt::format("give {}", kColumnName));
  }
  const std::vector<Column> known = layout_of({true, true, true, true, true}).columns;
  if (std::any_of(known.begin(), known.end(), [&](const Column& c) { return c.name == name; })) {
    table.fail("name",
               fmt::format("'name' in {} is \"{}\", a column of all rows or of a question",
                           table.name(), name),
               "give another name");
  }
  if (std::any_of(before.begin(), before.end(), [&](const auto& a) { return a.name == name; })) {
    table.fail("name", fmt::format("'name' in {} is that of another axis", table.name()),
               "give each axis another name");
  }
}

std::shared_ptr<const PoseSource> read_grid(TableReader& poses) {
  std::vector<PoseGrid::Axis> axes;
  std::uint64_t count = 1;
  for (TableReader& table : poses.tables("axes")) {
    PoseGrid::Axis axis = read_axis(table);
    if (table.has("name")) check_name(table, axis.name, axes);
    axes.push_back(std::move(axis));
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
  sweep.fixed = read_sweep_body(reader, "fixed", sweep.questions);
  sweep.moving = read_sweep_body(reader, "moving", sweep.questions);
  sweep.poses = read_poses(reader);
  reader.refuse_unknown();
  const std::uint64_t rows = sweep.poses->count();
  if (rows > sweep.rows_per_part * kMostParts) {
    reader.fail("rows_per_part",
                fmt::format("{} poses make more than {} parts of {} rows", rows, kMostParts,
                            sweep.rows_per_part),
                fmt::format("set rows_per_part = {} or more", (rows - 1) / kMostParts + 1));
  }
  compute_hash(reader, "fixed", sweep.fixed);
  compute_hash(reader, "moving", sweep.moving);
  return sweep;
}

}  // namespace ist
