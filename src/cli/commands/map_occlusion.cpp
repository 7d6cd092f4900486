#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "answers/formats/format.h"
#include "answers/formats/ply_writer.h"
#include "answers/formats/vtp_writer.h"
#include "answers/json_parts.h"
#include "answers/occlusion/bite_files.h"
#include "answers/occlusion/bite_maker.h"
#include "answers/occlusion/bite_surfaces.h"
#include "answers/occlusion/labels/tooth_labels.h"
#include "answers/refusals.h"
#include "cli/commands/commands.h"
#include "cli/common_options.h"
#include "cli/load_bodies.h"
#include "cli/occlusion/bite_html.h"
#include "cli/occlusion/bite_tables.h"
#include "cli/page/page_blocks.h"
#include "cli/page/page_file.h"
#include "cli/poses/pose_options.h"
#include "cli/progress_bar.h"
#include "cli/query_run.h"
#include "cli/terminal.h"
#include "ist/base/files.h"

namespace ist::cli {

using namespace answers;

namespace {

constexpr std::array kWritable = {FileFormat::kVtp, FileFormat::kPly,  FileFormat::kGlb,
                                  FileFormat::kCsv, FileFormat::kJson, FileFormat::kHtml};

struct OcclusionArguments {
  BodyFiles files;
  PoseOptions pose;
  std::vector<std::filesystem::path> outputs;
  BiteQuestions questions;
  std::string preset{presets().front().name}, numbering, side, region;
  std::string decimal = "point";
  std::optional<double> open;  // millimetres
  bool fail_if_touching = false, json = false;
};

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : presets()) names.emplace_back(preset.name);
  return names;
}

void require_length(double length, const std::string& option) {
  refuse_if(!(length > 0) || !std::isfinite(length), option, "{} is no length: give more than 0",
            length);
}

std::optional<Eigen::AlignedBox3d> region_of(const std::string& text) {
  if (text.empty()) return {};
  const auto numbers = numbers_of(text);
  refuse_if(!numbers || numbers->size() != 6, "--region",
            text + ": give x0,y0,z0,x1,y1,z1, two corners of a box in fixed coordinates");
  const Eigen::Vector3d one(numbers->data()), other(numbers->data() + 3);
  refuse_if((one - other).cwiseAbs().minCoeff() == 0, "--region",
            text + ": the box is empty: its corners must differ in x, y and z");
  return Eigen::AlignedBox3d(one.cwiseMin(other), one.cwiseMax(other));
}

// Reads the options' values, or refuses them, before any file is read.
BiteQuestions questions_of(const OcclusionArguments& options) {
  BiteQuestions questions = options.questions;
  require_length(questions.reach, "--reach");
  refuse_if(!(questions.scanner_band >= 0) || !std::isfinite(questions.scanner_band),
            "--scanner-band", "give micrometres from 0 on");
  const auto preset = std::find_if(presets().begin(), presets().end(),
                                   [&](const Preset& each) { return each.name == options.preset; });
  questions.preset = &*preset;
  refuse_if(questions.reach < 1e-3 * preset->micrometres.back(), "--reach",
            "{} mm is less than the preset's largest limit, {:g} µm", questions.reach,
            preset->micrometres.back());
  questions.region = region_of(options.region);
  const bool labels = !questions.labels_fixed.empty() || !questions.labels_moving.empty();
  refuse_if(labels && options.numbering.empty(), "--numbering",
            "needed with labels: fdi or universal");
  refuse_if(!labels && !options.numbering.empty(), "--numbering",
            "goes with --labels-fixed and --labels-moving");
  if (labels) {
    questions.numbers = options.numbering == "fdi" ? ToothNumbers::kFdi : ToothNumbers::kUniversal;
  }
  return questions;
}

// One spelling of each file, whether it is there or not.
std::filesystem::path plain(const std::filesystem::path& file) {
  std::error_code unknown;
  const auto spelled = std::filesystem::weakly_canonical(std::filesystem::absolute(file), unknown);
  return unknown ? file : spelled;
}

// Opened before anything is measured, and completed when all of them are written.
struct Output {
  std::unique_ptr<OutputFile> file;
  FileFormat format;
};

