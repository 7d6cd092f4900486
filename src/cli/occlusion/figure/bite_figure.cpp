#include "cli/occlusion/figure/bite_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "answers/occlusion/bite_numbers.h"
#include "answers/occlusion/map_statistics.h"
#include "answers/refusals.h"
#include "cli/occlusion/bite_view.h"
#include "cli/occlusion/view_words.h"
#include "ist/base/counted.h"
#include "ist/base/parallel.h"

namespace ist::cli {

using namespace answers;

namespace {

// Points. A picture's pixels are whole numbers of dots.
constexpr double kDotsPerInch = 300, kDot = 72 / kDotsPerInch;
constexpr int kMapWidth = 988, kMapHeight = 768;  // dots
constexpr double kPanelWidth = kMapWidth * kDot, kPanelHeight = kMapHeight * kDot;
constexpr double kGap = 7.6, kPageWidth = 2 * kPanelWidth + kGap;
constexpr double kTitle = 26, kLegendTop = kTitle + kPanelHeight + 8, kLegendHeight = 104;
constexpr double kPageHeight = kLegendTop + kLegendHeight;
constexpr double kText = 7;
constexpr Colour kInk{17, 17, 17}, kPaper{255, 255, 255}, kFrame{160, 166, 172};

enum class MarkKind : std::uint8_t { kOnBoth, kOnOne, kLost };

// A contact on a map.
struct Mark {
  Eigen::Vector3d at;
  MarkKind kind;
  std::string number;
};

struct Panel {
  const BiteBody* body;
  std::vector<double> map;
  double steepest;
  std::string title, facts;
  std::vector<Mark> marks;
};

// What a legend and a histogram are of.
struct LegendWords {
  std::string heading, axis, bare = "farther, or not known";
  double bin = 50;  // of the histogram, micrometres
  std::vector<std::string> below;
  bool has_lost = false, is_empty = false;
};

struct Box2 {
  double left, top, right, bottom;
  [[nodiscard]] bool meets(const Box2& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
};

// Places the number of a mark beside it, where it hides no other number and no other mark.
class Labels {
 public:
  explicit Labels(Canvas& canvas) : canvas_(canvas) {}

  void keep_free(double x, double y) { taken_.push_back({x - 2, y - 2, x + 2, y + 2}); }
  // Writes a text that numbers keep away from.
  void write(double x, double y, const std::string& text, const TextStyle& style) {
    const double width = canvas_.width_of(text, style);
    const double left = style.anchor == TextAnchor::kStart    ? x
                        : style.anchor == TextAnchor::kMiddle ? x - 0.5 * width
                                                              : x - width;
    taken_.push_back({left - 1, y - style.size, left + width + 1, y + 2});
    canvas_.text(x, y, text, style);
  }
  void add(double x, double y, const std::string& number) {
    constexpr double kSize = 6, kAway = 2.4;
    const double width = canvas_.width_of(number, {.size = kSize, .bold = true});
    const auto box_at = [&](std::size_t corner) {
      const bool right = corner % 2 == 0, above = corner < 2;
      const double left = right ? x + kAway : x - kAway - width;
      const double bottom = above ? y - 0.6 : y + kSize;
      return Box2{left, bottom - 0.8 * kSize, left + width, bottom};
    };
    std::size_t best = 0, fewest = taken_.size() + 1;
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const Box2 box = box_at(corner);
      const auto hidden = static_cast<std::size_t>(std::count_if(
          taken_.begin(), taken_.end(), [&](const Box2& other) { return box.meets(other); }));
      if (hidden >= fewest) continue;
      fewest = hidden;
      best = corner;
    }
    const Box2 box = box_at(best);
    taken_.push_back(box);
    canvas_.text(box.left, box.bottom, number, {.size = kSize, .bold = true, .halo = true});
  }

