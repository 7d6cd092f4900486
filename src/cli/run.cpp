#include "cli/run.h"

#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli/bodies.h"
#include "cli/commands.h"
#include "cli/interruption.h"
#include "cli/progress_bar.h"
#include "cli/query_options.h"
#include "cli/run_report.h"
#include "cli/tick_lines.h"
#include "ist/haptics/servo_loop.h"
#include "ist/scene/scene_builder.h"
#include "ist/scene/scene_file.h"

namespace ist::cli {
namespace {

// Ticks on their way to the file: some seconds of a disk that does not answer.
constexpr std::size_t kRingTicks = 1 << 14;
constexpr std::size_t kTicksAtOnce = 256;
constexpr std::chrono::milliseconds kNap{5};

struct RunArguments {
  std::filesystem::path scene, record, replay;
  bool check = false, explain = false, unpaced = false, json = false;
  std::optional<double> rate, seconds;
  std::optional<int> cpu;
  std::uint64_t allow_missed = 0;
  std::uint64_t max_memory = BuildOptions{}.max_memory;
};

// Does something where an exception ends its scope.
template <typename Action>
class OnException {
 public:
  explicit OnException(Action action) : action_(std::move(action)) {}
  ~OnException() {
    if (std::uncaught_exceptions() > before_) action_();
  }
  OnException(const OnException&) = delete;
  OnException& operator=(const OnException&) = delete;