std::vector<Output> outputs_of(const OcclusionArguments& options) {
  std::vector<Output> outputs;
  std::set<std::filesystem::path> names;
  bool surface = false, open = false, table = false;
  for (const std::filesystem::path& file : options.outputs) {
    const FileFormat format = format_by_ending("-o", file, kWritable);
    check_output(file, {options.files.fixed, options.files.moving, options.pose.matrix,
                        label_source(options.questions.labels_fixed).file,
                        label_source(options.questions.labels_moving).file});
    refuse_if(!names.insert(plain(file)).second, "-o", "{} is named twice", file.string());
    open = open || format == FileFormat::kPly || format == FileFormat::kGlb;
    surface = surface || format == FileFormat::kVtp;
    table = table || format == FileFormat::kCsv;
    outputs.push_back({std::make_unique<OutputFile>(file), format});
  }
  refuse_if(options.decimal == "comma" && !table, "--decimal", "goes with .csv");
  refuse_if(options.open && !open, "--open", "goes with .ply and .glb");
  refuse_if(!options.side.empty() && !open && !surface, "--side", "goes with .vtp, .ply and .glb");
  if (options.open) {
    refuse_if(!(*options.open >= 0) || !std::isfinite(*options.open), "--open",
              "give millimetres from 0 on");
  }
  return outputs;
}

void write(const Bite& bite, const Output& output, BiteSelection selection, DecimalSign sign) {
  const std::string comment =
      fmt::format("signed distances, {}, NaN beyond {:g}", bite.unit_words(), bite.reach);
  switch (output.format) {
    case FileFormat::kVtp:
      selection.open.reset();
      return write_vtp(joined(bite_arrays(bite, selection)), *output.file);
    case FileFormat::kPly:
      return write_ply(joined(bite_surfaces(bite, selection)), *output.file, comment);
    case FileFormat::kGlb:
      return write_bite_glb(bite, selection, *output.file);
    case FileFormat::kCsv:
      return write_bite_csv(bite, sign, *output.file);
    default:
      return write_bite_json(bite, *output.file);
  }
}

// Whether a file's name asks for the static report: bite.report.html, in any case.
bool asks_for_report(const std::filesystem::path& file) {
  std::string word = file.stem().extension().string();
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return word == ".report";
}

// Writes the page with the engine in it if there is one that shows all that was asked, else the
// static report, and says why.
void write_report(const Bodies& bodies, const Bite& bite, const BiteQuestions& questions,
                  OutputFile& file) {
  if (asks_for_report(file.target())) return write_bite_html(bite, file);
  const std::optional<std::filesystem::path> page = find_page();
  if (page && page_shows(questions)) {
    return write_page(*page, bite_block(bodies, bite, questions), file);
  }
  fmt::print(stderr, "{}: the static report, for {}\n", file.target().string(),
             page ? "the page knows no sides, labels, scanner bands and regions" : kHowToGetPage);
  write_bite_html(bite, file);
}

BiteSources sources_of(const Bodies& bodies, const BodyFiles& files) {
  const auto named = [](const SphereTree& tree, const std::filesystem::path& file) {
    return tree.source().name.empty() ? MeshSource{file.filename().string()} : tree.source();
  };
  return {named(bodies.fixed, files.fixed), named(bodies.moving, files.moving)};
}

void run(const OcclusionArguments& options) {
  BiteQuestions questions = questions_of(options);
  const std::vector<Output> outputs = outputs_of(options);
  const auto [pose, rotation_error] = options.pose.poses_named().front();
  Bodies bodies = load_bodies(options.files);
  questions.unit = bodies.told_unit;
  if (questions.no_names) {
    bodies.fixed_name = "the fixed body";
    bodies.moving_name = "the moving body";
  }
  if (!options.json) echo_pose(options.pose, pose);
  const Bite bite = [&, pose = pose, error = rotation_error] {
    ProgressBar progress;
    Bite made = make_bite(bodies, sources_of(bodies, options.files), pose, questions, progress);
    made.findings.rotation_error = error;
    return made;
  }();
  BiteSelection selection;
  if (!options.side.empty()) {
    selection.side = options.side == "fixed" ? BiteSide::kFixed : BiteSide::kMoving;
  }
  if (options.open) selection.open = *options.open * bite.units_per_mm;
  const DecimalSign sign = options.decimal == "comma" ? DecimalSign::kComma : DecimalSign::kPoint;
  for (const Output& output : outputs) {
    if (output.format == FileFormat::kHtml) {
      write_report(bodies, bite, questions, *output.file);
    } else {
      write(bite, output, selection, sign);
    }
  }
  std::vector<OutputFile*> files;
  files.reserve(outputs.size());
  for (const Output& output : outputs) files.push_back(output.file.get());
  OutputFile::commit_all(files);
  if (options.json) {
    if (!questions.no_names) {
      print_header("occlusion", {{"fixed", options.files.fixed}, {"moving", options.files.moving}},
                   bodies, TakenUnit{bite.unit, bite.unit_assumed});
    }
    print_json(json_of(bite));
  } else {
    print_bite(bite, options.outputs);
    print_contacts(bite);
  }
  if (options.fail_if_touching) fail_where_they_meet(bite.findings.meeting());
}

