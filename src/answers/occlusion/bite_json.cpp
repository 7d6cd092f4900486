#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "answers/commit.h"
#include "answers/json_parts.h"
#include "answers/occlusion/bite_files.h"
#include "answers/occlusion/map_statistics.h"

namespace ist::answers {
namespace {

using nlohmann::ordered_json;

ordered_json triple(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

ordered_json or_null(double number) {
  return std::isfinite(number) ? ordered_json(number) : ordered_json(nullptr);
}

ordered_json json_of(const ContactRegion& region, std::size_t contact) {
  ordered_json out{{"area", region.area},
                   {"centre", triple(region.centre)},
                   {"least_distance", region.least_distance},
                   {"closest", triple(region.closest)},
                   {"penetrating_area", region.penetrating_area},
                   {"depth_integral", region.depth_integral},
                   {"share", region.share},
                   {"share_thinner", region.share_thinner},
                   {"share_thicker", region.share_thicker}};
  out["partner"] = region.partner ? ordered_json(*region.partner) : ordered_json(nullptr);
  out["contact"] = contact;
  return out;
}

ordered_json tooth_or_null(int number) {
  return number == 0 ? ordered_json(nullptr) : ordered_json(number);
}

ordered_json json_of(const BiteContact& contact, std::size_t number) {
  return {{"number", number},
          {"fixed", contact.fixed},
          {"moving", contact.moving},
          {"area", contact.area},
          {"penetrating_area", contact.penetrating_area},
          {"depth_integral", contact.depth_integral},
          {"share", contact.share},
          {"share_thinner", contact.share_thinner},
          {"share_thicker", contact.share_thicker},
          {"least_distance", contact.least_distance},
          {"centre", triple(contact.centre)},
          {"closest", triple(contact.closest)},
          {"teeth",
           {{"fixed", tooth_or_null(contact.fixed_tooth)},
            {"moving", tooth_or_null(contact.moving_tooth)}}}};
}

ordered_json json_of(const Balance::Shares& shares, const Division& division) {
  return {{division.first, shares.first},
          {division.second, shares.second},
          {"asymmetry", shares.asymmetry}};
}

ordered_json json_of(const std::optional<Balance>& balance, const Division& division) {
  if (!balance) return nullptr;
  return {{"per_cent", json_of(balance->shares, division)},
          {"thinner", json_of(balance->thinner, division)},
          {"thicker", json_of(balance->thicker, division)},
          {"centre", triple(balance->centre)}};
}

ordered_json json_of(const Division& division) {
  return {{"direction", triple(division.direction)},
          {"at", division.at},
          {"assumed", division.assumed}};
}

ordered_json json_of(const std::optional<MapStatistics>& map) {
  if (!map) return nullptr;
  ordered_json percentiles;
  for (std::size_t i = 0; i < kPercentiles.size(); ++i) {
    percentiles[fmt::format("{}", kPercentiles[i])] = map->percentiles[i];
  }
  return {{"area", map->area},
          {"mean", map->mean},
          {"deviation", map->deviation},
          {"root_mean_square", map->root_mean_square},
          {"least", map->least},
          {"most", map->most},
          {"percentiles", percentiles},
          {"histogram", {{"from", map->from}, {"step", map->step}, {"areas", map->histogram}}}};
}

ordered_json json_of(const Eigen::AlignedBox3d& box) {
  const Eigen::Vector3d &low = box.min(), &high = box.max();
  return {low.x(), low.y(), low.z(), high.x(), high.y(), high.z()};
}

ordered_json json_of(const BiteBody& body, const Bite& bite) {
  const SurfaceOcclusion& surface = body.surface;
  ordered_json out{{"file", body.name}, {"hash", nullptr}, {"closed", body.closed}};
  if (body.hash) out["hash"] = *body.hash;
  out["box"] = json_of(body.box());
  out["vertices"] = surface.vertices.size();
  std::size_t near = 0;
  for (const SurfaceDistance& one : surface.vertices) near += std::isnan(one.distance) ? 0U : 1U;
  out["vertices_within_reach"] = near;
  out["areas"] = ordered_json::array();
  for (std::size_t i = 0; i < body.areas.size(); ++i) {
    out["areas"].push_back({{"micrometres", bite.preset->micrometres[i]},
                            {"area", body.areas[i]},
                            {"area_outside", body.area_outside(i)}});
  }
  out["total_area"] = surface.total_area;
  out["penetrating_area"] = surface.penetrating_area;
  out["depth_integral"] = surface.depth_integral;
  const std::optional<double> deepest = bite.known_depth(surface.depth_at_vertices);
  out["depth_at_vertices"] = deepest ? ordered_json(*deepest) : ordered_json(nullptr);
  out["map"] = json_of(map_statistics(body, bite));
  out["regions"] = ordered_json::array();
  for (std::size_t i = 0; i < surface.regions.size(); ++i) {
    out["regions"].push_back(json_of(surface.regions[i], body.contacts[i]));
  }
  out["sides"] = json_of(body.sides, bite.sides);
  out["fore_aft"] = json_of(body.fore_aft, bite.fore_aft);
  out["teeth"] = ordered_json::array();
  for (const Tooth& tooth : body.teeth) {
    out["teeth"].push_back({{"number", tooth.number},
                            {"area", tooth.area},
                            {"share", tooth.share},
                            {"share_thinner", tooth.share_thinner},
                            {"share_thicker", tooth.share_thicker},
                            {"least_distance", or_null(tooth.least_distance)}});
  }
  return out;
}

ordered_json or_null(const std::optional<std::string>& text) {
  return text ? ordered_json(*text) : ordered_json(nullptr);
}

const char* name_of(ToothNumbers numbers) {
  return numbers == ToothNumbers::kFdi ? "fdi" : "universal";
}

}  // namespace

ordered_json json_of(const Bite& bite) {
  const Findings& found = bite.findings;
  ordered_json out{
      {"schema", 1}, {"version", IST_VERSION}, {"commit", IST_COMMIT}, {"unit", bite.unit}};
  out["unit_assumed"] = bite.unit_assumed;
  out["frame"] = bite.frame == PatientFrame::kUnknown ? ordered_json(nullptr)
                                                      : ordered_json(to_string(bite.frame));
  out["pose"] = pose_json(bite.pose);
  out["rotation_error"] = bite.findings.rotation_error;
  out["reach"] = bite.reach;
  out["preset"] = {{"name", bite.preset->name},
                   {"micrometres", bite.preset->micrometres},
                   {"source", bite.preset->source}};
  out["scanner_band_micrometres"] = bite.scanner_band;
  out["contact"] = bite.contact;
  out["foundation"] = {{"depth", bite.foundation}, {"change", bite.change}};
  out["touch"] = to_string(found.touch);
  out["inside"] = found.inside ? ordered_json(to_string(*found.inside)) : ordered_json(nullptr);
  out["distance_lower"] = found.distance->lower;
  out["distance_upper"] = found.distance->upper;
  const auto& depth = found.depth.certain;
  out["depth_lower"] = depth ? ordered_json(depth->lower) : ordered_json(nullptr);
  out["depth_upper"] = depth ? ordered_json(depth->upper) : ordered_json(nullptr);
  out["depth_complete"] = depth ? ordered_json(found.depth.complete) : ordered_json(nullptr);
  out["depth_capped"] = depth ? ordered_json(found.depth.capped) : ordered_json(nullptr);
  out["self_intersecting"] = *found.self_intersecting;
  const auto& deepest = found.depth.at_vertices;
  out["depth_at_vertices"] = deepest ? ordered_json(*deepest) : ordered_json(nullptr);
  const auto& point = found.depth.point;
  out["depth_point"] = point ? triple(*point) : ordered_json(nullptr);
  out["sides"] = json_of(bite.sides);
  out["fore_aft"] = json_of(bite.fore_aft);
  out["numbering"] = bite.numbers ? ordered_json(name_of(*bite.numbers)) : ordered_json(nullptr);
  out["fixed"] = json_of(bite.fixed, bite);
  out["moving"] = json_of(bite.moving, bite);
  out["contacts"] = ordered_json::array();
  for (std::size_t i = 0; i < bite.contacts.size(); ++i) {
    out["contacts"].push_back(json_of(bite.contacts[i], i + 1));
  }
  out["region"] = bite.region ? json_of(*bite.region) : ordered_json(nullptr);
  out["warning"] = or_null(bite.warning);
  out["hint"] = or_null(bite.hint);
  out["checks"] = bite.checks;
  out["caveat"] = kCaveat;
  return out;
}

void write_bite_json(const Bite& bite, OutputFile& file) {
  const std::string text = json_text(json_of(bite), 2) + "\n";
  file.write(text.data(), text.size());
}

}  // namespace ist::answers
