#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "answers/comparison/bite_comparison.h"
#include "answers/comparison/change_map.h"
#include "answers/comparison/comparison_files.h"
#include "answers/formats/format.h"
#include "answers/formats/ply_writer.h"
#include "answers/formats/vtp_writer.h"
#include "answers/occlusion/bite_files.h"
#include "answers/occlusion/labels/tooth_labels.h"
#include "answers/refusals.h"
#include "cli/commands/commands.h"
#include "cli/common_options.h"
#include "cli/load_bodies.h"
#include "cli/occlusion/bite_options.h"
#include "cli/occlusion/comparison_tables.h"
#include "cli/occlusion/figure/bite_figure.h"
#include "cli/occlusion/figure/figure_files.h"
#include "cli/output_files.h"
#include "cli/poses/pose_file.h"
#include "cli/progress_bar.h"
#include "cli/terminal.h"

namespace ist::cli {

using namespace answers;

namespace {

constexpr std::array kComparisonFiles = {FileFormat::kVtp,  FileFormat::kPly, FileFormat::kCsv,
                                         FileFormat::kJson, FileFormat::kPng, FileFormat::kSvg,
                                         FileFormat::kPdf};
constexpr std::initializer_list<FileFormat> kMaps = {
    FileFormat::kVtp, FileFormat::kPly, FileFormat::kPng, FileFormat::kSvg, FileFormat::kPdf};
constexpr std::initializer_list<FileFormat> kColoured = {FileFormat::kPly, FileFormat::kPng,
                                                         FileFormat::kSvg, FileFormat::kPdf};

// Options that say how a bite is measured. Files of bites are measured already.
constexpr std::array kMeasuring = {
    "--preset",      "--limits",   "--reach",        "--scanner-band",  "--region",   "--unit",
    "--unit-moving", "--to-frame", "--no-names",     "--max-memory",    "--frame",    "--left",
    "--front",       "--midline",  "--labels-fixed", "--labels-moving", "--numbering"};

struct CompareArguments : BiteOptions {
  std::filesystem::path before, after;
  std::vector<std::filesystem::path> outputs;
  ComparisonQuestions comparison;
  std::string about, decimal = "point";
  std::optional<double> range;  // micrometres
  bool json = false;
  std::string measuring;  // the first option of kMeasuring that is given