void add_measure_options(CLI::App& command, OcclusionArguments& options) {
  BiteQuestions& questions = options.questions;
  command
      .add_option("--preset", options.preset,
                  "limits of the areas and bands: scan 0, 100 µm; owens 50, 350; biteeye 9, 29, "
                  "59, 89, 149; paper 200; stl 100 to 400; shim 10")
      ->transform(one_of(preset_names()))
      ->capture_default_str();
  command
      .add_option("--reach", questions.reach, "millimetres beyond which no distance is measured")
      ->capture_default_str();
  command
      .add_option("--scanner-band", questions.scanner_band,
                  "micrometres, ±, that scanning is assumed to err by")
      ->capture_default_str();
  command
      .add_option("--region", options.region,
                  "x0,y0,z0,x1,y1,z1: count only triangles with their centroid in this box; two "
                  "corners, fixed coordinates, mesh units")
      ->type_name("BOX");
  add_units_and_frame(command, options.files);
}

void add_patient_options(CLI::App& command, OcclusionArguments& options) {
  command.option_defaults()->group(
      "The patient; nothing is guessed, and sides are +x and -x by default");
  BiteQuestions& questions = options.questions;
  command
      .add_option("--frame", questions.sides.frame,
                  "lps: +x is the patient's left, +y behind; ras: +x right, +y in front; by "
                  "default as the files say it")
      ->transform(one_of({"lps", "ras"}));
  command.add_option("--left", questions.sides.left, "x,y,z: the direction of the patient's left")
      ->type_name("X,Y,Z");
  command
      .add_option("--front", questions.sides.front, "x,y,z: the direction of the patient's front")
      ->type_name("X,Y,Z");
  command
      .add_option("--midline", questions.sides.midline,
                  "x,y,z: a point between left and right; by default the middle of the fixed "
                  "body's box, assumed")
      ->type_name("X,Y,Z");
  add_file(command, "--labels-fixed", questions.labels_fixed,
           "the fixed body's tooth numbers, 0 for no tooth: the mesh as a .vtk or .vtp "
           "(FILE:ARRAY), as a .ply with a property label, or as an .obj with groups such "
           "as tooth_16; or a text of a number a line, for each triangle or vertex");
  add_file(command, "--labels-moving", questions.labels_moving, "the moving body's");
  command.add_option("--numbering", options.numbering, "the system of the labels")
      ->transform(one_of({"fdi", "universal"}));
  command.option_defaults()->group("Options");
}

}  // namespace

void add_occlusion(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "occlusion",
      "Map the distance between two jaws: areas, contact regions, shares, files to see");
  const auto options = std::make_shared<OcclusionArguments>();
  options->files.voxels = BodyFiles::Voxels::kNone;
  add_file(*command, "FIXED", options->files.fixed, "mesh or tree of the body that stays")
      ->required();
  add_file(*command, "MOVING", options->files.moving, "mesh or tree of the body that is moved")
      ->required();
  command
      ->add_option(
          "-o,--output", options->outputs,
          fmt::format("file to write, by its ending: {}; .html is the interactive page if it is "
                      "installed, else a static report, .report.html is the report always; may be "
                      "given again; without it only text is printed",
                      endings_with_programs(kWritable)))
      ->type_name("FILE");
  add_measure_options(*command, *options);
  command->add_option("--side", options->side, "write this body alone, to .vtp, .ply and .glb")
      ->transform(one_of({"fixed", "moving"}));
  command
      ->add_option("--decimal", options->decimal,
                   "the decimal sign in .csv; with comma, semicolons part the fields, as in German "
                   "or Spanish Excel")
      ->transform(one_of({"point", "comma"}))
      ->capture_default_str();
  command->add_option("--open", options->open,
                      "open the pair like a book, with this gap, millimetres: .ply and .glb");
  command->add_flag("--no-names", options->questions.no_names,
                    "write fixed and moving for the files' names");
  command->add_flag(
      "--fail-if-touching", options->fail_if_touching,
      "exit code 6 where the bodies touch, or one lies in the other; 1 where that is unknown");
  add_max_memory(*command, options->files.max_memory, "a body's tree of triangles");
  command->add_flag("--json", options->json, "print the measures as JSON");
  add_patient_options(*command, *options);
  add_pose_options(*command, options->pose, Poses::kOne);
  add_example(
      *command,
      std::string(
          "Examples: ist occlusion upper.stl lower.stl -o bite.vtp\n"
          "          ist occlusion upper.stl lower.stl --frame lps -o bite.html -o bite.csv\n\n") +
          kCaveat);
  command->callback([options] { run(*options); });
}

}  // namespace ist::cli
