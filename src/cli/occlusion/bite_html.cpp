#include "cli/occlusion/bite_html.h"

#include <fmt/format.h>

#include "answers/occlusion/bite_hints.h"
#include "answers/occlusion/bite_numbers.h"
#include "cli/occlusion/html/html_parts.h"
#include "cli/occlusion/html/html_text.h"

namespace ist::cli {

using namespace answers;

namespace {

// Logical properties throughout: a page without sides has no words for them here either.
constexpr const char* kStyle = R"(
:root { color-scheme: light; }
* { box-sizing: border-box; print-color-adjust: exact; -webkit-print-color-adjust: exact; }
body { margin: 0 auto; max-inline-size: 78rem; padding: 1.5rem; background: #fff; color: #1c2126;
  font: 1rem/1.5 system-ui, sans-serif; }
h1 { font-size: 1.6rem; line-height: 1.25; overflow-wrap: anywhere; }
h2 { font-size: 1.2rem; margin-block: 2rem 0.5rem; border-block-end: 1px solid #c9ced4; }
.caveat, .checks { border-inline-start: 0.3rem solid #8a5a00; background: #fdf6e7;
  padding: 0.6rem 1rem; margin-block: 1rem; }
.checks { border-color: #3a5f8a; background: #f0f5fb; }
.checks ul { margin: 0; padding-inline-start: 1.2rem; }
.maps { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(28rem, 100%), 1fr));
  gap: 1rem; }
figure { margin: 0; break-inside: avoid; }
figcaption { font-size: 0.9rem; overflow-wrap: anywhere; }
.map { position: relative; border: 1px solid #c9ced4; }
.map img { display: block; inline-size: 100%; block-size: auto; }
.map svg { position: absolute; inset: 0; inline-size: 100%; block-size: 100%; }
.map text { font: 600 15px system-ui, sans-serif; fill: #111; stroke: #fff; stroke-width: 3px;
  paint-order: stroke; }
.map path { stroke: #111; stroke-width: 2; fill: none; }
.map .halo { stroke: #fff; stroke-width: 6; }
#legend ul { list-style: none; padding: 0; display: flex; flex-wrap: wrap; gap: 0.3rem 1.5rem; }
.swatch { inline-size: 40px; block-size: 18px; vertical-align: -3px; margin-inline-end: 0.4rem;
  border: 1px solid #868d95; }
.swatch path { stroke: #fff; stroke-width: 3; }
.wide { overflow-x: auto; margin-block: 0.8rem; }
table { min-inline-size: min(100%, 30rem); border-collapse: collapse; font-size: 0.9rem; font-variant-numeric: tabular-nums; }
caption { text-align: start; color: #4a525a; padding-block-end: 0.3rem; }
th, td { text-align: start; padding: 0.2rem 0.7rem 0.2rem 0; vertical-align: top;
  border-block-end: 1px solid #e3e6ea; }
#contacts :is(th, td), #contacts-on-one :is(th, td), #teeth :is(th, td) { white-space: nowrap; }
thead th { border-block-end: 2px solid #868d95; }
tr { break-inside: avoid; }
@media print { body { padding: 0; font-size: 9pt; } .wide { overflow: visible; }
  #contacts, #contacts-on-one { font-size: 6.5pt; } }
)";

std::string limits_of_method(const Bite& bite) {
  const BiteNumbers numbers(bite);
  return fmt::format(
      "<ul>\n"
      "<li>Distances are from each vertex to the nearest point of the other surface, as far as {}. "
      "A negative distance is inside the other body; the sign comes from the winding of the "
      "nearest "
      "triangle, and is not known where the nearest point lies at an open border.</li>\n"
      "<li>Areas are of triangles on which the distance is taken as linear; long ones are split "
      "first. The pictures interpolate between vertices, show one direction alone, and hide what "
      "lies under it.</li>\n"
      "<li>Contact regions are where the distance is at most {}; the smallest are passed over. "
      "Regions of both bodies whose closest points face each other are one contact. In a "
      "comparison with articulating paper, marks on one arch alone were false more often than "
      "marks on both (15 % against 2 %), so contacts on one body alone stand apart.</li>\n"
      "<li>A geometric share is the part of a region in the sum of the overlaps with an elastic "
      "layer of {} between the surfaces. It changes with that depth, as the brackets show.</li>\n"
      "<li>The limits come from the preset; other publications take limits that differ by ten "
      "times. The bodies are rigid: teeth yield in their sockets, and jaws bend.</li>\n"
      "</ul>\n",
      numbers.length(bite.reach), numbers.length(bite.contact), numbers.length(bite.foundation));
}

std::string settings_words(const Bite& bite) {
  const BiteNumbers numbers(bite);
  return fmt::format(
      "<p id=\"settings\">Unit of the meshes: {}{}. Preset: <strong>{}</strong> ({}). "
      "± {:g} µm assumed for scanning. Distances as far as {}. Contact: at most {}. Places are in "
      "the unit of the meshes and in coordinates of the fixed file. Written by {}.</p>\n",
      escaped(bite.unit), bite.unit_assumed ? ", assumed: the files do not say" : "",
      escaped(bite.preset->name), escaped(bite.preset->source), bite.scanner_band,
      numbers.length(bite.reach), numbers.length(bite.contact), escaped(bite.made_by));
}

std::string checks_list(const Bite& bite) {
  const std::vector<std::string> notes = notes_of(bite);
  if (notes.empty()) return "";
  std::string html = "<div class=\"checks\" id=\"checks\">\n<ul>\n";
  for (const std::string& check : notes) html += "<li>" + escaped(check) + "</li>\n";
  return html + "</ul>\n</div>\n";
}

std::string page(const Bite& bite) {
  const std::string title =
      "Occlusion of " + escaped(bite.fixed.name) + " and " + escaped(bite.moving.name);
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n"
      "<meta charset=\"utf-8\" />\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\" />\n"
      "<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n<main>\n<h1>{0}</h1>\n"
      "<p class=\"caveat\" id=\"caveat\">{2}</p>\n",
      title, kStyle, escaped(kCaveat));
  const auto section = [&html](const char* name, const std::string& content) {
    if (!content.empty())
      html += fmt::format("<section>\n<h2>{}</h2>\n{}</section>\n", name, content);
  };
  html += checks_list(bite);
  section("Distance maps", bite_figures(bite));
  section("Touch, distance and depth", findings_table(bite));
  if (!bite.warning) {
    section("Areas", area_table(bite));
    section("Share by side", share_table(bite));
    section("Teeth", tooth_table(bite));
  }
  section("Contacts", contact_tables(bite));
  section("Input", settings_words(bite) + body_table(bite) + pose_table(bite));
  section("Limits of the method", limits_of_method(bite));
  return html + "</main>\n</body>\n</html>\n";
}

}  // namespace

void write_bite_html(const Bite& bite, const std::filesystem::path& file) {
  OutputFile output(file);
  write_bite_html(bite, output);
  output.commit();
}

void write_bite_html(const Bite& bite, OutputFile& file) {
  const std::string html = page(bite);
  file.write(html.data(), html.size());
}

}  // namespace ist::cli
