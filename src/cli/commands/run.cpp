#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "answers/occlusion/labels/tooth_labels.h"
#include "answers/refusals.h"
#include "cli/commands/commands.h"
#include "cli/commands/reports.h"
#include "cli/common_options.h"
#include "cli/exit_code.h"
#include "cli/interruption.h"
#include "cli/load_bodies.h"
#include "cli/progress_bar.h"
#include "cli/recordings/tick_lines.h"
#include "cli/recordings/tick_recorder.h"
#include "cli/recordings/tooth_forces.h"
#include "cli/terminal.h"
#include "ist/base/counted.h"
#include "ist/base/error.h"
#include "ist/base/throw_error.h"
#include "ist/haptics/servo_loop.h"
#include "ist/scene.h"

namespace ist::cli {

using namespace answers;

namespace {

struct RunArguments {
  std::filesystem::path scene, record, replay, labels_fixed, labels_held;
  std::string numbering;
  bool check = false, explain = false, unpaced = false, json = false;
  std::optional<double> rate, seconds;
  std::optional<int> cpu;
  std::uint64_t allow_missed = 0;
  std::uint64_t max_memory = BuildOptions{}.max_memory;
};

// A run that a signal may stop, and its recording, if one is asked for.
struct StoppableRun {
  StoppableRun(const std::filesystem::path& record, const Scene& scene,
               const Simulation& simulation)
      : file(record.empty()
                 ? nullptr
                 : std::make_unique<TickWriter>(record, RecordingHeader(scene, simulation))) {
    if (file) recorder.emplace(*file, stop);
  }

