#include "cli/occlusion/bite_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "answers/refusals.h"
#include "cli/common_options.h"

namespace ist::cli {

using namespace answers;

namespace {

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

// Returns the preset of that name, or the limits of the user, which `options` then holds.
const Preset* preset_of(BiteOptions& options) {
  if (options.limits.empty()) {
    return &*std::find_if(presets().begin(), presets().end(),
                          [&](const Preset& each) { return each.name == options.preset; });
  }
  const auto numbers = numbers_of(options.limits);
  constexpr std::size_t kMost = 12;
  const bool are_limits =
      numbers && !numbers->empty() && numbers->size() <= kMost && numbers->front() >= 0 &&
      std::adjacent_find(numbers->begin(), numbers->end(), std::greater_equal<>()) ==
          numbers->end() &&
      numbers->back() > 0;
  refuse_if(!are_limits, "--limits",
            "{}: give at most {} micrometres from 0 on, each above the last", options.limits,
            kMost);
  options.own_limits = *numbers;
  options.own = {kOwnPreset, options.own_limits, "limits named by the user"};
  return &options.own;
}

}  // namespace

void add_measure_options(CLI::App& command, BiteOptions& options) {
  BiteQuestions& questions = options.questions;
  command
      .add_option("--preset", options.preset,
                  "limits of the areas and bands: scan 0, 100 µm; owens 50, 350; biteeye 9, 29, "
                  "59, 89, 149; paper 200; stl 100 to 400; shim 10")
      ->transform(one_of(preset_names()))
      ->capture_default_str();
  command
      .add_option("--limits", options.limits,
                  "instead of a preset: limits of your own, micrometres, such as 50,100,200")
      ->type_name("NUMBERS")
      ->excludes("--preset");
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

void add_patient_options(CLI::App& command, BiteOptions& options) {
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

BiteQuestions questions_of(BiteOptions& options) {
  BiteQuestions questions = options.questions;
  require_length(questions.reach, "--reach");
  refuse_if(!(questions.scanner_band >= 0) || !std::isfinite(questions.scanner_band),
            "--scanner-band", "give micrometres from 0 on");
  const Preset* preset = preset_of(options);
  questions.preset = preset;
  refuse_if(questions.reach < 1e-3 * preset->micrometres.back(), "--reach",
            "{} mm is less than the largest limit, {:g} µm", questions.reach,
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

BiteSources sources_of(const Bodies& bodies, const BodyFiles& files) {
  const auto named = [](const SphereTree& tree, const std::filesystem::path& file) {
    return tree.source().name.empty() ? MeshSource{file.filename().string()} : tree.source();
  };
  return {named(bodies.fixed, files.fixed), named(bodies.moving, files.moving)};
}

}  // namespace ist::cli