 private:
  Canvas& canvas_;
  std::vector<Box2> taken_;
};

void draw_mark(Canvas& canvas, double x, double y, MarkKind kind) {
  if (kind == MarkKind::kOnBoth) return canvas.circle(x, y, 1.3, kInk, 0.6, kPaper);
  if (kind == MarkKind::kOnOne) return canvas.circle(x, y, 1.3, kPaper, 0.7, kInk);
  for (const auto& [width, colour] : {std::pair(1.8, kPaper), std::pair(0.8, kInk)}) {
    canvas.line(std::array{x - 1.7, y - 1.7, x + 1.7, y + 1.7}, width, colour);
    canvas.line(std::array{x - 1.7, y + 1.7, x + 1.7, y - 1.7}, width, colour);
  }
}

void draw_scale_bar(Canvas& canvas, const Bite& bite, const BiteView& view, double x, double y) {
  const double millimetre = kDot * bite.units_per_mm / view.pixel;  // points
  const double length = round_step(kPanelWidth / 6 / millimetre);
  const double end = x + length * millimetre;
  for (const auto& [width, colour] : {std::pair(2.6, kPaper), std::pair(0.9, kInk)}) {
    canvas.line(std::array{x, y - 2.5, x, y, end, y, end, y - 2.5}, width, colour);
  }
  canvas.text(0.5 * (x + end), y - 3.5, fmt::format("{:g} mm", length),
              {.size = kText, .halo = true, .anchor = TextAnchor::kMiddle});
}

void draw_side_names(Labels& labels, const Bite& bite, const BiteView& view, double left) {
  const double middle = left + 0.5 * kPanelWidth, half = kTitle + 0.5 * kPanelHeight;
  const auto write = [&](double x, double y, const Eigen::Vector3d& towards, TextAnchor anchor) {
    labels.write(x, y, side_at(bite, towards),
                 {.size = kText, .bold = true, .halo = true, .anchor = anchor});
  };
  write(left + kPanelWidth - 4, half, view.across, TextAnchor::kEnd);
  write(left + 4, half, -view.across, TextAnchor::kStart);
  write(middle, kTitle + 9, view.up, TextAnchor::kMiddle);
  write(middle, kTitle + kPanelHeight - 4, -view.up, TextAnchor::kMiddle);
}

// A text of at most that width: its end is left out.
std::string fitted(const Canvas& canvas, std::string text, double width, const TextStyle& style) {
  if (canvas.width_of(text, style) <= width) return text;
  while (!text.empty() && canvas.width_of(text + "…", style) > width) {
    do {
      text.pop_back();
    } while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xC0U) == 0x80U);
    // A first byte without its others goes too.
    if (!text.empty() && static_cast<unsigned char>(text.back()) >= 0xC0U) text.pop_back();
  }
  return text + "…";
}

void draw_panel(Canvas& canvas, const Bite& bite, const Panel& panel, const BiteView& view,
                const Picture& picture, double left) {
  const TextStyle title{.size = 8, .bold = true}, facts{.size = kText};
  canvas.text(left, 9, fitted(canvas, panel.title, kPanelWidth, title), title);
  canvas.text(left, 19, fitted(canvas, panel.facts, kPanelWidth, facts), facts);
  canvas.picture(left, kTitle, kPanelWidth, kPanelHeight, picture);
  constexpr double kInset = 0.25, kTop = kTitle + kInset, kEnd = kTitle + kPanelHeight - kInset;
  const double from = left + kInset, to = left + kPanelWidth - kInset;
  canvas.line(std::array{from, kTop, to, kTop, to, kEnd, from, kEnd, from, kTop}, 0.5, kFrame);
  Labels labels(canvas);
  draw_side_names(labels, bite, view, left);
  const auto place = [&](const Mark& mark) {
    const Eigen::Vector2d at = kDot * place_in(view, kMapWidth, kMapHeight, mark.at);
    return std::pair(left + at.x(), kTitle + at.y());
  };
  const auto is_shown = [&](const Mark& mark) {
    const auto [x, y] = place(mark);
    return x > left && x < left + kPanelWidth && y > kTitle && y < kTitle + kPanelHeight;
  };
  for (const Mark& mark : panel.marks) {
    if (!is_shown(mark)) continue;
    const auto [x, y] = place(mark);
    labels.keep_free(x, y);
    draw_mark(canvas, x, y, mark.kind);
  }
  for (const Mark& mark : panel.marks) {
    const auto [x, y] = place(mark);
    if (is_shown(mark) && !mark.number.empty()) labels.add(x, y, mark.number);
  }
  draw_scale_bar(canvas, bite, view, left + 6, kTitle + kPanelHeight - 6);
}

// The entries of a legend, from the top.
class Legend {
 public:
  Legend(Canvas& canvas, double left, double top) : canvas_(canvas), left_(left), at_(top) {}

  void swatch(const Colour& colour, bool is_hatched, const std::string& words) {
    canvas_.fill(left_, at_, kWide, kHigh, colour);
    if (is_hatched) canvas_.hatch(left_, at_, kWide, kHigh);
    canvas_.line(std::array{left_, at_, left_ + kWide, at_, left_ + kWide, at_ + kHigh, left_,
                            at_ + kHigh, left_, at_},
                 0.4, kFrame);
    write(words);
  }
  void mark(MarkKind kind, const std::string& words) {
    draw_mark(canvas_, left_ + 0.5 * kWide, at_ + 0.5 * kHigh, kind);
    write(words);
  }

