#include "ist/scene/scene_shapes.h"

#include "ist/base/float_environment.h"
#include "ist/mesh/jaw_model.h"
#include "ist/mesh/shape_model.h"

namespace ist {
namespace {

constexpr int kSphereLevel = 5;
constexpr int kCylinderQuarter = 64;

TriangleMesh centred_cylinder(double radius, double height) {
  TriangleMesh mesh = make_cylinder(kCylinderQuarter, radius, height);
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex.z() -= 0.5 * height;
  return mesh;
}

}  // namespace

TriangleMesh make_shape(const BuiltInShape& shape) {
  const ScopedFloatEnvironment environment;
  using Kind = BuiltInShape::Kind;
  switch (shape.kind) {
    case Kind::kUpperJaw:
      return make_jaw(Jaw::kUpper, shape.seed);
    case Kind::kLowerJaw:
      return make_jaw(Jaw::kLower, shape.seed);
    case Kind::kBox:
      return make_box(-0.5 * shape.size, 0.5 * shape.size);
    case Kind::kSphere:
      return make_icosphere(kSphereLevel, shape.radius);
    case Kind::kCylinder:
      return centred_cylinder(shape.radius, shape.height);
  }
  return {};
}

}  // namespace ist
