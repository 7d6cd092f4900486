#include "cli/answer_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <string_view>

#include "cli/terminal.h"
#include "ist/base/counted.h"
#include "ist/measure/first_contact.h"

namespace ist::cli {

using namespace answers;

namespace {

std::string word_of(Answer touch, int width) {
  switch (touch) {
    case Answer::kYes:
      return painted(fmt::format("{:<{}}", "yes", width), TextColour::kRed);
    case Answer::kNear:
      return painted(fmt::format("{:<{}}", "near", width), TextColour::kYellow);
    case Answer::kUnknown:
      return painted(fmt::format("{:<{}}", "unknown", width), TextColour::kYellow);
    default:
      return fmt::format("{:<{}}", "no", width);
  }
}

std::string words_of(const DistanceInterval& interval) {
  if (interval.upper == 0) return "0";
  return fmt::format("{:.6g} to {:.6g}", interval.lower, interval.upper);
}

std::string words_of(const Eigen::Vector3d& point) {
  return fmt::format("({:.5g}, {:.5g}, {:.5g})", point[0], point[1], point[2]);
}

std::string depth_of(const Findings& found) {
  const Depth& depth = found.depth;
  if (depth.certain) return words_of(*depth.certain);
  if (!depth.at_vertices) return depth.area ? "not known (open surface)" : "-";
  if (*depth.at_vertices == 0) return "0";
  return fmt::format("at least {:.3g} (open surface, by vertices)", *depth.at_vertices);
}

// A translation as a vector; another motion as a screw.
std::string words_of(const Escape& escape, const Eigen::Isometry3d& pose) {
  switch (escape.status) {
    case Escape::Status::kNotNeeded:
      return "0: the bodies are free";
    case Escape::Status::kFound:
      break;
    default:
      return fmt::format("at least {:.6g}: no motion was found", escape.lower);
  }
  const std::string length = words_of(DistanceInterval{escape.lower, escape.upper});
  if (escape.rotation.isIdentity(0)) {
    return fmt::format("{} by {}", length, words_of(escape.translation));
  }
  const Motion screw = Motion::between(pose, escape.pose());
  return fmt::format("{} by {:.4g} degrees about {} through {}, and {:.4g} along it", length,
                     screw.angle() * 180 / std::numbers::pi, words_of(screw.axis()),
                     words_of(screw.point()), screw.along());
}

std::string words_of(const std::optional<double>& number) {
  return number ? fmt::format("{:.4g}", *number) : "-";
}

std::string words_of(const std::optional<std::uint64_t>& count) {
  return count ? fmt::format("{}", *count) : "-";
}

std::string inside_of(const Findings& found) {
  if (!found.inside || *found.inside == Inside::kNone) return {};
  return fmt::format("the {} body is inside", to_string(*found.inside));
}

// The notes of more than one row, which are printed once, below the rows.
std::vector<std::string> shared_notes(const std::vector<PoseAnswer>& answers) {
  std::map<std::string_view, int> rows;
  std::vector<std::string> shared;
  for (const PoseAnswer& answer : answers) {
    for (const std::string& note : answer.findings.notes) {
      if (++rows[note] == 2) shared.push_back(note);
    }
  }
  return shared;
}

// Notes of this row alone, which body lies in the other, and the escape.
std::string rest_of(const PoseAnswer& answer, const std::vector<std::string>& shared) {
  const Findings& found = answer.findings;
  std::string rest = inside_of(found);
  if (found.escape) {
    rest += (rest.empty() ? "escape " : "; escape ") + words_of(*found.escape, answer.pose);
  }
  for (const std::string& note : found.notes) {
    if (std::find(shared.begin(), shared.end(), note) != shared.end()) continue;
    rest += (rest.empty() ? "" : "; ") + note;
  }
  return rest;
}

void print_one(const PoseAnswer& answer, const Bodies& bodies) {
  const Findings& found = answer.findings;
  const auto line = [](const char* name, const std::string& value) {
    fmt::print("{:<10} {}\n", name, value);
  };
  line("touch", word_of(found.touch, 0));
  line("distance", found.distance ? words_of(*found.distance) : "-");
  if (found.nearest && found.nearest->distance > 0) {
    line("nearest", fmt::format("{} and {}", words_of(found.nearest->fixed_point),
                                words_of(found.nearest->moving_point)));
  }
  std::string depth = depth_of(found);
  if (found.depth.point) depth += " at " + words_of(*found.depth.point);
  line("depth", depth);
  if (found.escape) line("escape", words_of(*found.escape, answer.pose));
  line("area", words_of(found.depth.area));
  if (found.triangle_pairs)
    line("triangles", counted(*found.triangle_pairs, "pair meets", "pairs meet"));
  if (const std::string inside = inside_of(found); !inside.empty()) line("inside", inside);
  for (const std::string& note : found.notes) line("note", note);
  if (found.distance && found.distance->lower > 0.5 * bodies.extent()) {
    line("note",
         "far apart: the bodies are probably not in one coordinate system: register them first, or "
         "give a pose");
  }
}

void print_rows(const std::vector<PoseAnswer>& answers) {
  const bool path = answers.front().displacement.has_value();
  const bool triangles = answers.front().findings.triangle_pairs.has_value();
  const std::vector<std::string> shared = shared_notes(answers);
  std::size_t wide = 8;  // of depth, which may be a sentence
  for (const PoseAnswer& answer : answers) {
    wide = std::max(wide, depth_of(answer.findings).size());
  }
  fmt::print("{:>12} {:<7} {:<24} {:<{}} {:>9}{}\n", path ? "displacement" : "index", "touch",
             "distance", "depth", wide, "area", triangles ? " triangles" : "");
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const Findings& found = answers[i].findings;
    fmt::print("{:>12} {} {:<24} {:<{}} {:>9}",
               path ? fmt::format("{:.6g}", *answers[i].displacement) : fmt::format("{}", i),
               word_of(found.touch, 7), found.distance ? words_of(*found.distance) : "-",
               depth_of(found), wide, words_of(found.depth.area));
    if (triangles) fmt::print(" {:>9}", words_of(found.triangle_pairs));
    const std::string rest = rest_of(answers[i], shared);
    fmt::print("{}{}\n", rest.empty() ? "" : "  ", rest);
  }
  for (const std::string& note : shared) fmt::print("note: {}\n", note);
}

void print_times(const Engines& engines, const Bodies& bodies,
                 const std::vector<PoseAnswer>& answers) {
  fmt::print("\nspheres {}, voxel size {:.6g} and {:.6g}", to_string(bodies.policy),
             bodies.fixed.voxel_size(), bodies.moving.voxel_size());
  for (const Engine& engine : engines) {
    fmt::print("; {}: {}, {}", engine.name(), engine.target(), counted(engine.workers(), "worker"));
  }
  fmt::print("\n{:>5}  {:<10} {:>10} {:>12} {:>12} {:>10} {:>10}\n", "index", "engine",
             "leaf pairs", "tests", "median µs", "min µs", "rate Hz");
  for (std::size_t i = 0; i < answers.size(); ++i) {
    for (std::size_t e = 0; e < engines.size(); ++e) {
      const EngineAnswer& timed = answers[i].engines[e];
      fmt::print(
          "{:>5}  {:<10} {:>10} {:>12} {:>12.1f} {:>10.1f} {:>10.0f}{}\n", i, engines[e].name(),
          timed.result.leaf_pairs, timed.result.sphere_tests, timed.median(), timed.fastest(),
          1e6 / timed.median(),
          timed.result.complete ? "" : fmt::format("  stopped at level {}", timed.result.level));
    }
  }
}

}  // namespace

void print_answer_lines(const Engines& engines, const Bodies& bodies,
                        const std::vector<PoseAnswer>& answers) {
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (engines.empty()) print_json(answer_line(i, answers[i], std::nullopt, bodies));
    for (std::size_t e = 0; e < engines.size(); ++e) {
      print_json(answer_line(i, answers[i], LeafAnswer{engines[e], answers[i].engines[e]}, bodies));
    }
  }
}

void print_answers(const Engines& engines, const Bodies& bodies,
                   const std::vector<PoseAnswer>& answers, bool timing) {
  const bool one = answers.size() == 1 && !answers.front().displacement;
  one ? print_one(answers.front(), bodies) : print_rows(answers);
  if (timing) print_times(engines, bodies, answers);
}

}  // namespace ist::cli