 private:
  static constexpr double kWide = 16, kHigh = 7, kLine = 9.6;

  void write(const std::string& words) {
    canvas_.text(left_ + kWide + 4, at_ + 6, words, {.size = kText});
    at_ += kLine;
  }

  Canvas& canvas_;
  double left_, at_;
};

constexpr double kSecondColumn = 156, kHistogramLeft = 336;

void draw_colour_bar(Canvas& canvas, const MapScale& scale, double unit, double top) {
  constexpr double kWide = 140, kHigh = 9;
  constexpr int kSteps = 280;
  const auto number_at = [&](double part) {
    return scale.low() + part * (scale.high() - scale.low());
  };
  for (int i = 0; i < kSteps; ++i) {
    canvas.fill(i * kWide / kSteps, top, kWide / kSteps + 0.3, kHigh,
                scale.colour(number_at((i + 0.5) / kSteps)));
  }
  canvas.line(std::array{0.0, top, kWide, top, kWide, top + kHigh, 0.0, top + kHigh, 0.0, top}, 0.4,
              kFrame);
  const double step = round_step((scale.high() - scale.low()) / unit / 2.9);
  for (double tick = std::ceil(scale.low() / unit / step - 1e-9) * step;
       tick <= scale.high() / unit * (1 + 1e-9); tick += step) {
    const double x = kWide * (tick * unit - scale.low()) / (scale.high() - scale.low());
    canvas.line(std::array{x, top + kHigh, x, top + kHigh + 2}, 0.5, kInk);
    canvas.text(x, top + kHigh + 9, fmt::format("{:g}", std::round(tick) + 0.0),
                {.size = kText, .anchor = x < 10 ? TextAnchor::kStart : TextAnchor::kMiddle});
  }
}

// The area of each bin of both bodies together, in the colours of the scale.
void draw_histogram(Canvas& canvas, const std::vector<const MapStatistics*>& maps,
                    const MapScale& scale, double unit, double square_millimetre,
                    const std::string& axis) {
  constexpr double kLeft = kHistogramLeft + 26, kWide = kPageWidth - kLeft - 4, kHigh = 62;
  constexpr double kBottom = kLegendTop + 12 + kHigh;
  canvas.text(kHistogramLeft, kLegendTop + 6, "Area of both bodies, mm²",
              {.size = kText, .bold = true});
  double low = INFINITY, high = -INFINITY, step = 0;
  for (const MapStatistics* map : maps) {
    step = map->step;
    // The rest is a tail, which would squeeze the bins of interest.
    low = std::min(low, map->percentiles.front());
    high = std::max(high, map->percentiles.back());
  }
  low = std::floor(low / step) * step;
  high = std::ceil(high / step) * step;
  const auto bins = static_cast<std::size_t>(std::max(1.0, std::round((high - low) / step)));
  std::vector<double> areas(bins);
  for (const MapStatistics* map : maps) {
    for (std::size_t i = 0; i < map->histogram.size(); ++i) {
      const double bin = std::round((map->from - low) / step) + static_cast<double>(i);
      if (bin < 0 || bin >= static_cast<double>(bins)) continue;
      areas[static_cast<std::size_t>(bin)] += map->histogram[i] * square_millimetre;
    }
  }
  const double most = *std::max_element(areas.begin(), areas.end());
  const double bar = kWide / static_cast<double>(bins);
  for (std::size_t i = 0; i < bins && most > 0; ++i) {
    const double tall = kHigh * areas[i] / most;
    canvas.fill(kLeft + static_cast<double>(i) * bar, kBottom - tall, bar * 0.9, tall,
                scale.colour(low + (static_cast<double>(i) + 0.5) * step));
  }
  canvas.line(std::array{kLeft, kBottom - kHigh, kLeft, kBottom, kLeft + kWide, kBottom}, 0.5,
              kInk);
  if (most > 0) {
    const double tick = round_step(most);
    const double y = kBottom - kHigh * tick / most;
    canvas.line(std::array{kLeft - 2, y, kLeft, y}, 0.5, kInk);
    canvas.text(kLeft - 4, y + 2.5, fmt::format("{:g}", tick),
                {.size = kText, .anchor = TextAnchor::kEnd});
  }
  const double each = round_step((high - low) / unit / 2.9);
  for (double tick = std::ceil(low / unit / each - 1e-9) * each; tick <= high / unit * (1 + 1e-9);
       tick += each) {
    const double x = kLeft + kWide * (tick * unit - low) / (high - low);
    canvas.line(std::array{x, kBottom, x, kBottom + 2}, 0.5, kInk);
    canvas.text(
        x, kBottom + 9, fmt::format("{:g}", std::round(tick) + 0.0),
        {.size = kText, .anchor = x > kLeft + kWide - 4 ? TextAnchor::kEnd : TextAnchor::kMiddle});
  }
  canvas.text(kLeft + 0.5 * kWide, kBottom + 18, axis,
              {.size = kText, .anchor = TextAnchor::kMiddle});
}

