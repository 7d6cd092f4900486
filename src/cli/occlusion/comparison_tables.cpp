#include "cli/occlusion/comparison_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "answers/occlusion/bite_numbers.h"
#include "ist/base/counted.h"

namespace ist::cli {

using namespace answers;

namespace {

constexpr double kDegreesInRadian = 180 / std::numbers::pi;
constexpr std::size_t kMostLines = 40;

// With a sign, unless it is 0.
std::string signed_text(double number, int decimals) {
  const std::string text = fmt::format("{:+.{}f}", number, decimals);
  return text.find_first_of("123456789") == text.npos ? text.substr(1) : text;
}

// Numbers to a hundredth of a millimetre, as one writes a vector.
std::string vector_text(const Eigen::Vector3d& v, double factor, int decimals) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    text += (axis == 0 ? "(" : ", ") + signed_text(factor * v[axis], decimals);
  }
  return text + ")";
}

std::string axis_text(const Eigen::Vector3d& axis) {
  std::string text;
  for (int i = 0; i < 3; ++i) {
    const double rounded = std::round(1000 * axis[i]) / 1000;
    text += fmt::format("{}{:g}", i == 0 ? "(" : ", ", rounded == 0 ? 0.0 : rounded);
  }
  return text + ")";
}

void print_motion(const BiteComparison& made) {
  const PoseChange& motion = made.motion;
  const BiteNumbers numbers(made.before.units_per_mm);
  const double mm = 1 / made.before.units_per_mm;
  fmt::print("moved    {} mm at {}, {}; turned {}° about x, y, z\n",
             vector_text(motion.translation, mm, 3), numbers.place(motion.about),
             made.about_named ? "as named" : "the middle of the moving body's box",
             vector_text(motion.rotation, kDegreesInRadian, 3));
  if (motion.axis_point) {
    fmt::print("screw    {:.3f}° about {} through {}, and {} mm along it\n",
               kDegreesInRadian * motion.angle, axis_text(motion.axis),
               numbers.place(*motion.axis_point), signed_text(mm * motion.along, 3));
  } else if (motion.along > 0) {
    fmt::print("screw    no turn, {:.3f} mm along {}\n", mm * motion.along, axis_text(motion.axis));
  } else {
    fmt::print("screw    no motion\n");
  }
}

std::string area_change(const BiteNumbers& numbers, double mm, double before, double after) {
  return fmt::format("{} to {} mm² ({})", numbers.area(before), numbers.area(after),
                     signed_text(mm * mm * (after - before), 2));
}

void print_totals(const BiteComparison& made) {
  const BiteRecord &before = made.before, &after = made.after;
  const BiteNumbers numbers(before.units_per_mm);
  const double mm = 1 / before.units_per_mm;
  const auto mean = [](double one, double other) { return 0.5 * (one + other); };
  fmt::print("area     {} in contact, {} in each other: means of both bodies\n",
             area_change(numbers, mm, mean(before.fixed.area, before.moving.area),
                         mean(after.fixed.area, after.moving.area)),
             area_change(numbers, mm, mean(before.fixed.overlap, before.moving.overlap),
                         mean(after.fixed.overlap, after.moving.overlap)));
  const auto how_deep = [&](const BiteRecord& bite) {
    if (bite.depth)
      return bite.depth->upper > 0 ? numbers.millimetres(*bite.depth) : std::string("0 mm");
    if (!bite.fixed.deepest && !bite.moving.deepest) return std::string("not known");
    return "at least " + numbers.millimetres(std::max(bite.fixed.deepest.value_or(0),
                                                      bite.moving.deepest.value_or(0)));
  };
  fmt::print("depth    {} before, {} after\n", how_deep(before), how_deep(after));
  const auto how_far = [&](const BiteRecord& bite) {
    return bite.touch == "yes" ? std::string("0 mm") : numbers.millimetres(bite.distance);
  };
  fmt::print("apart    {} before, {} after\n", how_far(before), how_far(after));
  const auto side = [&](const std::vector<double>& first, const std::vector<double>& second,
                        const std::string& name) {
    if (first.empty() || second.empty()) return;
    fmt::print("share    of {} on the fixed body {:.1f} to {:.1f} % ({})\n", name, first[0],
               second[0], signed_text(second[0] - first[0], 1));
  };
  if (!made.same_sides()) return;
  side(before.fixed.side, after.fixed.side, before.side_names.first);
  side(before.fixed.fore_aft, after.fixed.fore_aft, before.fore_aft_names.first);
}

