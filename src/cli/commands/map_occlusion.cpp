#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
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
#include "cli/occlusion/bite_options.h"
#include "cli/occlusion/bite_tables.h"
#include "cli/occlusion/figure/bite_figure.h"
#include "cli/occlusion/figure/figure_files.h"
#include "cli/output_files.h"
#include "cli/page/page_blocks.h"
#include "cli/page/page_file.h"
#include "cli/poses/pose_options.h"
#include "cli/progress_bar.h"
#include "cli/query_run.h"
#include "cli/terminal.h"

namespace ist::cli {

using namespace answers;

namespace {

constexpr std::array kWritable = {FileFormat::kVtp, FileFormat::kPly,  FileFormat::kGlb,
                                  FileFormat::kCsv, FileFormat::kJson, FileFormat::kHtml,
                                  FileFormat::kPng, FileFormat::kSvg,  FileFormat::kPdf};
constexpr std::initializer_list<FileFormat> kFigures = {FileFormat::kPng, FileFormat::kSvg,
                                                        FileFormat::kPdf};

struct OcclusionArguments : BiteOptions {
  PoseOptions pose;
  std::vector<std::filesystem::path> outputs;
  std::string side, scale = "bands", range;
  std::string decimal = "point";
  std::optional<double> open;  // millimetres
  bool fail_if_touching = false, json = false;
};

// Both ends of a continuous scale, micrometres.
std::vector<double> range_of(const std::string& text) {
  const auto numbers = numbers_of(text);
  refuse_if(
      !numbers || numbers->size() != 2 || !((*numbers)[0] < (*numbers)[1]) || !((*numbers)[1] > 0),
      "--range", "{}: give LOW,HIGH, two distances in micrometres, such as -200,500", text);
  return *numbers;
}

OutputFiles outputs_of(const OcclusionArguments& options) {
  if (!options.range.empty()) static_cast<void>(range_of(options.range));
  OutputFiles outputs(options.outputs, kWritable,
                      {options.files.fixed, options.files.moving, options.pose.matrix,
                       label_source(options.questions.labels_fixed).file,
                       label_source(options.questions.labels_moving).file});
  const bool open = outputs.has({FileFormat::kPly, FileFormat::kGlb});
  refuse_if(options.decimal == "comma" && !outputs.has({FileFormat::kCsv}), "--decimal",
            "goes with .csv");
  refuse_if(options.open && !open, "--open", "goes with .ply and .glb");
  refuse_if(!options.side.empty() && !open && !outputs.has({FileFormat::kVtp}), "--side",
            "goes with .vtp, .ply and .glb");
  check_figures(outputs, options.outputs);
  const bool figure = outputs.has(kFigures);
  refuse_if(options.scale != "bands" && !figure, "--scale", "goes with .png, .svg and .pdf");
  refuse_if(!options.range.empty() && options.scale == "bands", "--range",
            "goes with --scale continuous");
  if (options.open) {
    refuse_if(!(*options.open >= 0) || !std::isfinite(*options.open), "--open",
              "give millimetres from 0 on");
  }
  return outputs;
}

FigureOptions figure_of(const OcclusionArguments& options, const Bite& bite) {
  FigureOptions figure;
  figure.continuous = options.scale == "continuous";
  if (options.range.empty()) return figure;
  const auto numbers = range_of(options.range);
  const double unit = bite.units_per_micrometre();
  figure.range = std::pair(numbers[0] * unit, numbers[1] * unit);
  return figure;
}

void write(const Bite& bite, const OutputFiles::One& output, BiteSelection selection,
           DecimalSign sign) {
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
             page ? "the page knows no sides, labels, limits of your own, scanner bands and regions"
                  : kHowToGetPage);
  write_bite_html(bite, file);
}

void run(OcclusionArguments& options) {
  BiteQuestions questions = questions_of(options);
  const OutputFiles outputs = outputs_of(options);
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
  for (const OutputFiles::One& output : outputs.all()) {
    if (const std::optional<FigureKind> kind = figure_kind(output.format)) {
      write_bite_figure(bite, scale_of(bite, figure_of(options, bite)), *kind, *output.file);
    } else if (output.format == FileFormat::kHtml) {
      write_report(bodies, bite, questions, *output.file);
    } else {
      write(bite, output, selection, sign);
    }
  }
  outputs.commit();
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
  command
      ->add_option("--scale", options->scale,
                   "the colours of .png, .svg and .pdf: bands of the limits, or continuous")
      ->transform(one_of({"bands", "continuous"}))
      ->capture_default_str();
  command
      ->add_option("--range", options->range,
                   "LOW,HIGH: both ends of a continuous scale, micrometres; by default the whole "
                   "map. One range makes a series of figures comparable")
      ->type_name("LOW,HIGH");
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
          "          ist occlusion upper.stl lower.stl --frame lps -o bite.html -o bite.csv\n"
          "          ist occlusion upper.stl lower.stl -o bite.png --limits 50,100,200\n\n") +
          kCaveat);
  command->callback([options] { run(*options); });
}

}  // namespace ist::cli