void draw_legend(Canvas& canvas, const MapScale& scale, double unit, const LegendWords& words) {
  canvas.text(0, kLegendTop + 6, words.heading, {.size = kText, .bold = true});
  Legend first(canvas, 0, kLegendTop + 11), second(canvas, kSecondColumn, kLegendTop + 11);
  if (scale.bands().empty()) {
    draw_colour_bar(canvas, scale, unit, kLegendTop + 12);
    Legend(canvas, 0, kLegendTop + 40).swatch(kBareSurface, false, words.bare);
  } else {
    for (const MapBand& band : scale.bands()) {
      first.swatch(band.colour, band.below_scan_error, band.words);
    }
    second.swatch(kBareSurface, false, words.bare);
    const bool has_hatch = std::any_of(scale.bands().begin(), scale.bands().end(),
                                       [](const MapBand& band) { return band.below_scan_error; });
    if (has_hatch) second.swatch(kFrame, true, "below the error assumed for scanning");
  }
  if (words.is_empty) return;
  second.mark(MarkKind::kOnBoth, "contact on both bodies");
  second.mark(MarkKind::kOnOne, "contact on one body alone");
  if (words.has_lost) second.mark(MarkKind::kLost, "lost contact, by its number before");
}

void draw_notes(Canvas& canvas, const std::vector<std::string>& notes) {
  double at = kPageHeight - 4 - 8.5 * static_cast<double>(notes.size() - 1);
  for (const std::string& note : notes) {
    const TextStyle style{.size = 6};
    canvas.text(0, at, fitted(canvas, note, kHistogramLeft - 8, style), style);
    at += 8.5;
  }
}

void write_figure(const Bite& bite, const std::array<Panel, 2>& panels, const MapScale& scale,
                  const LegendWords& words, FigureKind kind, OutputFile& file) {
  Canvas canvas(kind, kPageWidth, kPageHeight, kDotsPerInch);
  const auto [fixed, moving] = bite_views(bite, kMapWidth, kMapHeight);
  const std::array<BiteView, 2> views{fixed, moving};
  std::array<Picture, 2> pictures;
  parallel_for(2, 1, [&](std::size_t i, std::size_t) {
    pictures[i] = draw_map(*panels[i].body, {panels[i].map, panels[i].steepest}, views[i], scale,
                           kMapWidth, kMapHeight);
  });
  for (std::size_t i = 0; i < 2; ++i) {
    draw_panel(canvas, bite, panels[i], views[i], pictures[i],
               static_cast<double>(i) * (kPanelWidth + kGap));
  }
  const double unit = bite.units_per_micrometre();
  draw_legend(canvas, scale, unit, words);
  std::array<std::optional<MapStatistics>, 2> found;
  std::vector<const MapStatistics*> maps;
  for (std::size_t i = 0; i < 2; ++i) {
    found[i] = map_statistics(*panels[i].body, panels[i].map, words.bin * unit, bite.region);
    if (found[i]) maps.push_back(&*found[i]);
  }
  const double square_millimetre = 1 / (bite.units_per_mm * bite.units_per_mm);
  if (!maps.empty()) draw_histogram(canvas, maps, scale, unit, square_millimetre, words.axis);
  draw_notes(canvas, words.below);
  const std::string bytes = canvas.finish();
  file.write(bytes.data(), bytes.size());
}

std::string title_of(const char* role, const std::string& name) {
  return name == role ? fmt::format("{} body", role) : fmt::format("{} ({})", name, role);
}

std::vector<Mark> marks_of(const BiteBody& body) {
  std::vector<Mark> marks;
  for (std::size_t i = 0; i < body.contacts.size(); ++i) {
    marks.push_back({body.surface.regions[i].closest,
                     body.contacts[i] <= body.on_both ? MarkKind::kOnBoth : MarkKind::kOnOne,
                     body.contacts[i] <= kNumbered ? fmt::format("{}", body.contacts[i]) : ""});
  }
  // The number of a contact stands at its largest region, the first one.
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const auto first = std::find(body.contacts.begin(), body.contacts.end(), body.contacts[i]);
    if (first != body.contacts.begin() + static_cast<std::ptrdiff_t>(i)) marks[i].number.clear();
  }
  return marks;
}

