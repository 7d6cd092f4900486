#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/commands/reports.h"
#include "cli/terminal.h"
#include "ist/base/counted.h"

namespace ist::cli {
namespace {

constexpr std::pair<const char*, double> kQuantiles[] = {
    {"p50", 0.5}, {"p99", 0.99}, {"p99.9", 0.999}, {"p99.99", 0.9999}};

double microseconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double, std::micro>(time).count();
}

nlohmann::ordered_json as_json(const LatencyHistogram& times) {
  nlohmann::ordered_json json;
  for (const auto& [name, part] : kQuantiles) json[name] = microseconds(times.quantile(part));
  json["max"] = microseconds(times.max());
  return json;
}

nlohmann::ordered_json as_json(const ToothForces& teeth, const Simulation& simulation) {
  auto json = nlohmann::ordered_json::array();
  for (const ToothForces::Tooth& tooth : teeth.teeth()) {
    json.push_back({{"body", std::string(simulation.body_name(tooth.body))},
                    {"tooth", tooth.number},
                    {"ticks", tooth.ticks},
                    {"mean_force", tooth.mean()},
                    {"largest_force", tooth.largest}});
  }
  return json;
}

// Prints the teeth that were touched.
void print_teeth(const ToothForces& teeth, const Simulation& simulation) {
  fmt::print("\n{:<20}{:>8}{:>10}{:>10}{:>10}\n", "forces on teeth, N", "tooth", "ticks", "mean",
             "largest");
  for (const ToothForces::Tooth& tooth : teeth.teeth()) {
    if (tooth.ticks == 0) continue;
    fmt::print("{:<20}{:>8}{:>10}{:>10.3g}{:>10.3g}\n", simulation.body_name(tooth.body),
               tooth.number, tooth.ticks, tooth.mean(), tooth.largest);
  }
}

void print_row(const char* name, const LatencyHistogram& times) {
  fmt::print("{:<12}", name);
  for (const auto& [label, part] : kQuantiles) {
    fmt::print("{:>10.1f}", microseconds(times.quantile(part)));
  }
  fmt::print("{:>10.1f}\n", microseconds(times.max()));
}

// Prints the counts by octaves of microseconds as bars: the longest has 40 marks, and every count
// above 0 at least one.
void print_bars(const LatencyHistogram& times) {
  constexpr double kLongest = 40;
  std::vector<std::uint64_t> octaves;
  std::uint64_t before = 0, most = 0;
  for (std::int64_t end = 1000; before < times.count(); end *= 2) {
    const std::uint64_t upto = times.count_upto(std::chrono::nanoseconds(end));
    octaves.push_back(upto - before);
    most = std::max(most, octaves.back());
    before = upto;
  }
  bool begun = false;
  for (std::size_t i = 0; i < octaves.size(); ++i) {
    begun = begun || octaves[i] > 0;
    if (!begun) continue;
    const double length =
        kLongest * static_cast<double>(octaves[i]) / static_cast<double>(most) + 0.999;
    fmt::print("  up to {:>7} µs {:>9} {}\n", std::uint64_t{1} << i, octaves[i],
               std::string(static_cast<std::size_t>(length), '#'));
  }
}

}  // namespace

void print_notes(const std::vector<BuildNote>& notes, bool json) {
  for (const BuildNote& note : notes) {
    if (json) {
      print_json({{"what", note.what},
                  {"built", note.built},
                  {"why", note.why},
                  {"milliseconds", note.milliseconds},
                  {"bytes", note.bytes}});
    } else if (note.built) {
      fmt::print("built    {:<18} {:>8.1f} ms {:>8.1f} MB  {}\n", note.what, note.milliseconds,
                 1e-6 * static_cast<double>(note.bytes), note.why);
    } else {
      fmt::print("skipped  {:<18} {:>24}  {}\n", note.what, "", note.why);
    }
  }
}

void print_report(const ServoReport& report, const Scene& scene, const Simulation& simulation,
                  const ToothForces* teeth, bool json) {
  const double ticks = static_cast<double>(std::max<std::uint64_t>(report.ticks, 1));
  if (json) {
    nlohmann::ordered_json line{{"ticks", report.ticks},
                                {"rate", scene.rate},
                                {"missed", report.missed},
                                {"held", report.held},
                                {"halved", report.halved},
                                {"in_contact", report.in_contact},
                                {"most_points", report.most_points},
                                {"largest_point_force", report.largest_point_force},
                                {"faults", report.faults},
                                {"fresh", report.fresh},
                                {"kept", report.kept},
                                {"clear", report.clear},
                                {"late_microseconds", as_json(report.late)},
                                {"microseconds", as_json(report.execution)},
                                {"cpu_microseconds", as_json(report.cpu)},
                                {"worst_cpu_microseconds", microseconds(report.worst_cpu)},
                                {"worst_effects_microseconds", microseconds(report.worst_effects)},
                                {"effects", nlohmann::ordered_json::object()},
                                {"changes", nlohmann::ordered_json::array()},
                                {"notes", report.notes}};
    for (const EffectTime& effect : simulation.effects()) {
      line["effects"][std::string(effect.name)] = microseconds(effect.time) / ticks;
    }
    for (const HandChange& change : simulation.changes()) {
      line["changes"].push_back(
          {{"time", change.time},
           {change.attach ? "attach" : "release", std::string(simulation.body_name(change.body))},
           {"status", to_string(change.status)}});
    }
    if (teeth != nullptr) line["teeth"] = as_json(*teeth, simulation);
    print_json(line);
    return;
  }
  for (const std::string& note : report.notes) fmt::print(stderr, "note: {}\n", note);
  fmt::print("{} of {:.4g} µs: {} missed, {} held, {}\n", counted(report.ticks, "tick"),
             1e6 / scene.rate, counted(report.missed, "deadline"), counted(report.held, "tick"),
             counted(report.faults, "fault"));
  if (report.fresh + report.kept + report.clear > 0) {
    fmt::print("contacts: {} by a search, {} among the pairs kept, {} inside a clearance\n",
               counted(report.fresh, "tick"), report.kept, report.clear);
  }
  if (report.steps > 0) {
    fmt::print(
        "contact points: {} with any, at most {} at once, at most {:.3g} N at one; {} halved\n",
        counted(report.in_contact, "tick"), report.most_points, report.largest_point_force,
        counted(report.halved, "tick"));
  }
  for (const HandChange& change : simulation.changes()) {
    fmt::print("{:.4g} s: {} {}: {}\n", change.time, change.attach ? "attach" : "release",
               simulation.body_name(change.body), to_string(change.status));
  }
  if (teeth != nullptr) print_teeth(*teeth, simulation);
  fmt::print("\n");
  fmt::print("{:<12}", "µs");
  for (const auto& [name, part] : kQuantiles) fmt::print("{:>10}", name);
  fmt::print("{:>10}\n", "max");
  print_row("began late", report.late);
  print_row("took", report.execution);
  print_row("processor", report.cpu);
  fmt::print("\nticks by duration\n");
  print_bars(report.execution);
  for (const EffectTime& effect : simulation.effects()) {
    fmt::print("{}{} {:.2f} µs",
               &effect == simulation.effects().data() ? "\neffects, a tick: " : ", ", effect.name,
               microseconds(effect.time) / ticks);
  }
  if (simulation.effects().empty()) return;
  fmt::print("\nthe tick with the most processor time: {:.1f} µs, of which effects {:.1f} µs\n",
             microseconds(report.worst_cpu), microseconds(report.worst_effects));
}

}  // namespace ist::cli
