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

ordered_json triple(const std::optional<Eigen::Vector3d>& point) {
  return point ? ordered_json{(*point)[0], (*point)[1], (*point)[2]} : ordered_json(nullptr);
}

}  // namespace

ordered_json answer_line(std::size_t index, const PoseAnswer& answer, const Engine& engine,
                         const EngineAnswer& timed, const Bodies& bodies) {
  const Findings& found = answer.findings;
  const QueryResult& result = timed.result;
  const bool have_voxels = bodies.have_voxels();
  const auto of_voxels = [have_voxels](const ordered_json& value) {
    return have_voxels ? value : ordered_json(nullptr);
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
  line["engine"] = of_voxels(engine.name());
  line["spheres"] = of_voxels(to_string(bodies.policy));
  line["target"] = of_voxels(engine.target());
  line["workers"] = of_voxels(engine.workers());
  line["voxel_size"] = {or_null(bodies.fixed_voxel_size), or_null(bodies.moving_voxel_size)};
  line["resolution"] = of_voxels(result.resolution);
  line["complete"] = of_voxels(result.complete);
  line["truncated"] = of_voxels(result.truncated);
  line["level"] = of_voxels(result.level);
  line["touch"] = to_string(found.touch);
  line["inside"] = found.inside ? ordered_json(to_string(*found.inside)) : ordered_json(nullptr);
  line["leaf_pairs"] = of_voxels(result.leaf_pairs);
  line["triangle_pairs"] = or_null(found.triangle_pairs);
  line["distance_lower"] = lower(found.distance);
  line["distance_upper"] = upper(found.distance);
  line["distance_narrowest"] = or_null(found.narrowest);
  line["depth_lower"] = lower(found.depth.certain);
  line["depth_upper"] = upper(found.depth.certain);
  const bool certain = found.depth.certain.has_value();
  line["depth_complete"] = certain ? ordered_json(found.depth.complete) : ordered_json(nullptr);
  line["depth_capped"] = certain ? ordered_json(found.depth.capped) : ordered_json(nullptr);
  line["self_intersecting"] = or_null(found.self_intersecting);
  line["depth_at_vertices"] = or_null(found.depth.at_vertices);
  line["depth_point"] = triple(found.depth.point);
  line["contacts"] = or_null(found.contacts);
  line["contact_depth"] = or_null(found.contact_depth);
  line["area"] = or_null(found.depth.area);
  line["sphere_tests"] = of_voxels(result.sphere_tests);
  line["microseconds_min"] = of_voxels(timed.fastest());
  line["microseconds_median"] = of_voxels(timed.median());
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