std::string facts_of(const Bite& bite, const BiteBody& body) {
  const BiteNumbers numbers(bite);
  const double limit = bite.preset->micrometres.back();
  std::string facts =
      fmt::format("{} mm² within {:g} µm or overlapping; ", numbers.area(body.areas.back()), limit);
  return facts + (bite.contacts.empty() ? std::string("no contact")
                                        : counted(bite.contacts.size(), "contact"));
}

std::string scanning_words(const Bite& bite) {
  return fmt::format("± {:g} µm assumed for scanning. Unit: {}. {}", bite.scanner_band,
                     bite.unit_words(), bite.made_by);
}

}  // namespace

void refuse_without_canvas(const std::filesystem::path& file) {
  throw Refusal("-o " + file.string(),
                "this ist was built without cairo, and draws no pictures: build it with "
                "IST_WITH_CAIRO=ON (Debian: libcairo2-dev), or write .vtp or .ply");
}

MapScale scale_of(const Bite& bite, const FigureOptions& options) {
  if (!options.continuous) return MapScale::of_bands(map_bands(bite));
  if (options.range) return MapScale::of_distances(options.range->first, options.range->second);
  double least = 0;
  for (const BiteBody* body : {&bite.fixed, &bite.moving}) {
    for (const SurfaceDistance& one : body->surface.vertices)
      least = std::fmin(least, one.distance);
  }
  const double step = 100 * bite.units_per_micrometre();
  return MapScale::of_distances(std::floor(least / step) * step, bite.reach);
}

MapScale scale_of(const ChangeMap& map, double reach, const std::optional<double>& most) {
  if (most) return MapScale::of_changes(*most);
  const double largest = map.most();
  if (!(largest > 0)) return MapScale::of_changes(reach);
  const double step = round_step(largest);
  return MapScale::of_changes(std::ceil(largest / step) * step);
}

void write_bite_figure(const Bite& bite, const MapScale& scale, FigureKind kind, OutputFile& file) {
  const auto panel = [&](const BiteBody& body, const char* role) {
    return Panel{
        &body,         distances_of(body), 1, title_of(role, body.name), facts_of(bite, body),
        marks_of(body)};
  };
  LegendWords words;
  words.heading = "Distance to the other surface";
  if (scale.bands().empty()) words.heading += ", µm";
  words.axis = "distance, µm";
  words.is_empty = bite.contacts.empty();
  if (bite.warning) words.below.push_back(*bite.warning);
  words.below.push_back(fmt::format("Preset {}: {}.", bite.preset->name, bite.preset->source));
  words.below.push_back(scanning_words(bite));
  write_figure(bite, {panel(bite.fixed, "fixed"), panel(bite.moving, "moving")}, scale, words, kind,
               file);
}

void write_change_figure(const Bite& after, const BiteComparison& comparison, const ChangeMap& map,
                         const MapScale& scale, FigureKind kind, OutputFile& file) {
  std::vector<Mark> lost;
  for (const ContactChange& contact : comparison.contacts) {
    if (contact.fate != ContactFate::kLost) continue;
    lost.push_back(
        {contact.before->closest, MarkKind::kLost,
         contact.before->number <= kNumbered ? fmt::format("({})", contact.before->number) : ""});
  }
  const auto panel = [&](const BiteBody& body, const std::vector<double>& change, double before,
                         double now, const char* role) {
    const BiteNumbers numbers(after);
    Panel made{&body,
               change,
               2,
               title_of(role, body.name),
               fmt::format("area in contact {} to {} mm²", numbers.area(before), numbers.area(now)),
               marks_of(body)};
    made.marks.insert(made.marks.end(), lost.begin(), lost.end());
    return made;
  };
  LegendWords words;
  words.heading = "Change of the distance, µm: red nearer, blue farther";
  words.axis = "change of the distance, µm";
  words.bare = "not known";
  words.bin = round_step(scale.high() / after.units_per_micrometre() / 20);
  words.is_empty = after.contacts.empty() && lost.empty();
  words.has_lost = !lost.empty();
  words.below.push_back(fmt::format(
      "Contacts: {} kept, {} moved, {} lost, {} new.", comparison.count(ContactFate::kKept),
      comparison.count(ContactFate::kMoved), lost.size(), comparison.count(ContactFate::kNew)));
  words.below.push_back(scanning_words(after));
  write_figure(after,
               {panel(after.fixed, map.fixed, comparison.before.fixed.area,
                      comparison.after.fixed.area, "fixed"),
                panel(after.moving, map.moving, comparison.before.moving.area,
                      comparison.after.moving.area, "moving")},
               scale, words, kind, file);
}

}  // namespace ist::cli
