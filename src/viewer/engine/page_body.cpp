#include "viewer/engine/page_body.h"

#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "answers/body_json.h"
#include "answers/extents.h"
#include "answers/formats/level_geometry.h"
#include "answers/json_parts.h"
#include "ist/base/throw_error.h"
#include "ist/tree/tree_parts.h"

namespace ist::viewer {
namespace {

// A page has 4 GiB in all, for both bodies and all that is asked of them.
constexpr std::uint64_t kMostMemory = std::uint64_t{1} << 30;

std::vector<float> positions_of(const std::vector<Eigen::Vector3d>& points) {
  std::vector<float> positions;
  positions.reserve(3 * points.size());
  for (const Eigen::Vector3d& point : points) {
    for (int axis = 0; axis < 3; ++axis) positions.push_back(static_cast<float>(point[axis]));
  }
  return positions;
}

// Two triangles of each quad.
std::vector<std::uint32_t> halves_of(const std::vector<std::uint32_t>& quads) {
  std::vector<std::uint32_t> corners;
  corners.reserve(quads.size() / 4 * 6);
  for (std::size_t i = 0; i + 3 < quads.size(); i += 4) {
    for (const std::size_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) corners.push_back(quads[i + corner]);
  }
  return corners;
}

}  // namespace

PageBody::PageBody(const std::filesystem::path& file, LengthUnit unit, PatientFrame to_frame)
    : name_(file.filename().string()) {
  if (is_tree_file(file)) {
    tree_ = read_tree(file);
    if (contradict(tree_->frame(), to_frame)) {
      throw_error(ErrorCode::kArgumentInvalid,
                  "{}: a tree cannot be turned into another frame: open its mesh", name_);
    }
    whole_ = tree_;  // trees share their content
    source_ = tree_->source();
    std::optional<MeshReport> triangles;
    if (tree_->triangles() != nullptr) {
      mesh_ = *tree_->triangles();
      triangles = check_mesh(*mesh_);
    }
    info_ = answers::tree_json(name_, *tree_, triangles, level_statistics(*tree_));
    extent_ = answers::largest_extent(answers::box_of(*tree_));
  } else {
    mesh_ = read_mesh(file);
    turn_into(*mesh_, to_frame);
    source_ = answers::source_of(file);
    MeshReport report = check_mesh(*mesh_);
    info_ = answers::mesh_json(name_, report, source_, mesh_->frame);
    report.boundary_edges = 0;  // scans have them, and the page's panel counts them
    warnings_ = warnings(report);
    extent_ = answers::largest_extent(answers::box_of(*mesh_));
  }
  if (source_.unit == LengthUnit::kUnknown) source_.unit = unit;
}

BuildOptions PageBody::options(double voxel_size) const {
  BuildOptions options;
  options.voxel_size = voxel_size;
  options.max_memory = kMostMemory;
  options.source = source_;
  return options;
}

const SphereTree& PageBody::whole() {
  if (!whole_) whole_ = build_tree(*mesh_, options(0));
  return *whole_;
}

PageBody::Built PageBody::built(double voxel_size, Progress& progress) const {
  if (!rebuilds()) return {*tree_, milliseconds_};
  BuildReport report;
  SphereTree tree = build_tree(*mesh_, options(voxel_size), &report, &progress);
  const double milliseconds = std::accumulate(
      report.stages.begin(), report.stages.end(), 0.0,
      [](double sum, const BuildReport::Stage& stage) { return sum + stage.milliseconds; });
  return {std::move(tree), milliseconds};
}

void PageBody::take(Built built) {
  tree_ = std::move(built.tree);
  milliseconds_ = built.milliseconds;
}

nlohmann::ordered_json PageBody::facts(Reply& reply) const {
  nlohmann::ordered_json facts{{"name", name_},          {"info", info_},
                               {"warnings", warnings_},  {"extent", extent_},
                               {"rebuilds", rebuilds()}, {"unit", answers::json_of(source_.unit)}};
  if (mesh_) {
    std::vector<std::uint32_t> corners;
    corners.reserve(3 * mesh_->triangles.size());
    for (const Triangle& triangle : mesh_->triangles) {
      corners.insert(corners.end(), triangle.begin(), triangle.end());
    }
    facts["positions"] = reply.array(positions_of(mesh_->vertices));
    facts["triangles"] = reply.array(std::move(corners));
    return facts;
  }
  const answers::PolyData cubes = answers::level_cubes(*tree_, 0);
  facts["positions"] = reply.array(positions_of(cubes.points));
  facts["triangles"] = reply.array(halves_of(cubes.polygons));
  return facts;
}

nlohmann::ordered_json PageBody::tree_facts() const {
  const SphereTree& tree = *tree_;
  nlohmann::ordered_json nodes = nlohmann::ordered_json::array();
  for (int level = 0; level <= tree.depth(); ++level) {
    nodes.push_back(voxels_of(tree).octree.node_count(level));
  }
  return {{"voxel_size", tree.voxel_size()},
          {"leaves", tree.leaf_count()},
          {"depth", tree.depth()},
          {"nodes", nodes},
          {"bytes", tree.bytes()},
          {"tightest", std::string(to_string(tree.tightest()))},
          {"closed", tree.orientation() == Orientation::kOutward},
          {"milliseconds", milliseconds_}};
}

}  // namespace ist::viewer
