#include "answers/body_json.h"

#include <nlohmann/json.hpp>

#include "answers/extents.h"
#include "answers/json_parts.h"
#include "ist/tree/tree_parts.h"

namespace ist::answers {
namespace {

using nlohmann::ordered_json;

ordered_json numbers(const Eigen::Vector3d& vector) { return {vector[0], vector[1], vector[2]}; }

// Adds the keys that a mesh and a tree share; without a report the surface's are null.
void add_measures(ordered_json& line, const Eigen::Vector3d& extent,
                  const std::optional<MeshReport>& report, const MeshSource& source,
                  PatientFrame frame) {
  line["extent"] = numbers(extent);
  for (const char* key : {"closed", "consistent", "volume"}) line[key] = nullptr;
  if (report) {
    line["closed"] = report->closed;
    line["consistent"] = report->consistent;
    if (report->closed && report->consistent) line["volume"] = report->signed_volume;
  }
  line["unit"] = json_of(source.unit);
  line["frame"] = json_of(frame);
  line["source"] = json_of(source);
}

ordered_json places(const MeshReport& report) {
  ordered_json list = ordered_json::array();
  for (const SelfIntersection& one : report.first_self_intersections) {
    list.push_back({{"triangles", one.triangles}, {"near", numbers(one.near)}});
  }
  return list;
}

}  // namespace

ordered_json mesh_json(const std::string& file, const MeshReport& report, const MeshSource& source,
                       PatientFrame frame) {
  ordered_json line{{"file", file},
                    {"kind", "mesh"},
                    {"vertices", report.vertices},
                    {"triangles", report.triangles},
                    {"components", report.components},
                    {"boundary_edges", report.boundary_edges},
                    {"non_manifold_edges", report.non_manifold_edges},
                    {"duplicate_triangles", report.duplicate_triangles},
                    {"degenerate_triangles", report.degenerate_triangles},
                    {"inconsistent_edges", report.inconsistent_edges},
                    {"self_intersections", report.self_intersections},
                    {"self_intersections_complete", report.self_intersections_complete},
                    {"first_self_intersections", places(report)},
                    {"box_min", numbers(report.box_min)},
                    {"box_max", numbers(report.box_max)},
                    {"warnings", warnings(report)}};
  add_measures(line, report.box_max - report.box_min, report, source, frame);
  return line;
}

ordered_json tree_json(const std::string& file, const SphereTree& tree,
                       const std::optional<MeshReport>& triangles,
                       std::span<const LevelStatistics> levels) {
  ordered_json line{
      {"file", file},
      {"kind", "tree"},
      {"voxel_size", voxel_size_json(tree)},
      {"cells", nullptr},
      {"depth", nullptr},
      {"voxels", nullptr},
      {"nodes", nullptr},
      {"memory", tree.bytes()},
      {"orientation", tree.orientation() == Orientation::kOutward ? "outward" : "assumed"},
      {"triangles", tree.triangles() != nullptr},
      {"proximity", tree.has_proximity()}};
  if (tree.has_voxels()) {
    line["cells"] = voxels_of(tree).lattice.cells;
    line["depth"] = tree.depth();
    line["voxels"] = tree.leaf_count();
    line["nodes"] = voxels_of(tree).octree.node_count();
  }
  for (const char* key : {"self_intersections", "self_intersections_complete"}) line[key] = nullptr;
  if (triangles) {
    line["self_intersections"] = triangles->self_intersections;
    line["self_intersections_complete"] = triangles->self_intersections_complete;
  }
  add_measures(line, box_of(tree).sizes(), triangles, tree.source(), tree.frame());
  line["levels"] = ordered_json::array();
  for (const LevelStatistics& level : levels) {
    ordered_json row{{"level", level.level}, {"edge", level.edge}, {"nodes", level.nodes}};
    for (const LevelSpheres& spheres : level.spheres) {
      row["volume"][std::string(to_string(spheres.policy))] = spheres.volume;
      row["milliseconds"][std::string(to_string(spheres.policy))] = spheres.milliseconds;
    }
    line["levels"].push_back(row);
  }
  return line;
}

}  // namespace ist::answers
