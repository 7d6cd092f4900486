#pragma once

#include <Eigen/Geometry>
#include <memory>

#include "ist/base/api.h"
#include "ist/mesh/mesh.h"
#include "ist/query/results.h"

namespace ist {

namespace detail {
struct InsideState;
}

/// Finds which of two meshes lies inside the other. Query::inside does so for two trees. Both
/// meshes must outlive the test.
class IST_LOOP_API InsideTest {
 public:
  /// Finds the components of both meshes, and makes clusters of their triangles. Throws
  /// kMeshNotFinite or kMeshBadIndex. Cost: 0.4 µs a triangle.
  InsideTest(const TriangleMesh& fixed, const TriangleMesh& moving);
  InsideTest(const TriangleMesh&&, const TriangleMesh&) = delete;
  InsideTest(const TriangleMesh&, const TriangleMesh&&) = delete;
  InsideTest(const TriangleMesh&&, const TriangleMesh&&) = delete;
  ~InsideTest();
  InsideTest(InsideTest&&) noexcept;  ///< the other may then only be assigned or destroyed
  InsideTest& operator=(InsideTest&&) noexcept;  ///< as the constructor

  /// Returns the body that has all its components inside the other one. Precondition: `pose` is
  /// rigid, and the surfaces do not intersect. Cost: some 3 µs for each component that lies in the
  /// bounding box of the other body.
  [[nodiscard]] Inside at(const Eigen::Isometry3d& pose) const noexcept;

 private:
  std::unique_ptr<const detail::InsideState> state_;
};

}  // namespace ist
