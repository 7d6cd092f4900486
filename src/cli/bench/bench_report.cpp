#include "cli/bench/bench_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/answers/json_text.h"
#include "cli/bench/ratios.h"
#include "cli/version.h"

namespace ist::cli {
namespace {

using nlohmann::ordered_json;

constexpr int kNameWidth = 42;
// The time taken over the time given. Where three turns fit, the last turn exceeds it by less.
constexpr double kInTime = 1.1;

// Puts a comma before every three digits of the whole number.
std::string grouped(std::string number) {
  for (std::size_t at = std::min(number.find('.'), number.size()); at > 3;) {
    at -= 3;
    number.insert(at, 1, ',');
  }
  return number;
}

std::string three_digits(double value) {
  return grouped(fmt::format("{:.{}f}", value, value < 10 ? 2 : value < 100 ? 1 : 0));
}

std::string counted(const std::optional<std::uint64_t>& listed) {
  return listed ? grouped(std::to_string(*listed)) : "";
}

double times_as_fast(const Contest& contest, const Ratio& ratio, std::size_t pose) {
  return contest.score(ratio.over, pose).times.median() /
         contest.score(ratio.of, pose).times.median();
}

void print_head(const std::string& title, const Contest& contest, const char* last) {
  fmt::print("\n{:<{}}", title, kNameWidth);
  for (const BenchPose& pose : contest.poses()) fmt::print(" {:>14}", pose.words);
  fmt::print("   {}\n", last);
}

void print_ratios(const Contest& contest) {
  for (const RatioGroup& group : ratios_of(contest.contestants())) {
    fmt::print("\n{}\n", group.title);
    for (const Ratio& ratio : group.ratios) {
      fmt::print("  {:<{}}", ratio.words, kNameWidth - 2);
      for (std::size_t pose = 0; pose < contest.poses().size(); ++pose) {
        fmt::print(" {:>14}", three_digits(times_as_fast(contest, ratio, pose)));
      }
      const auto &a = contest.score(ratio.of, 0).listed, &b = contest.score(ratio.over, 0).listed;
      fmt::print("{}\n", a && b ? fmt::format("   {} and {}", counted(a), counted(b)) : "");
    }
  }
}

std::string name_of(const Contestant& contestant) {
  std::string name = fmt::format("{}, {}", contestant.question, contestant.way);
  if (!contestant.spheres.empty()) name += ", " + contestant.spheres;
  if (contestant.workers == 2) name += ", two workers";
  return name;
}

std::string loop_words(const Samples& loop) {
  return fmt::format("a fixed loop took {:.0f} to {:.0f} µs", loop.quantile(0.05),
                     loop.quantile(0.95));
}

std::string machine_words(const BenchSetting& setting, const Samples& loop) {
  const Machine& machine = setting.machine;
  std::string words = fmt::format("{}, {} core{}, governor {}", machine.processor, machine.cores,
                                  machine.cores == 1 ? "" : "s",
                                  machine.governor.empty() ? "unknown" : machine.governor);
  if (machine.load) {
    words += fmt::format("; load before {:.1f}, {:.1f}, {:.1f}", (*machine.load)[0],
                         (*machine.load)[1], (*machine.load)[2]);
  }
  return words + "; " + loop_words(loop);
}

}  // namespace

std::string bench_heading(const BenchSetting& setting, const Samples& loop, double taken) {
  std::string lines = fmt::format("{}, {}, {}\n{}\n{}\n", version_words(), compiler_words(),
                                  setting.target, machine_words(setting, loop), setting.bodies);
  if (!setting.rivals.empty()) lines += fmt::format("beside {}, in one thread\n", setting.rivals);
  if (const auto noise = noise_of(setting.machine, loop)) {
    lines += fmt::format("not a quiet machine: {}\n", *noise);
  }
  if (taken > kInTime * setting.seconds) {
    lines += fmt::format("took {:.1f} s instead of {:g}: three turns of each query are the least\n",
                         taken, setting.seconds);
  }
  return lines;
}

void print_bench(const BenchSetting& setting, const Contest& contest) {
  fmt::print("{}", bench_heading(setting, contest.loop(), contest.taken()));
  print_head("times as fast, one worker unless stated", contest,
             "lists, closed: IST and the other");
  print_ratios(contest);
  print_head("µs a query: median", contest, "lists");
  for (std::size_t i = 0; i < contest.contestants().size(); ++i) {
    fmt::print("  {:<{}}", name_of(contest.contestants()[i]), kNameWidth - 2);
    for (std::size_t pose = 0; pose < contest.poses().size(); ++pose) {
      fmt::print(" {:>14}", three_digits(contest.score(i, pose).times.median()));
    }
    fmt::print("   {}\n", counted(contest.score(i, 0).listed));
  }
}

void print_bench_json(const BenchSetting& setting, const Contest& contest) {
  const Machine& machine = setting.machine;
  const auto noise = noise_of(machine, contest.loop());
  ordered_json line{
      {"processor", machine.processor},
      {"cores", machine.cores},
      {"governor", nullptr},
      {"load", nullptr},
      {"loop_microseconds",
       {contest.loop().quantile(0.05), contest.loop().median(), contest.loop().quantile(0.95)}},
      {"quiet", !noise},
      {"noise", nullptr},
      {"compiler", compiler_words()},
      {"target", setting.target},
      {"seconds", contest.taken()},
      {"bodies", setting.bodies}};
  if (!machine.governor.empty()) line["governor"] = machine.governor;
  if (machine.load) line["load"] = *machine.load;
  if (noise) line["noise"] = *noise;
  print_json(line);
  for (const RatioGroup& group : ratios_of(contest.contestants())) {
    for (const Ratio& ratio : group.ratios) {
      for (std::size_t pose = 0; pose < contest.poses().size(); ++pose) {
        line = {{"ratio", ratio.words},
                {"of", name_of(contest.contestants()[ratio.of])},
                {"over", name_of(contest.contestants()[ratio.over])},
                {"at", contest.poses()[pose].key},
                {"times", times_as_fast(contest, ratio, pose)}};
        print_json(line);
      }
    }
  }
  for (std::size_t i = 0; i < contest.contestants().size(); ++i) {
    const Contestant& asked = contest.contestants()[i];
    for (std::size_t pose = 0; pose < contest.poses().size(); ++pose) {
      const Score& score = contest.score(i, pose);
      line = {{"question", asked.question},
              {"way", asked.way},
              {"spheres", nullptr},
              {"workers", asked.workers},
              {"at", contest.poses()[pose].key},
              {"listed", nullptr},
              {"microseconds_median", score.times.median()},
              {"microseconds_p99", score.times.quantile(0.99)},
              {"samples", score.times.size()}};
      if (!asked.spheres.empty()) line["spheres"] = asked.spheres;
      if (score.listed) line["listed"] = *score.listed;
      print_json(line);
    }
  }
}

}  // namespace ist::cli
