#include "cli/occlusion/bite_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "answers/occlusion/bite_hints.h"
#include "answers/occlusion/bite_numbers.h"
#include "cli/terminal.h"
#include "ist/base/counted.h"

namespace ist::cli {

using namespace answers;

namespace {

// How far apart, and how deep: of a body that lies inside the other both are known.
std::string first_line(const Bite& bite) {
  const Findings& found = bite.findings;
  const BiteNumbers numbers(bite);
  const bool yes = found.touch == Answer::kYes;
  std::string line = "touch " + (yes ? painted("yes", TextColour::kRed) : to_string(found.touch));
  if (found.inside && *found.inside != Inside::kNone) {
    line += fmt::format(", the {} body lies inside the other", to_string(*found.inside));
  }
  if (!yes) line += fmt::format(", {} apart", numbers.millimetres(*found.distance));
  const Depth& depth = found.depth;
  if (depth.certain && depth.certain->upper > 0) {
    line += fmt::format(", {} deep", numbers.millimetres(*depth.certain));
  } else if (!bite.known_depth(depth.at_vertices.value_or(0))) {
    line += ", depth not known (open surface)";
  } else if (!depth.certain && depth.at_vertices > 0.0) {
    line += fmt::format("{} at least {} deep (open surface, by vertices)", yes ? "," : ", or",
                        numbers.millimetres(*depth.at_vertices));
  }
  return line + fmt::format(" (± {} assumed for scanning)",
                            BiteNumbers::in_millimetres(1e-3 * bite.scanner_band));
}

std::string second_line(const Bite& bite) {
  const BiteNumbers numbers(bite);
  std::string areas;
  for (std::size_t i = 0; i < bite.fixed.areas.size(); ++i) {
    const double limit = bite.preset->micrometres[i];
    areas += fmt::format(
        "{}{} {} and {} mm²", areas.empty() ? "" : ", ",
        limit > 0 ? fmt::format("within {:g} µm or overlapping", limit) : "in each other",
        numbers.area(bite.fixed.areas[i]), numbers.area(bite.moving.areas[i]));
    if (limit == 0) continue;
    areas +=
        fmt::format(" ({} and {} without the overlap{})", numbers.area(bite.fixed.area_outside(i)),
                    numbers.area(bite.moving.area_outside(i)),
                    limit < bite.scanner_band ? "; below the error assumed for scanning" : "");
  }
  const std::size_t count = bite.contacts.size();
  const std::string contacts =
      count == 0 ? ""  // print_contacts() says so
                 : fmt::format("; {}, {} of them on one body alone", counted(count, "contact"),
                               count - bite.fixed.on_both);
  return fmt::format("areas, {} ({}): {}{}", bite.preset->name, bite.preset->source, areas,
                     contacts);
}

}  // namespace

void print_bite(const Bite& bite, std::span<const std::filesystem::path> written) {
  std::string last = "checks: ";
  for (const std::string& check : bite.checks) last += check + "; ";
  last += written.empty() ? "nothing written" : "wrote";
  for (const std::filesystem::path& file : written) last += " " + file.string();
  if (bite.warning) fmt::print("{}\n", *bite.warning);
  fmt::print("{}\n", first_line(bite));
  if (!bite.warning) fmt::print("{}\n", second_line(bite));
  if (bite.region) fmt::print("{}\n", region_words(bite));
  if (bite.hint) fmt::print("hint: {}\n", *bite.hint);
  fmt::print("{}\n", last);
}

void print_contacts(const Bite& bite) {
  constexpr std::size_t kMost = 40;
  if (bite.contacts.empty()) return fmt::print("No contacts.\n");
  const BiteNumbers numbers(bite);
  fmt::print("{:>7}  {:>6}  {:>9}  {:>18}  {:>8}  closest at, {}\n", "contact", "on", "area, mm²",
             "least distance, µm", "share, %", bite.unit);
  for (std::size_t i = 0; i < std::min(bite.contacts.size(), kMost); ++i) {
    const BiteContact& contact = bite.contacts[i];
    const char* on = contact.on_both() ? "both" : contact.moving.empty() ? "fixed" : "moving";
    fmt::print("{:>7}  {:>6}  {:>9}  {:>18}  {:>8}  {}\n", i + 1, on, numbers.area(contact.area),
               numbers.micrometres(contact.least_distance),
               BiteNumbers::percent(100 * contact.share), numbers.place(contact.closest));
  }
  if (bite.contacts.size() > kMost) {
    fmt::print("… and {} more: -o bite.csv holds them all\n", bite.contacts.size() - kMost);
  }
  const bool all_on_both = std::all_of(bite.contacts.begin(), bite.contacts.end(),
                                       [](const BiteContact& each) { return each.on_both(); });
  if (!all_on_both) fmt::print("share: {}\n", kSharesOnOneBody);
}

}  // namespace ist::cli
