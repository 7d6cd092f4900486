#include <fmt/format.h>

#include <array>
#include <vector>

#include "answers/occlusion/map_colours.h"
#include "answers/occlusion/map_scale.h"
#include "cli/occlusion/bite_view.h"
#include "cli/occlusion/figure/canvas.h"
#include "cli/occlusion/html/html_parts.h"
#include "cli/occlusion/html/html_text.h"
#include "cli/occlusion/map_picture.h"
#include "cli/occlusion/view_words.h"
#include "ist/base/parallel.h"

namespace ist::cli {

using namespace answers;

namespace {

constexpr int kWidth = 900, kHeight = 700;  // pixels
std::string text_at(double x, double y, const char* anchor, const std::string& text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor,
                     text);
}

std::string edge_names(const Bite& bite, const BiteView& view) {
  return text_at(kWidth - 10, kHeight / 2.0, "end", escaped(side_at(bite, view.across))) +
         text_at(10, kHeight / 2.0, "start", escaped(side_at(bite, -view.across))) +
         text_at(kWidth / 2.0, 20, "middle", escaped(side_at(bite, view.up))) +
         text_at(kWidth / 2.0, kHeight - 8, "middle", escaped(side_at(bite, -view.up)));
}

// A bar of 1, 2 or 5 times a power of ten millimetres, about a sixth of the picture.
std::string scale_bar(const Bite& bite, const BiteView& view) {
  const double most = kWidth / 6.0 * view.pixel / bite.units_per_mm;
  const double length = round_step(most);
  const double pixels = length * bite.units_per_mm / view.pixel;
  const std::string bar = fmt::format("M12 {} v8 h{:.2f} v-8", kHeight - 22, pixels);
  return fmt::format("<path class=\"halo\" d=\"{0}\" />\n<path d=\"{0}\" />\n", bar) +
         text_at(12 + 0.5 * pixels, kHeight - 20, "middle", fmt::format("{:g} mm", length));
}

std::string contact_numbers(const BiteBody& body, const BiteView& view) {
  std::string html;
  for (std::size_t i = 0; i < body.contacts.size(); ++i) {
    if (body.contacts[i] > kNumbered) continue;
    const Eigen::Vector2d place = place_in(view, kWidth, kHeight, body.surface.regions[i].closest);
    html += text_at(place.x() + 5, place.y() - 4, "start", fmt::format("{}", body.contacts[i]));
  }
  return html;
}

std::string figure(const Bite& bite, const BiteBody& body, const BiteView& view,
                   const std::string& role, const std::string& png) {
  const std::string alt = fmt::format(
      "Distance map of the {} body {}, seen from the side of the other body, with {} contact "
      "regions; the tables below give their numbers.",
      role, escaped(body.name), body.surface.regions.size());
  return fmt::format(
      "<figure id=\"map-{0}\">\n<div class=\"map\">\n"
      "<img width=\"{1}\" height=\"{2}\" alt=\"{3}\" src=\"data:image/png;base64,{4}\" />\n"
      "<svg viewBox=\"0 0 {1} {2}\" aria-hidden=\"true\">\n{5}{6}{7}</svg>\n</div>\n"
      "<figcaption><strong>{8}</strong>, the {0} body, seen from the side of the other body. "
      "{9}</figcaption>\n</figure>\n",
      role, kWidth, kHeight, alt, base64_of(png), contact_numbers(body, view),
      edge_names(bite, view), scale_bar(bite, view), escaped(body.name),
      bite.contacts.size() > kNumbered
          ? fmt::format("Contacts are numbered to {}.", kNumbered)
          : "A contact has the same number in both pictures and in the tables.");
}

std::string swatch(const Colour& colour, bool hatched) {
  std::string lines;
  if (hatched) lines = "<path d=\"M0 12 L12 0 M6 18 L24 0 M18 18 L36 0 M30 18 L40 8\" />";
  return fmt::format(
      "<svg class=\"swatch\" viewBox=\"0 0 40 18\" aria-hidden=\"true\"><rect width=\"40\" "
      "height=\"18\" fill=\"rgb({},{},{})\" />{}</svg>",
      colour[0], colour[1], colour[2], lines);
}

std::string dot(bool filled) {
  return fmt::format(
      "<svg class=\"swatch\" viewBox=\"0 0 40 18\" aria-hidden=\"true\"><circle cx=\"20\" cy=\"9\" "
      "r=\"5\" fill=\"{}\" stroke=\"{}\" stroke-width=\"2\" /></svg>",
      filled ? "black" : "white", filled ? "white" : "black");
}

std::string legend(const Bite& bite, const std::vector<MapBand>& bands) {
  std::string html = fmt::format(
      "<div id=\"legend\">\n<p>Distance to the other surface, preset <strong>{}</strong> ({}), "
      "± {:g} µm assumed for scanning:</p>\n<ul>\n",
      escaped(bite.preset->name), escaped(bite.preset->source), bite.scanner_band);
  for (const MapBand& band : bands) {
    html += fmt::format(
        "<li>{}{}{}</li>\n", swatch(band.colour, band.below_scan_error), escaped(band.words),
        band.below_scan_error ? ", hatched: below the error assumed for scanning" : "");
  }
  html += fmt::format("<li>{}farther, or not known</li>\n", swatch(kBareSurface, false));
  html += fmt::format("<li>{}closest point of a contact on both bodies</li>\n", dot(true));
  html += fmt::format("<li>{}closest point of a contact on one body alone</li>\n", dot(false));
  return html + "</ul>\n</div>\n";
}

}  // namespace

std::string bite_figures(const Bite& bite) {
  const std::vector<MapBand> bands = map_bands(bite);
  const auto [fixed, moving] = bite_views(bite, kWidth, kHeight);
  const std::array<const BiteBody*, 2> bodies{&bite.fixed, &bite.moving};
  const std::array<const BiteView*, 2> views{&fixed, &moving};
  std::array<std::string, 2> pngs;
  parallel_for(2, 1, [&](std::size_t i, std::size_t) {
    pngs[i] = png_of(draw_map(*bodies[i], *views[i], bands, kWidth, kHeight));
  });
  return "<div class=\"maps\">\n" + figure(bite, bite.fixed, fixed, "fixed", pngs[0]) +
         figure(bite, bite.moving, moving, "moving", pngs[1]) + "</div>\n" + legend(bite, bands);
}

}  // namespace ist::cli