  // Opened while a signal still ends the process: open() of a pipe waits for a reader.
  std::unique_ptr<TickWriter> file;
  StopOnInterruption stop;
  std::optional<TickRecorder> recorder;
};

void check_labels(const RunArguments& options, const Scene& scene) {
  const bool labels = !options.labels_fixed.empty() || !options.labels_held.empty();
  refuse_if(labels && options.numbering.empty(), "--numbering",
            "needed with labels: fdi or universal");
  refuse_if(!labels && !options.numbering.empty(), "--numbering",
            "goes with --labels-fixed and --labels-held");
  refuse_if(labels && !scene.contact, "--labels-fixed, --labels-held",
            "{}: it has no effect contact, and so no contact points", options.scene.string());
  refuse_if(!options.labels_fixed.empty() && scene.fixed.size() > 1, "--labels-fixed",
            "{} has {}: labels need a scene of one", options.scene.string(),
            counted(scene.fixed.size(), "fixed body", "fixed bodies"));
  refuse_if(!options.labels_held.empty() && scene.held.size() > 1, "--labels-held",
            "{} has {}: labels need a scene of one", options.scene.string(),
            counted(scene.held.size(), "held body", "held bodies"));
}

// Returns nothing if there are no labels.
std::optional<ToothForces> teeth_of(const RunArguments& options, const BuiltScene& built) {
  if (options.numbering.empty()) return {};
  const ToothNumbers numbers =
      options.numbering == "fdi" ? ToothNumbers::kFdi : ToothNumbers::kUniversal;
  const auto labels_of = [&](const std::filesystem::path& file, const BodyTrees& body) {
    return file.empty() ? ToothLabels() : read_labels(file, *body.contact->triangles(), numbers);
  };
  std::vector<ToothLabels> labels(built.trees.size());
  labels.front() = labels_of(options.labels_fixed, built.trees.front());
  labels.back() = labels_of(options.labels_held, built.trees.back());
  return ToothForces(std::move(labels));
}

ServoReport run_loop(BuiltScene& built, const ServoOptions& servo, StoppableRun& run,
                     ToothForces* teeth) {
  ProgressBar progress;
  ServoOutputs outputs;
  outputs.progress = &progress;
  outputs.receiver = teeth;
  if (run.recorder) outputs.records = &run.recorder->ring();
  ServoReport report =
      run_servo_loop(*built.simulation, *built.device, servo, outputs, run.stop.asked());
  if (run.recorder) run.recorder->complete();
  return report;
}

void replay_ticks(BuiltScene& built, const Scene& scene, const RunArguments& options) {
  TickReader reader(options.replay, RecordingHeader(scene, *built.simulation));
  StoppableRun run(options.record, scene, *built.simulation);
  const std::atomic<bool>& stop = run.stop.asked();
  ProgressBar progress;
  progress.begin_stage("replaying ticks", reader.bytes());
  std::uint64_t ticks = 0, read = 0;
  while (!stop) {
    const std::optional<RecordedTick> recorded = reader.next(stop);
    if (!recorded) break;
    const TickRecord record = replay(*recorded, *built.simulation);
    if (run.recorder) run.recorder->push(record);
    progress.add(reader.bytes_read() - read);
    read = reader.bytes_read();
    ++ticks;
  }
  if (ticks == 0 && !stop) {
    throw_error(ErrorCode::kInputInvalid, "{}: it holds no tick: give a file that --record wrote",
                options.replay.string());
  }
  if (run.recorder) run.recorder->complete();
  fmt::print(stderr, "replayed {}\n", counted(ticks, "tick"));
}

void run(const RunArguments& options) {
  // NaN passes every range check.
  refuse_if(options.rate && std::isnan(*options.rate), "--rate", "give a number");
  refuse_if(options.seconds && std::isnan(*options.seconds), "--seconds", "give a number");
  check_output(options.record,
               {options.scene, options.replay, label_source(options.labels_fixed).file,
                label_source(options.labels_held).file});
  Scene scene = read_scene(options.scene);
  check_labels(options, scene);
  for (const auto* bodies : {&scene.fixed, &scene.held}) {
    for (const SceneBody& body : *bodies) {
      const auto* file = std::get_if<std::filesystem::path>(&body.source);
      if (file != nullptr) refuse_to_overwrite(options.record, {*file});
      refuse_to_overwrite(options.record, {body.script_file});
    }
  }
  if (const auto* script = std::get_if<ScriptSettings>(&scene.device)) {
    refuse_to_overwrite(options.record, {script->file});
  }
  scene.rate = options.rate.value_or(scene.rate);
  scene.seconds = options.seconds.value_or(scene.seconds);
  BuiltScene built = [&] {
    ProgressBar progress;
    return build_scene(scene, {}, options.max_memory, &progress);
  }();
  print_warnings(built.warnings);
  const auto begin_json = [&] {
    if (options.json) print_header("run", {{"scene", options.scene}});
  };
  if (options.explain) {
    begin_json();
    return print_notes(built.notes, options.json);
  }
  std::optional<ToothForces> teeth = teeth_of(options, built);
  if (options.check) return;
  if (!options.replay.empty()) return replay_ticks(built, scene, options);

  ServoOptions servo;
  servo.ticks = static_cast<std::uint64_t>(std::llround(scene.rate * scene.seconds));
  servo.paced = !options.unpaced;
  servo.real_time.cpu = options.cpu;
  StoppableRun stoppable(options.record, scene, *built.simulation);
  const ServoReport report = run_loop(built, servo, stoppable, teeth ? &*teeth : nullptr);
  begin_json();
  print_report(report, scene, *built.simulation, teeth ? &*teeth : nullptr, options.json);
  flush_stdout();  // while a signal still cannot end the process amid the report
  if (report.lost_records > 0) {
    throw std::runtime_error(
        fmt::format("{} not recorded: the disk is slower than the loop: record to another disk, or "
                    "at a lower --rate",
                    counted(report.lost_records, "tick was", "ticks were")));
  }
  if (report.missed > options.allow_missed) {
    throw Failure(
        kDeadlinesMissed,
        fmt::format(
            "{} missed, and {} allowed: use larger voxels or a lower --rate, or allow more with "
            "--allow-missed",
            counted(report.missed, "deadline was", "deadlines were"),
            counted(options.allow_missed, "is", "are")));
  }
}

}  // namespace

void add_run(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "run", "Run the servo loop of a scene: the forces on a hand, tick by tick");
  const auto options = std::make_shared<RunArguments>();
  add_file(*command, "SCENE", options->scene, "the scene, a TOML file")->required();
  auto* check =
      command->add_flag("--check", options->check,
                        "read and build the scene, print its errors and warnings, and end");
  auto* explain = command->add_flag("--explain", options->explain,
                                    "print the built and the skipped parts with reasons, and end");
  check->excludes(explain);
  command->add_option("--rate", options->rate, "ticks a second, instead of the scene's")
      ->check(CLI::Range(1.0, 10000.0));
  auto* seconds =
      command
          ->add_option("--seconds", options->seconds, "duration in seconds, instead of the scene's")
          ->check(CLI::Range(1e-3, 1e6));
  auto* allow_missed =
      command->add_option("--allow-missed", options->allow_missed, "deadlines that may be missed")
          ->check(whole_number("the number of deadlines"));
  auto* record = add_file(*command, "--record", options->record,
                          "write every tick to this file: JSON lines, or CSV if it ends in .csv");
  auto* unpaced = command->add_flag(
      "--unpaced", options->unpaced,
      "one tick after the other, without waiting and without deadlines; the same on every machine");
  auto* replay = add_file(*command, "--replay", options->replay,
                          "replay the ticks of a JSON recording of this scene: the same "
                          "numbers except for times");
  auto* labels_fixed = add_file(
      *command, "--labels-fixed", options->labels_fixed,
      "the fixed body's tooth numbers, as `ist occlusion` reads them; the report then has the "
      "forces on each tooth");
  auto* labels_held =
      add_file(*command, "--labels-held", options->labels_held, "the held body's tooth numbers");
  auto* numbering =
      command->add_option("--numbering", options->numbering, "the system of the labels")
          ->transform(one_of({"fdi", "universal"}));
  auto* cpu =
      command->add_option("--cpu", options->cpu, "the processor for the loop alone, counted from 0")
          ->check(CLI::NonNegativeNumber);
  // An option without effect is refused as a mistake.
  for (CLI::Option* no_run : {check, explain}) {
    for (CLI::Option* of_a_run : {seconds, allow_missed, record, unpaced, replay, cpu}) {
      no_run->excludes(of_a_run);
    }
  }
  // A replay has no report.
  for (CLI::Option* of_labels : {labels_fixed, labels_held, numbering}) replay->excludes(of_labels);
  for (CLI::Option* of_the_clock : {allow_missed, cpu}) of_the_clock->excludes(unpaced);
  for (CLI::Option* of_a_loop : {seconds, allow_missed, unpaced, cpu}) replay->excludes(of_a_loop);
  add_max_memory(*command, options->max_memory, "each tree, and for all queries together");
  command->add_flag("--json", options->json, "print one JSON object a line");
  add_example(
      *command,
      "Prints how many ticks searched and how many kept pairs, the contact points felt, how late\n"
      "ticks began, how long they took, and the time of each effect.\n"
      "Ctrl-C reduces the force to zero, completes the recording and prints the report, with\n"
      "the exit codes of a run that ends by itself. A second Ctrl-C more than 1 s later\n"
      "completes the recording alone and ends the process within 1 s (exit code 130).\n"
      "Lengths of a recording are metres. docs/scene-reference.md lists the keys of a scene,\n"
      "docs/recording-format.md those of a recording. Scenes to try are in tests/data/scenes,\n"
      "installed in share/doc/ist/examples.\n"
      "Example: ist run scene.toml --seconds 5 --record ticks.jsonl");
  command->callback([options] { run(*options); });
}

}  // namespace ist::cli