void print_contact(const ContactChange& contact, const BiteNumbers& numbers, double mm) {
  const RecordedContact *before = contact.before, *after = contact.after;
  const auto both = [&](const auto& text) {
    return fmt::format("{} to {}", before != nullptr ? text(*before) : "–",
                       after != nullptr ? text(*after) : "–");
  };
  const auto number = [](const RecordedContact* one) {
    return one == nullptr ? std::string("–") : fmt::format("{}", one->number);
  };
  const bool is_kept = before != nullptr && after != nullptr;
  fmt::print(
      "{:>7} {:>7} {:>6} {:>7} {:>9} {:>16} {:>18} {:>14}  {}\n", to_string(contact.fate),
      number(before), number(after), contact.teeth(),
      is_kept ? fmt::format("{:.2f}", mm * contact.moved) : "–",
      both([&](const RecordedContact& of) { return numbers.area(of.area); }),
      both([&](const RecordedContact& of) { return numbers.micrometres(of.least_distance); }),
      both([](const RecordedContact& of) { return BiteNumbers::percent(100 * of.share); }),
      numbers.place(after != nullptr ? after->centre : before->centre));
}

void print_contacts(const BiteComparison& made) {
  fmt::print("contacts {} before, {} after: {} kept, {} moved, {} lost, {} new\n",
             made.before.contacts.size(), made.after.contacts.size(),
             made.count(ContactFate::kKept), made.count(ContactFate::kMoved),
             made.count(ContactFate::kLost), made.count(ContactFate::kNew));
  if (made.contacts.empty()) return;
  fmt::print("{:>7} {:>7} {:>6} {:>7} {:>9} {:>16} {:>18} {:>14}  centre at, {}\n", "change",
             "before", "after", "teeth", "moved, mm", "area, mm²", "least distance, µm", "share, %",
             made.before.unit);
  const BiteNumbers numbers(made.before.units_per_mm);
  for (std::size_t i = 0; i < std::min(made.contacts.size(), kMostLines); ++i) {
    print_contact(made.contacts[i], numbers, 1 / made.before.units_per_mm);
  }
  if (made.contacts.size() > kMostLines) {
    fmt::print("… and {} more: -o change.csv holds them all\n", made.contacts.size() - kMostLines);
  }
}

void print_teeth(const BiteComparison& made, const std::vector<ToothChange>& teeth,
                 const char* body) {
  const BiteNumbers numbers(made.before.units_per_mm);
  for (const ToothChange& tooth : teeth) {
    if (!tooth.before || !tooth.after) {
      fmt::print("tooth {:>2} of the {} body is in the {} bite alone\n", tooth.number, body,
                 tooth.before ? "first" : "second");
      continue;
    }
    if (tooth.before->area == 0 && tooth.after->area == 0) continue;
    fmt::print("tooth {:>2} of the {} body: area {} to {} mm², share {:.1f} to {:.1f} %\n",
               tooth.number, body, numbers.area(tooth.before->area),
               numbers.area(tooth.after->area), 100 * tooth.before->share,
               100 * tooth.after->share);
  }
}

}  // namespace

void print_comparison(const BiteComparison& made, std::span<const std::filesystem::path> written) {
  print_motion(made);
  print_totals(made);
  print_contacts(made);
  print_teeth(made, made.fixed.teeth, "fixed");
  print_teeth(made, made.moving.teeth, "moving");
  std::string last = "notes: ";
  for (const std::string& note : made.notes) last += note + "; ";
  last += written.empty() ? "nothing written" : "wrote";
  for (const std::filesystem::path& file : written) last += " " + file.string();
  fmt::print("{}\n", last);
}

}  // namespace ist::cli
