#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "answers/json_parts.h"
#include "answers/occlusion/bite_files.h"
#include "answers/occlusion/bite_maker.h"
#include "answers/occlusion/bite_surfaces.h"
#include "answers/occlusion/map_colours.h"
#include "ist/base/files.h"
#include "ist/base/throw_error.h"
#include "viewer/engine/replies.h"

namespace ist::viewer {
namespace {

using answers::Colour;
using nlohmann::ordered_json;

constexpr double kBookGap = 10;  // millimetres

answers::Bite bite_of(const answers::Bodies& bodies, const Asked& asked, Progress& progress) {
  answers::BiteQuestions questions;
  const std::string preset = asked.text("preset");
  const auto found = std::find_if(answers::presets().begin(), answers::presets().end(),
                                  [&](const answers::Preset& each) { return each.name == preset; });
  if (found == answers::presets().end()) {
    throw_error(ErrorCode::kArgumentInvalid, "preset: no preset has the name {}", preset);
  }
  questions.preset = &*found;
  questions.reach = asked.number("reach");
  if (!(questions.reach > 0) || questions.reach < 1e-3 * found->micrometres.back()) {
    throw_error(ErrorCode::kArgumentInvalid,
                "reach: give at least the preset's largest limit, {:g} µm",
                found->micrometres.back());
  }
  if (bodies.unit() == LengthUnit::kUnknown) questions.unit = asked.unit();
  questions.sides.frame = asked.text_or_none("frame");
  return answers::make_bite(bodies, {bodies.fixed.source(), bodies.moving.source()},
                            asked.pose("pose"), questions, progress);
}

std::string web_colour(const Colour& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour[0], colour[1], colour[2]);
}

ordered_json side_of(const answers::BiteBody& body, Reply& reply) {
  std::vector<float> distances;
  for (const SurfaceDistance& one : body.surface.vertices) {
    distances.push_back(static_cast<float>(one.distance));
  }
  return {{"distances", reply.array(std::move(distances))}};
}

// Both bodies of an opened book as the page draws it: x to the right, z up, the viewer at -y.
ordered_json book_of(const answers::Bite& bite, answers::BookLayout layout) {
  const answers::OpenedBook book = answers::opened(bite, kBookGap * bite.units_per_mm, layout);
  Eigen::Isometry3d drawn = Eigen::Isometry3d::Identity();
  drawn.linear() << book.up.cross(book.viewer).transpose(), -book.viewer.transpose(),
      book.up.transpose();
  return {{"fixed", answers::pose_json(drawn * book.fixed * bite.fixed.to_fixed)},
          {"moving", answers::pose_json(drawn * book.moving * bite.moving.to_fixed)}};
}

}  // namespace

void fill_bite(const answers::Bodies& bodies, const Asked& asked, Progress& progress,
               Reply& reply) {
  const answers::Bite bite = bite_of(bodies, asked, progress);
  const std::vector<answers::MapBand> bands = answers::map_bands(bite);
  reply.json["bite"] = answers::json_of(bite);
  reply.json["bands"] = ordered_json::array();
  for (const answers::MapBand& band : bands) {
    ordered_json line{{"from", nullptr},
                      {"to", band.to},
                      {"colour", web_colour(band.colour)},
                      {"words", band.words},
                      {"below_scan_error", band.below_scan_error}};
    if (std::isfinite(band.from)) line["from"] = band.from;
    reply.json["bands"].push_back(line);
  }
  reply.json["bare"] = web_colour(answers::kBareSurface);
  reply.json["book"] = {{"beside", book_of(bite, answers::BookLayout::kBeside)},
                        {"above", book_of(bite, answers::BookLayout::kAbove)}};
  reply.json["fixed"] = side_of(bite.fixed, reply);
  reply.json["moving"] = side_of(bite.moving, reply);
}

std::vector<std::uint8_t> coloured_glb(const answers::Bodies& bodies, const Asked& asked,
                                       Progress& progress) {
  const answers::Bite bite = bite_of(bodies, asked, progress);
  const std::filesystem::path file = "page.glb";
  OutputFile output(file);
  answers::write_bite_glb(bite, {}, output);
  output.commit();
  InputFile input(file);
  std::vector<std::uint8_t> bytes(std::filesystem::file_size(file));
  bytes.resize(input.read(bytes.data(), bytes.size()));
  std::filesystem::remove(file);
  return bytes;
}

}  // namespace ist::viewer
