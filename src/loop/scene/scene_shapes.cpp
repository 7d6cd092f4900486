
#include "ist/base/error.h"
#include "ist/base/float_environment.h"
#include "ist/base/throw_error.h"
#include "ist/models/models.h"
#include "ist/scene.h"

namespace ist {
namespace {

constexpr int kSphereLevel = 5;
constexpr int kCylinderQuarter = 64, kFossaQuarter = 32;

void check_length(double length) {
  if (length >= 1e-12 && length <= 1e12) return;
  throw_error(ErrorCode::kArgumentInvalid, "a shape of length {}: give lengths from 1e-12 to 1e12",
              length);
}

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
      for (const double length : shape.size) check_length(length);
      return make_box(-0.5 * shape.size, 0.5 * shape.size);
    case Kind::kSphere:
      check_length(shape.radius);
      return make_icosphere(kSphereLevel, shape.radius);
    case Kind::kCylinder:
      check_length(shape.radius);
      check_length(shape.height);
      return centred_cylinder(shape.radius, shape.height);
    case Kind::kSplint:
      return make_splint(shape.seed, shape.opening);
    case Kind::kFossa:
      check_length(shape.radius);
      check_length(shape.thickness);
      return make_fossa(kFossaQuarter, shape.radius, shape.thickness);
  }
  throw Error(ErrorCode::kArgumentInvalid,
              "an unknown kind of shape: give one of BuiltInShape::Kind");
}

}  // namespace ist
