#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "answers/measure_progress.h"
#include "answers/refusals.h"
#include "cli/commands/commands.h"
#include "cli/common_options.h"
#include "cli/exit_code.h"
#include "cli/interruption.h"
#include "cli/progress_bar.h"
#include "cli/sweeps/part_words.h"
#include "ist/base/cancellation.h"
#include "ist/base/counted.h"
#include "ist/base/throw_error.h"
#include "sweep/merge_parts.h"
#include "sweep/sweep.h"

namespace ist::cli {

using namespace answers;

namespace {

struct SweepArguments {
  std::filesystem::path file, folder;
  std::string share = "0/1";
  std::uint64_t threads = 0;
  bool merge = false, status = false, verify = false, json = false;
};

struct Share {
  std::uint64_t first, step;
};

Share share_of(const std::string& text) {
  const std::size_t slash = text.find('/');
  const auto number = [&](const std::string& digits) -> std::uint64_t {
    const bool plain = !digits.empty() && digits.size() <= 9 &&
                       digits.find_first_not_of("0123456789") == std::string::npos;
    refuse_if(!plain, "--share", "{} is no share: give k/N, two whole numbers, k from 0 to N - 1",
              text);
    return std::stoull(digits);
  };
  refuse_if(slash == std::string::npos, "--share", "{} is no share: give k/N, such as 0/4", text);
  const Share share{number(text.substr(0, slash)), number(text.substr(slash + 1))};
  refuse_if(share.first >= share.step, "--share", "{} is no share: k is from 0 to N - 1", text);
  return share;
}

// Shows how far a part is, until a signal asks to end.
Proceed proceed_until(const std::atomic<bool>& asked, const Proceed& shown) {
  return [&asked, shown](double part) {
    shown(part);
    return !asked.load(std::memory_order_relaxed);
  };
}

struct Made {
  std::vector<std::uint64_t> made, there, given_up;
};

// Makes the parts of a share, one after the other, a line each.
Made run_share(const Sweep& sweep, const SweepArguments& options, const Share& share) {
  const SweepFolder folder = sweep.open_folder(options.folder);
  StopOnInterruption stop;
  const ScopedCancellation cancellation(stop.asked());
  Made result;
  ShareEstimate estimate(
      share.first < sweep.parts() ? (sweep.parts() - share.first - 1) / share.step + 1 : 0);
  for (std::uint64_t part = share.first; part < sweep.parts(); part += share.step) {
    const auto begin = std::chrono::steady_clock::now();
    const std::string stage = fmt::format("part {} of {}", part, sweep.parts());
    const Sweep::Outcome outcome = [&] {
      ProgressBar bar;
      return sweep.run_part(folder, part, options.threads,
                            proceed_until(stop.asked(), shown_by(bar, stage.c_str())));
    }();
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    switch (outcome) {
      case Sweep::Outcome::kStopped:
        throw Failure(kInterrupted,
                      fmt::format("interrupted: {} made, and part {} left no file",
                                  counted(result.made.size(), "part was", "parts were"), part));
      case Sweep::Outcome::kWasThere:
        estimate.skip();
        result.there.push_back(part);
        break;
      case Sweep::Outcome::kGivenUp:
        estimate.skip();
        result.given_up.push_back(part);
        break;
      case Sweep::Outcome::kMade:
        estimate.add(spent.count());
        result.made.push_back(part);
        fmt::print(stderr, "part {}: {} in {}; {}\n", part,
                   counted(folder.identity().rows_of(part), "row"), duration_text(spent.count()),
                   estimate.text());
    }
  }
  return result;
}

void run(const SweepArguments& options, const Sweep& sweep) {
  const Made made = run_share(sweep, options, share_of(options.share));
  if (options.json) {
    print_json(sweep, {{"made", made.made}, {"there", made.there}, {"given_up", made.given_up}});
  } else {
    fmt::print("parts   made {}, there before {}, given up {}\n", made.made.size(),
               made.there.size(), made.given_up.size());
  }
  if (made.given_up.empty()) return;
  throw Failure(kFailed, given_up_text(made.given_up));
}

void merge(const SweepArguments& options, const Sweep& sweep) {
  const SweepFolder folder(options.folder, sweep.identity(), sweep.layout(),
                           SweepFolder::Access::kRead);
  const MergeResult merged = [&] {
    ProgressBar bar;
    return merge_parts(folder, sweep.layout(), shown_by(bar, "merging parts"));
  }();
  if (options.json) {
    print_json(sweep,
               {{"rows", merged.rows}, {"missing", merged.missing}, {"given_up", merged.given_up}});
  } else if (merged.whole()) {
    fmt::print("rows    {} in {}\n", merged.rows, (options.folder / "rows.npy").string());
  }
  std::string lacks;
  if (!merged.missing.empty()) {
    lacks = fmt::format("parts are missing, and nothing was merged: {}", ranges(merged.missing));
  }
  if (!merged.given_up.empty()) {
    lacks += (lacks.empty() ? "" : "\nist: ") + given_up_text(merged.given_up);
  }
  if (!lacks.empty()) throw Failure(kFailed, lacks);
}

void show_status(const SweepArguments& options, const Sweep& sweep) {
  const FolderStatus status = [&] {
    ProgressBar bar;
    return status_of(sweep, options.folder, options.verify, shown_by(bar, "looking at parts"));
  }();
  print_status(sweep, status, options.json);
  if (status.damaged.empty()) return;
  throw_error(ErrorCode::kInputInvalid,
              "{}: parts are damaged: remove their files to make them anew: {}",
              options.folder.string(), ranges(status.damaged));
}

}  // namespace

void add_sweep(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "sweep", "Ask the same at millions of poses, in parts that any process may make");
  const auto options = std::make_shared<SweepArguments>();
  add_file(*command, "SWEEP", options->file, "sweep file (.toml): trees, poses and questions")
      ->required();
  command
      ->add_option("-o,--output", options->folder, "folder of the parts, made where it is missing")
      ->type_name("FOLDER")
      ->required();
  auto* share = command
                    ->add_option("--share", options->share,
                                 "make the parts i with i mod N = k, k from 0: one process of N")
                    ->type_name("K/N")
                    ->capture_default_str();
  auto* threads = command->add_option("--threads", options->threads, "0: one for each core")
                      ->check(whole_number("a number of threads"))
                      ->check(CLI::Range(0, 1024))
                      ->capture_default_str();
  auto* merge_flag = command->add_flag(
      "--merge", options->merge, "merge all parts into rows.npy; exit code 1 if a part is missing");
  auto* status = command->add_flag("--status", options->status, "list how the parts stand");
  command->add_flag("--verify", options->verify, "compare the checksums of all parts too")
      ->needs(status);
  command->add_flag("--json", options->json, "print the result as JSON");
  merge_flag->excludes(status)->excludes(share)->excludes(threads);
  status->excludes(share)->excludes(threads);
  add_example(*command,
              "A part that is there stays. One that was begun and lost three times is given up.\n"
              "Examples: ist sweep job.toml -o job --threads 8\n"
              "          ist sweep job.toml -o job --share 3/16\n"
              "          ist sweep job.toml -o job --merge\n"
              "docs/sweeps.md describes the sweep file, and how dask, Slurm and GNU parallel run "
              "shares.");
  command->callback([options] {
    static_cast<void>(share_of(options->share));
    const Sweep sweep(options->file);
    if (options->merge) return merge(*options, sweep);
    if (options->status) return show_status(*options, sweep);
    run(*options, sweep);
  });
}

}  // namespace ist::cli