  // Whether two meshes are compared at two poses, not two files of bites.
  [[nodiscard]] bool has_poses() const { return !before.empty() || !after.empty(); }
};

// The bodies of two meshes, and their bites at both poses.
struct TwoBites {
  Bodies bodies;
  Bite before, after;
};

bool ends_in_json(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending == ".json";
}

ComparisonQuestions comparison_of(const CompareArguments& options) {
  ComparisonQuestions questions = options.comparison;
  const auto require = [](double length, const char* option) {
    refuse_if(!(length >= 0) || !std::isfinite(length), option, "give millimetres from 0 on");
  };
  require(questions.within, "--within");
  require(questions.moved, "--moved");
  if (!options.about.empty()) {
    questions.about = vector_of(options.about);
    refuse_if(!questions.about, "--about", "{}: give x,y,z, a point in fixed coordinates",
              options.about);
  }
  return questions;
}

void check_kind(const CompareArguments& options, const OutputFiles& outputs) {
  refuse_if(options.decimal == "comma" && !outputs.has({FileFormat::kCsv}), "--decimal",
            "goes with .csv");
  refuse_if(options.range && !outputs.has(kColoured), "--range",
            "goes with .ply, .png, .svg and .pdf");
  refuse_if(options.range && (!(*options.range > 0) || !std::isfinite(*options.range)), "--range",
            "give micrometres above 0");
  check_figures(outputs, options.outputs);
  if (options.has_poses()) return;
  for (const std::filesystem::path& file : {options.files.fixed, options.files.moving}) {
    refuse_if(!ends_in_json(file), file.string(),
              "give two bites that ist occlusion -o FILE.json wrote, or two meshes with the poses "
              "--before and --after");
  }
  refuse_if(!options.measuring.empty(), options.measuring,
            "goes with two meshes: both bites are measured already");
  refuse_if(outputs.has(kMaps), "-o",
            "a map of the change needs the meshes: ist compare FIXED MOVING --before A.tfm "
            "--after B.tfm");
}

GivenPose pose_of_file(const std::filesystem::path& file) {
  return file.empty() ? GivenPose{Eigen::Isometry3d::Identity()} : read_matrix(file);
}

TwoBites measured(CompareArguments& options) {
  BiteQuestions questions = questions_of(options);
  const GivenPose before = pose_of_file(options.before), after = pose_of_file(options.after);
  TwoBites two{load_bodies(options.files), {}, {}};
  questions.unit = two.bodies.told_unit;
  if (questions.no_names) {
    two.bodies.fixed_name = "the fixed body";
    two.bodies.moving_name = "the moving body";
  }
  const BiteSources sources = sources_of(two.bodies, options.files);
  ProgressBar progress;
  const auto bite_at = [&](const GivenPose& given) {
    Bite bite = make_bite(two.bodies, sources, given.pose, questions, progress);
    bite.findings.rotation_error = given.rotation_error;
    return bite;
  };
  two.before = bite_at(before);
  two.after = bite_at(after);
  return two;
}

void write_map(const CompareArguments& options, const TwoBites& two,
               const BiteComparison& comparison, const ChangeMap& map,
               const OutputFiles::One& output) {
  if (output.format == FileFormat::kVtp) {
    return write_vtp(joined(change_arrays(two.before, two.after, map)), *output.file);
  }
  std::optional<double> most;
  if (options.range) most = *options.range * two.after.units_per_micrometre();
  const MapScale scale = scale_of(map, two.after.reach, most);
  if (const std::optional<FigureKind> kind = figure_kind(output.format)) {
    return write_change_figure(two.after, comparison, map, scale, *kind, *output.file);
  }
  const std::string comment =
      fmt::format("change of the signed distance, {}: red nearer, blue farther, to {:g} either way",
                  two.after.unit_words(), scale.high());
  write_ply(joined(change_surfaces(two.after, map, scale)), *output.file, comment);
}

void run(CompareArguments& options) {
  const OutputFiles outputs(options.outputs, kComparisonFiles,
                            {options.files.fixed, options.files.moving, options.before,
                             options.after, label_source(options.questions.labels_fixed).file,
                             label_source(options.questions.labels_moving).file});
  check_kind(options, outputs);
  BiteComparison comparison;
  comparison.questions = comparison_of(options);
  std::optional<TwoBites> two;
  if (options.has_poses()) {
    two.emplace(measured(options));
    comparison.before = record_of(json_of(two->before), "the first bite");
    comparison.after = record_of(json_of(two->after), "the second bite");
  } else {
    comparison.before = read_bite(options.files.fixed);
    comparison.after = read_bite(options.files.moving);
  }
  compare(comparison);
  ChangeMap map;
  if (two && outputs.has(kMaps)) map = change_map(two->before, two->after);
  const DecimalSign sign = options.decimal == "comma" ? DecimalSign::kComma : DecimalSign::kPoint;
  for (const OutputFiles::One& output : outputs.all()) {
    if (output.format == FileFormat::kCsv) {
      write_comparison_csv(comparison, sign, *output.file);
    } else if (output.format == FileFormat::kJson) {
      write_comparison_json(comparison, *output.file);
    } else {
      write_map(options, *two, comparison, map, output);
    }
  }
  outputs.commit();
  options.json ? print_json(json_of(comparison)) : print_comparison(comparison, options.outputs);
}

void add_comparison_options(CLI::App& command, CompareArguments& options) {
  command
      .add_option("--about", options.about,
                  "x,y,z: the point whose way is told, fixed coordinates, mesh units; by default "
                  "the middle of the moving body's box in the first bite")
      ->type_name("X,Y,Z");
  command
      .add_option("--within", options.comparison.within,
                  "millimetres: contacts whose centres are farther apart are two contacts")
      ->capture_default_str();
  command
      .add_option("--moved", options.comparison.moved,
                  "millimetres: a contact whose centre went farther has moved")
      ->capture_default_str();
  command
      .add_option("--decimal", options.decimal,
                  "the decimal sign in .csv; with comma, semicolons part the fields")
      ->transform(one_of({"point", "comma"}))
      ->capture_default_str();
  command.add_flag("--json", options.json, "print the comparison as JSON");
}

void add_mesh_options(CLI::App& command, CompareArguments& options) {
  command.option_defaults()->group("Two meshes at two poses");
  add_file(command, "--before", options.before,
           "the first pose: 4 x 4 numbers row by row, or a transform of ITK; by default as stored");
  add_file(command, "--after", options.after, "the second pose, likewise");
  command.add_option(
      "--range", options.range,
      "micrometres: the change at both ends of the colours in .ply and figures; by default the "
      "largest change. One range makes a series comparable");
  command.add_flag("--no-names", options.questions.no_names,
                   "write fixed and moving for the files' names");
  add_max_memory(command, options.files.max_memory, "a body's tree of triangles");
  add_measure_options(command, options);
  add_patient_options(command, options);
}

}  // namespace

void add_compare(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "compare",
      "Compare two bites: contacts won, lost and moved, areas, depths, the jaw's motion");
  const auto options = std::make_shared<CompareArguments>();
  options->files.voxels = BodyFiles::Voxels::kNone;
  add_file(*command, "BEFORE", options->files.fixed,
           "the first bite, of 'ist occlusion -o FILE.json'; or the mesh that stays")
      ->required();
  add_file(*command, "AFTER", options->files.moving,
           "the second bite; or the mesh that is moved, with --before and --after")
      ->required();
  command
      ->add_option("-o,--output", options->outputs,
                   fmt::format("file to write, by its ending: {}; .vtp, .ply and figures hold the "
                               "map of the change, of two meshes; may be given again",
                               endings_with_programs(kComparisonFiles)))
      ->type_name("FILE");
  add_comparison_options(*command, *options);
  add_mesh_options(*command, *options);
  add_example(*command, std::string("Examples: ist compare plan.json outcome.json -o change.csv\n"
                                    "          ist compare upper.stl lower.stl --before plan.tfm "
                                    "--after outcome.tfm -o change.vtp\n\n") +
                            kCaveat);
  command->callback([options, command] {
    for (const char* name : kMeasuring) {
      if (options->measuring.empty() && command->count(name) > 0) options->measuring = name;
    }
    run(*options);
  });
}

}  // namespace ist::cli
