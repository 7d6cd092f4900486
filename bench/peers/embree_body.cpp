#include "peers/embree_body.h"

#include "ist/base/pose.h"

// What a mesh costs when it moves. Each vertex is a vector of four numbers here, in double and
// rounded to float, so that to move it, and to make the box of three, is a few instructions without
// a loop. Compiled so that no multiply and add is fused: see move().

namespace ist::bench {

std::vector<Corner> corners_of(const TriangleMesh& mesh) {
  std::vector<Corner> corners;
  corners.reserve(mesh.vertices.size());
  for (const Eigen::Vector3d& v : mesh.vertices) corners.emplace_back(v.x(), v.y(), v.z(), 1);
  return corners;
}

EmbreeBody::EmbreeBody(RTCDevice device, const TriangleMesh& mesh)
    : triangles_(mesh.triangles),
      vertices_(corners_of(mesh)),
      rounded_(vertices_.size()),
      scene_(rtcNewScene(device)),
      geometry_(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER)) {
  rtcSetGeometryUserPrimitiveCount(geometry_, static_cast<unsigned>(triangles_.size()));
  rtcSetGeometryUserData(geometry_, this);
  rtcSetGeometryBoundsFunction(geometry_, bounds, nullptr);
  // Only a scene of low quality asks how a geometry is to be built; this one is built well at
  // first, and refitted after. Both bodies' scenes are so, that their hierarchies are of one kind.
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC);
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);
  rtcSetGeometryBuildQuality(geometry_, RTC_BUILD_QUALITY_REFIT);
  round();
  rtcCommitGeometry(geometry_);
  rtcAttachGeometry(scene_, geometry_);
  rtcCommitScene(scene_);
}

EmbreeBody::~EmbreeBody() {
  rtcReleaseGeometry(geometry_);
  rtcReleaseScene(scene_);
}

void EmbreeBody::move(std::span<const Corner> from, const Eigen::Isometry3d& pose) {
  const Eigen::Isometry3d rigid = *project_to_rigid(pose);
  const Corner x = rigid.matrix().col(0), y = rigid.matrix().col(1), z = rigid.matrix().col(2),
               at = rigid.matrix().col(3);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Corner& v = from[i];
    vertices_[i] = ((x * v[0] + y * v[1]) + z * v[2]) + at;
  }
  round();
  rtcCommitGeometry(geometry_);
  rtcCommitScene(scene_);
}

// A float is off by no more than half of the margin. Rounding keeps an order, so the box of rounded
// corners is the rounded box.
void EmbreeBody::round() {
  Corner largest = Corner::Zero();
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    largest = largest.max(vertices_[i].abs());
    rounded_[i] = vertices_[i].cast<float>();
  }
  margin_ = static_cast<float>(largest.head<3>().maxCoeff() * 0x1p-22);
}

void EmbreeBody::bounds(const RTCBoundsFunctionArguments* args) {
  const EmbreeBody& body = *static_cast<const EmbreeBody*>(args->geometryUserPtr);
  const auto& [a, b, c] = body.triangles_[args->primID];
  const Eigen::Array4f &p = body.rounded_[a], &q = body.rounded_[b], &r = body.rounded_[c];
  Eigen::Map<Eigen::Array4f, Eigen::Aligned16> low(&args->bounds_o->lower_x);
  Eigen::Map<Eigen::Array4f, Eigen::Aligned16> high(&args->bounds_o->upper_x);
  low = p.min(q).min(r) - body.margin_;
  high = p.max(q).max(r) + body.margin_;
}

bool EmbreeBody::box_apart(unsigned triangle, const EmbreeBody& other, unsigned there) const {
  const auto& [a, b, c] = triangles_[triangle];
  const auto& [d, e, f] = other.triangles_[there];
  const Corner &p = vertices_[a], &q = vertices_[b], &r = vertices_[c];
  const Corner &u = other.vertices_[d], &v = other.vertices_[e], &w = other.vertices_[f];
  const Corner above = p.min(q).min(r) - u.max(v).max(w), below = u.min(v).min(w) - p.max(q).max(r);
  return above.max(below).maxCoeff() > 0;
}

TriangleCorners EmbreeBody::corners(unsigned triangle) const {
  const auto& [a, b, c] = triangles_[triangle];
  return {vertices_[a].head<3>(), vertices_[b].head<3>(), vertices_[c].head<3>()};
}

}  // namespace ist::bench