 private:
  Action action_;
  int before_ = std::uncaught_exceptions();
};

BuiltScene build(const Scene& scene, std::uint64_t max_memory) {
  Progress progress;
  const ProgressBar bar(progress);
  return build_scene(scene, &progress, max_memory);
}

// Writes what comes out of the ring until it is empty and `last`. Where that fails the loop is
// asked to stop, and does not wait for room.
void write_ticks(TickRing<TickRecord>& ring, TickWriter& writer, const std::atomic<bool>& last,
                 StopOnInterruption& stop) {
  const OnException give_up([&] {
    ring.close();
    stop.ask();
  });
  std::vector<TickRecord> ticks(kTicksAtOnce);
  while (true) {
    const bool was_last = last.load(std::memory_order_acquire);
    const std::size_t count = ring.pop(ticks);
    for (std::size_t i = 0; i < count; ++i) writer.write(ticks[i]);
    if (count == 0 && was_last) return;
    if (count == 0) std::this_thread::sleep_for(kNap);
  }
}

ServoReport run_recorded(BuiltScene& built, const ServoOptions& servo,
                         const std::filesystem::path& file) {
  StopOnInterruption stop;
  Progress progress;
  const ProgressBar bar(progress);
  ServoOutputs outputs;
  outputs.progress = &progress;
  const auto run = [&] {
    return run_servo_loop(*built.simulation, *built.device, servo, outputs, stop.asked());
  };
  if (file.empty()) return run();
  TickWriter writer(file);
  TickRing<TickRecord> ring(kRingTicks);
  outputs.records = &ring;
  std::atomic<bool> last{false};
  // What goes wrong in the thread comes out of get().
  std::future<void> written =
      std::async(std::launch::async, [&] { write_ticks(ring, writer, last, stop); });
  // Without it the thread would wait for more where the loop throws.
  const OnException end([&] { last.store(true, std::memory_order_release); });
  ServoReport report = run();
  last.store(true, std::memory_order_release);
  written.get();
  writer.commit();
  return report;
}

void replay_ticks(BuiltScene& built, const RunArguments& options) {
  TickReader reader(options.replay, built.simulation->dt());
  std::optional<TickWriter> writer;
  if (!options.record.empty()) writer.emplace(options.record);
  Progress progress;
  const ProgressBar bar(progress);
  progress.begin_stage("making the ticks again", reader.bytes());
  std::uint64_t ticks = 0, read = 0;
  while (const std::optional<RecordedTick> recorded = reader.next()) {
    const TickRecord record = replay(*recorded, *built.simulation);
    if (writer) writer->write(record);
    progress.add(reader.bytes_read() - read);
    read = reader.bytes_read();
    ++ticks;
  }
  if (ticks == 0) {
    throw Error(ErrorCode::kInputInvalid,
                fmt::format("{}: it holds no tick: give a file that --record wrote",
                            options.replay.string()));
  }
  if (writer) writer->commit();
  fmt::print(stderr, "replayed {} ticks\n", ticks);
}

// Which no range of numbers keeps out.
void refuse_not_a_number(const std::optional<double>& value, const char* flag) {
  if (value && std::isnan(*value)) throw CLI::ValidationError(flag, "give a number");
}

void run(const RunArguments& options) {
  refuse_not_a_number(options.rate, "--rate");
  refuse_not_a_number(options.seconds, "--seconds");
  keep_inputs(options.record, {options.scene, options.replay});
  Scene scene = read_scene(options.scene);
  for (const SceneBody* body : {&scene.fixed, &scene.held}) {
    const auto* file = std::get_if<std::filesystem::path>(&body->source);
    if (file != nullptr) keep_inputs(options.record, {*file});
  }
  if (const auto* script = std::get_if<ScriptSettings>(&scene.device)) {
    keep_inputs(options.record, {script->file});
  }
  scene.rate = options.rate.value_or(scene.rate);
  scene.seconds = options.seconds.value_or(scene.seconds);
  BuiltScene built = build(scene, options.max_memory);
  print_warnings(built.warnings);
  if (options.explain) return print_notes(built.notes, options.json);
  if (options.check) return;
  if (!options.replay.empty()) return replay_ticks(built, options);

  ServoOptions servo;
  servo.ticks = static_cast<std::uint64_t>(scene.rate * scene.seconds + 0.5);
  servo.paced = !options.unpaced;
  servo.real_time.cpu = options.cpu;
  const ServoReport report = run_recorded(built, servo, options.record);
  print_report(report, scene, *built.simulation, options.json);
  if (report.lost_records > 0) {
    throw std::runtime_error(
        fmt::format("{} ticks were not recorded: the disk is slower than the loop: record to "
                    "another one, or at a lower --rate",
                    report.lost_records));
  }
  if (report.missed > options.allow_missed) {
    throw DeadlinesMissed(fmt::format(
        "{} deadlines were missed, and {} are allowed: use larger voxels or a lower --rate, or "
        "allow more with --allow-missed",
        report.missed, options.allow_missed));
  }
}

}  // namespace

void add_run(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("run", "Run the servo loop of a scene: what a hand feels, tick by tick");
  const auto options = std::make_shared<RunArguments>();
  command->add_option("SCENE", options->scene, "the scene, a TOML file")->required();
  auto* check = command->add_flag("--check", options->check,
                                  "read and build the scene, say what is wrong, and end");
  auto* explain = command->add_flag("--explain", options->explain,
                                    "print what is built and what is skipped, and why, and end");
  check->excludes(explain);
  command->add_option("--rate", options->rate, "ticks a second, instead of the scene's")
      ->check(CLI::Range(1.0, 10000.0));
  auto* seconds =
      command->add_option("--seconds", options->seconds, "how long, instead of the scene's")
          ->check(CLI::Range(1e-3, 1e6));
  auto* allow_missed =
      command->add_option("--allow-missed", options->allow_missed, "deadlines that may be missed")
          ->check(whole_number("how many deadlines"));
  auto* record =
      command->add_option("--record", options->record,
                          "write every tick to this file: JSON lines, or CSV if it ends in .csv");
  auto* unpaced = command->add_flag(
      "--unpaced", options->unpaced,
      "one tick after the other, without waiting and without deadlines; the same on every machine");
  auto* replay = command->add_option(
      "--replay", options->replay,
      "make the ticks of a JSON recording of this scene again: the same numbers, but for the "
      "times");
  auto* cpu =
      command->add_option("--cpu", options->cpu, "the processor for the loop alone, counted from 0")
          ->check(CLI::NonNegativeNumber);
  // What would have no effect is a mistake.
  for (CLI::Option* no_run : {check, explain}) {
    for (CLI::Option* of_a_run : {seconds, allow_missed, record, unpaced, replay, cpu}) {
      no_run->excludes(of_a_run);
    }
  }
  for (CLI::Option* of_the_clock : {allow_missed, cpu}) of_the_clock->excludes(unpaced);
  for (CLI::Option* of_a_loop : {seconds, allow_missed, unpaced, cpu}) replay->excludes(of_a_loop);
  add_max_memory(*command, options->max_memory);
  command->add_flag("--json", options->json, "print one JSON object a line");
  add_example(
      *command,
      "Prints how late ticks began, how long they took, and what each effect took of it.\n"
      "Ctrl-C brings the device to no force and closes the recording, whole.\n"
      "Lengths of a recording are metres, but for gaps, which are in mesh units. README.md\n"
      "lists the keys of a scene and of a recording; tests/data/scenes has scenes to try.\n"
      "Example: ist run scene.toml --seconds 5 --record ticks.jsonl");
  command->callback([options] { run(*options); });
}

}  // namespace ist::cli
