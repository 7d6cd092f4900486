#pragma once

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "ist/capi/ist_servo.h"
#include "ist/mesh/mesh.h"

namespace ist::test {

/// A code's name: what a test compares and prints.
[[nodiscard]] inline std::string name(ist_status status) { return ist_status_name(status); }

/// A struct with its size, and what else is given.
template <typename Struct>
[[nodiscard]] Struct sized(Struct values = {}) {
  values.struct_size = sizeof(Struct);
  return values;
}

[[nodiscard]] inline ist_mesh* c_mesh(const TriangleMesh& mesh) {
  ist_mesh* made = nullptr;
  EXPECT_EQ(name(ist_mesh_create(mesh.vertices.front().data(), mesh.vertices.size(),
                                 mesh.triangles.front().data(), mesh.triangles.size(), &made)),
            "ok")
      << ist_last_error_message();
  return made;
}

[[nodiscard]] inline ist_tree* c_tree(const TriangleMesh& mesh, double voxel_size,
                                      bool keep_triangles = true) {
  ist_mesh* from = c_mesh(mesh);
  auto options = sized<ist_build_options>();
  options.voxel_size = voxel_size;
  options.drop_triangles = !keep_triangles;
  ist_tree* made = nullptr;
  EXPECT_EQ(name(ist_tree_build(from, &options, &made)), "ok") << ist_last_error_message();
  EXPECT_EQ(name(ist_mesh_free(from)), "ok");
  return made;
}

/// Of a tree with itself, and the tree is freed.
[[nodiscard]] inline ist_query* c_query(ist_tree* tree) {
  ist_query* made = nullptr;
  EXPECT_EQ(name(ist_query_create(tree, tree, nullptr, &made)), "ok") << ist_last_error_message();
  EXPECT_EQ(name(ist_tree_free(tree)), "ok");
  return made;
}

/// A ball above a box, for a servo.
inline constexpr const char* kSmallScene = R"(
unit = "mm"
[fixed]
shape = "box"
size = [10, 10, 4]
voxel_size = 0.5
[held]
shape = "sphere"
radius = 2
voxel_size = 0.5
translation = [0, 0, 4.5]
[device]
kind = "null"
[effects.springs]
)";

/// A pose column by column: a shift.
[[nodiscard]] inline std::array<double, 16> c_shift(double x, double y, double z) {
  return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1};
}

}  // namespace ist::test
