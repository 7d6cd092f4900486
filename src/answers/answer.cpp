#include "answers/answer.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "answers/json_parts.h"

namespace ist::answers {
namespace {

using nlohmann::ordered_json;

template <class Number>
ordered_json or_null(const std::optional<Number>& number) {
  return number ? ordered_json(*number) : ordered_json(nullptr);
}

ordered_json escape_json(const std::optional<Escape>& escape) {
  if (!escape) return nullptr;
  const bool has_motion =
      escape->status == Escape::Status::kFound || escape->status == Escape::Status::kNotNeeded;
  return {{"status", to_string(escape->status)},
          {"motion", has_motion ? pose_json(escape->motion()) : ordered_json(nullptr)},
          {"pose", has_motion ? pose_json(escape->pose()) : ordered_json(nullptr)},
          {"lower", escape->lower},
          {"upper", has_motion ? ordered_json(escape->upper) : ordered_json(nullptr)},
          {"verdicts", escape->verdicts}};
}

}  // namespace

ordered_json answer_line(std::size_t index, const PoseAnswer& answer,
                         const std::optional<LeafAnswer>& leaves, const Bodies& bodies) {
  const Findings& found = answer.findings;
  const auto of_engine = [&](const auto& value) {
    return leaves ? ordered_json(value(leaves->engine)) : ordered_json(nullptr);
  };
  const auto of_result = [&](auto QueryResult::*member) {
    return leaves ? ordered_json(leaves->timed.result.*member) : ordered_json(nullptr);
  };
  const auto time = [&](double (EngineAnswer::*of)() const) {
    return leaves ? ordered_json((leaves->timed.*of)()) : ordered_json(nullptr);
  };
  const auto lower = [](const std::optional<DistanceInterval>& interval) {
    return interval ? ordered_json(interval->lower) : ordered_json(nullptr);
  };
  const auto upper = [](const std::optional<DistanceInterval>& interval) {
    return interval ? ordered_json(interval->upper) : ordered_json(nullptr);
  };
  ordered_json line{{"index", index},
                    {"pose", pose_json(answer.pose)},
                    {"rotation_error", answer.findings.rotation_error}};
  if (answer.displacement) line["displacement"] = *answer.displacement;
  line["engine"] = of_engine([](const Engine& e) { return e.name(); });
  line["spheres"] = of_engine([&](const Engine&) { return to_string(bodies.policy); });
  line["target"] = of_engine([](const Engine& e) { return e.target(); });
  line["workers"] = of_engine([](const Engine& e) { return e.workers(); });
  line["voxel_size"] = {voxel_size_json(bodies.fixed), voxel_size_json(bodies.moving)};
  line["resolution"] = of_result(&QueryResult::resolution);
  line["complete"] = of_result(&QueryResult::complete);
  line["truncated"] = of_result(&QueryResult::truncated);
  line["level"] = of_result(&QueryResult::level);
  line["touch"] = to_string(found.touch);
  line["inside"] = found.inside ? ordered_json(to_string(*found.inside)) : ordered_json(nullptr);
  line["leaf_pairs"] = of_result(&QueryResult::leaf_pairs);
  line["triangle_pairs"] = or_null(found.triangle_pairs);
  line["distance_lower"] = lower(found.distance);
  line["distance_upper"] = upper(found.distance);
  line["distance_narrowest"] = or_null(found.narrowest);
  const auto of_nearest = [&found](const auto& member) {
    return found.nearest ? std::optional((*found.nearest).*member) : std::nullopt;
  };
  line["nearest_fixed"] = point_json(of_nearest(&NearPair::fixed_point));
  line["nearest_moving"] = point_json(of_nearest(&NearPair::moving_point));
  line["nearest_triangles"] = pair_json(of_nearest(&NearPair::triangles));
  line["depth_lower"] = lower(found.depth.certain);
  line["depth_upper"] = upper(found.depth.certain);
  const bool certain = found.depth.certain.has_value();
  line["depth_complete"] = certain ? ordered_json(found.depth.complete) : ordered_json(nullptr);
  line["depth_capped"] = certain ? ordered_json(found.depth.capped) : ordered_json(nullptr);
  line["self_intersecting"] = or_null(found.self_intersecting);
  line["depth_at_vertices"] = or_null(found.depth.at_vertices);
  line["depth_point"] = point_json(found.depth.point);
  line["escape"] = escape_json(found.escape);
  line["contacts"] = or_null(found.contacts);
  line["contact_depth"] = or_null(found.contact_depth);
  line["area"] = or_null(found.depth.area);
  line["sphere_tests"] = of_result(&QueryResult::sphere_tests);
  line["microseconds_min"] = time(&EngineAnswer::fastest);
  line["microseconds_median"] = time(&EngineAnswer::median);
  line["notes"] = found.notes;
  return line;
}

double EngineAnswer::fastest() const {
  return *std::min_element(microseconds.begin(), microseconds.end());
}

double EngineAnswer::median() const {
  std::vector<double> sorted = microseconds;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t half = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]);
}

}  // namespace ist::answers
