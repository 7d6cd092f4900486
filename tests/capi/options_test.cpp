#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "c/sized_struct.h"
#include "capi/c_bodies.h"
#include "ist/mesh/mesh.h"
#include "ist/query/query.h"
#include "ist/tree/saved_spheres.h"
#include "ist/tree/sphere_tree.h"
#include "query/query_cases.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// The options of C queries, meshes of floats, and the geometry that answers count.

constexpr double kVoxelSize = 0.07;

// Without triangles, leaves alone decide: the answer may stay open, and a small tolerance out of
// reach.
TEST(CAnswer, MayStayOpenWithoutTriangles) {
  ist_query* query = c_query(c_tree(icosphere(2, 1), 0.2, false));
  std::int32_t answer = -1;
  ASSERT_EQ(name(ist_query_intersects(query, c_shift(1.8, 0, 0).data(), nullptr, &answer)), "ok");
  EXPECT_EQ(answer, IST_ANSWER_NEAR);
  ASSERT_EQ(name(ist_query_intersects(query, c_shift(9, 0, 0).data(), nullptr, &answer)), "ok");
  EXPECT_EQ(answer, IST_ANSWER_NO);
  auto c = sized<ist_triangle_pairs_result>();
  c.pairs = 7;
  EXPECT_EQ(
      name(ist_query_triangle_pairs(query, c_shift(1.8, 0, 0).data(), nullptr, nullptr, 0, &c)),
      "triangles-missing");
  EXPECT_EQ(c.pairs, 0u);
  auto near = sized<ist_near_pairs_result>();
  EXPECT_EQ(
      name(ist_query_near_pairs(query, c_shift(1.8, 0, 0).data(), 1, nullptr, nullptr, 0, &near)),
      "triangles-missing");

  auto distance = sized<ist_distance_result>();
  ASSERT_EQ(name(ist_query_distance(query, c_shift(2.5, 0, 0).data(), 1e-6, nullptr, &distance)),
            "ok");
  EXPECT_EQ(distance.complete, 0);
  EXPECT_EQ(distance.nearest_known, 0);
  EXPECT_GT(distance.upper - distance.lower, 1e-6);
  ASSERT_EQ(name(ist_query_distance(query, c_shift(2.5, 0, 0).data(), 10, nullptr, &distance)),
            "ok");
  EXPECT_EQ(distance.complete, 1);
  EXPECT_LE(distance.upper - distance.lower, 10);
  EXPECT_EQ(name(ist_query_free(query)), "ok");
}

TEST(CTree, WithoutOptionsHasTheDefaults) {
  ist_mesh* mesh = c_mesh(icosphere(2, 1));
  ist_tree *none = nullptr, *zeros = nullptr;
  const auto options = sized<ist_build_options>();
  ASSERT_EQ(name(ist_tree_build(mesh, nullptr, &none)), "ok");
  ASSERT_EQ(name(ist_tree_build(mesh, &options, &zeros)), "ok");
  auto of_none = sized<ist_tree_info>(), of_zeros = sized<ist_tree_info>();
  ASSERT_EQ(name(ist_tree_get_info(none, &of_none)), "ok");
  ASSERT_EQ(name(ist_tree_get_info(zeros, &of_zeros)), "ok");
  EXPECT_EQ(of_none.triangles, 320u);
  EXPECT_EQ(std::memcmp(&of_none, &of_zeros, sizeof of_none), 0);
  ist_tree_free(none);
  ist_tree_free(zeros);
  ist_mesh_free(mesh);
}

TEST(CAnswer, FollowsTheOptions) {
  ist_tree* tree = c_tree(icosphere(2, 1), 0.2);
  auto options = sized<ist_query_options>();
  options.spheres = IST_SPHERES_TABLE;
  options.workers = 2;
  options.period_ns = -1;
  options.contacts = 5;
  options.target = "scalar";
  ist_query* query = nullptr;
  ASSERT_EQ(name(ist_query_create(tree, tree, &options, &query)), "ok");
  auto info = sized<ist_query_info>();
  ASSERT_EQ(name(ist_query_get_info(query, &info)), "ok");
  EXPECT_EQ(info.spheres, IST_SPHERES_TABLE);
  EXPECT_EQ(info.workers, 2);
  EXPECT_EQ(info.contacts, 5u);
  EXPECT_EQ(info.has_triangles, 1);
  EXPECT_STREQ(info.target, "scalar");
  EXPECT_GT(info.bytes, 100'000u);
  auto result = sized<ist_query_result>();
  std::vector<ist_contact> contacts(8);
  ASSERT_EQ(name(ist_query_contacts(query, c_shift(1.8, 0, 0).data(), nullptr, contacts.data(), 8,
                                    nullptr, &result)),
            "ok");
  EXPECT_EQ(result.contacts, 5u);
  EXPECT_EQ(name(ist_query_free(query)), "ok");

  options.contacts = -1;
  ASSERT_EQ(name(ist_query_create(tree, tree, &options, &query)), "ok");
  auto sums = sized<ist_contact_sums>();
  sums.weight = 7;
  EXPECT_EQ(name(ist_query_contacts(query, c_shift(1.8, 0, 0).data(), nullptr, contacts.data(), 8,
                                    &sums, &result)),
            "not-prepared");
  EXPECT_EQ(sums.weight, 0);
  EXPECT_EQ(result.leaf_pairs + result.contacts, 0u);
  ASSERT_EQ(name(ist_query_get_info(query, &info)), "ok");
  EXPECT_EQ(info.contacts, 0u);
  EXPECT_EQ(name(ist_query_free(query)), "ok");
  EXPECT_EQ(name(ist_tree_free(tree)), "ok");
}

// A query that keeps near pairs answers from them, with the same bits.
TEST(CAnswer, KeepsNearPairs) {
  ist_tree* tree = c_tree(icosphere(2, 1), 0.2);
  auto options = sized<ist_query_options>();
  ist_query *fresh = nullptr, *keeps = nullptr;
  ASSERT_EQ(name(ist_query_create(tree, tree, &options, &fresh)), "ok");
  options.near_pairs = 2048;
  ASSERT_EQ(name(ist_query_create(tree, tree, &options, &keeps)), "ok");
  std::vector<ist_near_pair> wanted(2048), found(2048);
  int kept = 0;
  for (int tick = 0; tick < 60; ++tick) {
    const auto pose = c_shift(2.01 - 1e-5 * tick, 2e-5 * tick, 0);
    auto a = sized<ist_near_pairs_result>(), b = sized<ist_near_pairs_result>();
    ASSERT_EQ(name(ist_query_near_pairs(fresh, pose.data(), 0.05, nullptr, wanted.data(),
                                        wanted.size(), &a)),
              "ok");
    ASSERT_EQ(name(ist_query_near_pairs(keeps, pose.data(), 0.05, nullptr, found.data(),
                                        found.size(), &b)),
              "ok");
    EXPECT_EQ(a.found, IST_FOUND_FRESH);
    kept += b.found == IST_FOUND_KEPT;
    ASSERT_GT(a.written, 0u);
    ASSERT_EQ(a.written, b.written);
    EXPECT_EQ(std::memcmp(wanted.data(), found.data(), a.written * sizeof(ist_near_pair)), 0);
  }
  EXPECT_GT(kept, 20);
  EXPECT_EQ(name(ist_query_free(fresh)), "ok");
  EXPECT_EQ(name(ist_query_free(keeps)), "ok");
  EXPECT_EQ(name(ist_tree_free(tree)), "ok");
}

// A mesh of floats has the same coordinates in double.
TEST(CMesh, IsTheSameOfFloats) {
  const std::array<float, 9> floats = {0.1F, 0, 0, 1.3F, 0.2F, 0, 0, 2.7F, 0.4F};
  const std::array<std::uint32_t, 3> triangle = {0, 1, 2};
  ist_mesh* mesh = nullptr;
  ASSERT_EQ(name(ist_mesh_create_float(floats.data(), 3, triangle.data(), 1, &mesh)), "ok");
  auto info = sized<ist_mesh_info>();
  ASSERT_EQ(name(ist_mesh_get_info(mesh, nullptr, &info)), "ok");
  EXPECT_EQ(info.box_max[0], double{1.3F});
  EXPECT_EQ(info.box_max[1], double{2.7F});
  EXPECT_EQ(info.box_max[2], double{0.4F});
  EXPECT_EQ(info.closed, 0);
  EXPECT_EQ(info.boundary_edges, 3u);
  EXPECT_EQ(info.components, 1u);
  std::uint64_t vertices = 0, triangles = 0;
  ASSERT_EQ(name(ist_mesh_get_size(mesh, &vertices, &triangles)), "ok");
  EXPECT_EQ(vertices, 3u);
  EXPECT_EQ(triangles, 1u);
  EXPECT_EQ(name(ist_mesh_free(mesh)), "ok");
}

// The copies have the order of the indices in answers.
TEST(CGeometry, HasTheOrderOfAnswers) {
  const TriangleMesh mesh = icosphere(2, 1);
  ist_mesh* c = c_mesh(mesh);
  std::vector<double> vertices(3 * mesh.vertices.size() + 1, 7);
  std::vector<std::uint32_t> triangles(3 * mesh.triangles.size() + 1, 7);
  ASSERT_EQ(name(ist_mesh_copy(c, vertices.data(), mesh.vertices.size(), triangles.data(),
                               mesh.triangles.size())),
            "ok");
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(vertices[3 * i + static_cast<std::size_t>(axis)], mesh.vertices[i][axis]);
    }
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(triangles[3 * i + k], mesh.triangles[i][k]);
  }
  EXPECT_EQ(vertices.back(), 7);
  EXPECT_EQ(triangles.back(), 7u);
  // A short array, and a longer one than the mesh.
  std::vector<double> two(7, 5);
  ASSERT_EQ(name(ist_mesh_copy(c, two.data(), 2, nullptr, 0)), "ok");
  EXPECT_TRUE(std::equal(two.begin(), two.end() - 1, vertices.begin()));
  EXPECT_EQ(two.back(), 5);
  EXPECT_EQ(name(ist_mesh_free(c)), "ok");

  BuildOptions options;
  options.voxel_size = kVoxelSize;
  const SphereTree tree = build_tree(mesh, options);
  ist_tree* c_built = c_tree(mesh, kVoxelSize);
  const std::vector<Ball> cubes = level_spheres(tree, SpherePolicy::kSimple, 0);
  std::vector<double> centres(3 * cubes.size() + 3, 7);
  ASSERT_EQ(name(ist_tree_copy_leaf_centres(c_built, centres.data(), cubes.size() + 1)), "ok");
  for (std::size_t i = 0; i < cubes.size(); ++i) {
    const Eigen::Vector3d centre = tree.origin() + cubes[i].centre;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(centres[3 * i + static_cast<std::size_t>(axis)], centre[axis], 1e-15);
    }
  }
  EXPECT_EQ(centres[3 * cubes.size()], 7);
  EXPECT_EQ(name(ist_tree_free(c_built)), "ok");
}

// Structs of an older and of a newer header than the library's.

// An older and a newer version of one struct.
struct Old {
  std::size_t struct_size;
  double a;
};
struct New {
  std::size_t struct_size;
  double a;
  std::int32_t b, c;
};
// Reads the options of one call. Its status is in `status`.
template <typename Known>
Known read(const Known& given, ist_status& status) {
  capi::Call call("f");
  const Known known = capi::read_sized(call, "options", &given);
  status = call.status();
  return known;
}

template <typename Known>
std::string cleared(Known* given) {
  capi::Call call("f");
  capi::clear_sized(call, "result", given);
  return name(call.status());
}

template <typename Given, typename Known>
Known& as(Given& given) {
  return reinterpret_cast<Known&>(given);
}

TEST(CSizedStruct, OfAnOlderHeaderGetsDefaults) {
  Old given{sizeof(Old), 2.5};
  ist_status status = -1;
  const New known = read(as<Old, New>(given), status);
  ASSERT_EQ(name(status), "ok");
  EXPECT_EQ(known.a, 2.5);
  EXPECT_EQ(known.b, 0);
  EXPECT_EQ(known.c, 0);
}

TEST(CSizedStruct, OfANewerHeaderMayAskForWhatIsKnownOnly) {
  New given{sizeof(New), 2.5, 0, 0};
  ist_status status = -1;
  const Old known = read(as<New, Old>(given), status);
  ASSERT_EQ(name(status), "ok");
  EXPECT_EQ(known.a, 2.5);
  EXPECT_EQ(known.struct_size, sizeof(Old));
  given.c = 1;
  EXPECT_EQ(read(as<New, Old>(given), status).a, 0);
  EXPECT_EQ(name(status), "struct-size");
  EXPECT_STREQ(ist_last_error_message(),
               "f: options has 24 bytes, and a member after byte 16 is not zero: this library is "
               "older and does not know the member; set it to zero, or update the library");
}

TEST(CSizedStruct, NeedsASize) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{8}, std::size_t{17}, std::size_t{20},
                                 std::size_t{4104}, SIZE_MAX}) {
    New given{size, 1, 0, 0};
    ist_status status = -1;
    EXPECT_EQ(read(given, status).a, 0);
    EXPECT_EQ(name(status), "struct-size") << size;
    EXPECT_EQ(cleared(&given), "struct-size") << size;
    EXPECT_EQ(given.a, 1);
  }
  EXPECT_EQ(cleared<New>(nullptr), "null-argument");
}

TEST(CSizedStruct, IsFilledInAsFarAsItGoes) {
  std::array<New, 2> pair{New{sizeof(Old), 9, 9, 9}, New{9, 9, 9, 9}};
  capi::write_sized(New{0, 4, 5, 6}, pair[0]);
  EXPECT_EQ(pair[0].struct_size, sizeof(Old));
  EXPECT_EQ(pair[0].a, 4);
  EXPECT_EQ(pair[0].b, 9);  // beyond the caller's struct
  EXPECT_EQ(pair[1].a, 9);

  New longer{sizeof(New), 9, 9, 9};
  capi::write_sized(Old{0, 4}, as<New, Old>(longer));
  EXPECT_EQ(longer.struct_size, sizeof(New));
  EXPECT_EQ(longer.a, 4);
  EXPECT_EQ(longer.b, 0);
  EXPECT_EQ(longer.c, 0);
}

// Through the interface: the shortest build options, query options before margin, a result
// with two counts, a distance without its complete flag, and sums without springs.
TEST(CSizedStruct, OfAnyAgeServesACall) {
  ist_mesh* mesh = nullptr;
  const std::array<double, 9> corners = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::array<std::uint32_t, 3> triangle = {0, 1, 2};
  ASSERT_EQ(name(ist_mesh_create(corners.data(), 3, triangle.data(), 1, &mesh)), "ok");
  ist_build_options options{};
  options.struct_size = 16;
  options.voxel_size = 0.1;
  options.spheres = 99;  // beyond struct_size
  ist_tree* tree = nullptr;
  ASSERT_EQ(name(ist_tree_build(mesh, &options, &tree)), "ok") << ist_last_error_message();
  ist_query* query = c_query(tree);

  ist_query_result result{};
  result.struct_size = 24;
  result.written = 99;
  ASSERT_EQ(
      name(ist_query_leaf_pairs(query, c_shift(0, 0, 0).data(), nullptr, nullptr, 0, &result)),
      "ok");
  EXPECT_GT(result.leaf_pairs, 0u);
  EXPECT_EQ(result.written, 99u);

  ist_distance_result distance{};
  distance.struct_size = 32;
  distance.complete = 99;
  ASSERT_EQ(name(ist_query_distance(query, c_shift(3, 0, 0).data(), 0.1, nullptr, &distance)),
            "ok");
  EXPECT_GT(distance.upper, 1);
  EXPECT_EQ(distance.complete, 99);

  ist_contact_sums sums{};
  sums.struct_size = 72;
  sums.spring_force[0] = sums.about[2] = 99;
  const std::array<double, 16> opposite = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0.7, -0.02, 1};
  ASSERT_EQ(name(ist_query_contacts(query, opposite.data(), nullptr, nullptr, 0, &sums, &result)),
            "ok");
  EXPECT_GT(sums.pairs, 0u);
  EXPECT_EQ(sums.spring_force[0], 99);
  EXPECT_EQ(sums.about[2], 99);
  double force[3], torque[3];
  ASSERT_EQ(name(ist_contact_sums_wrench(&sums, 1, force, torque)), "ok");
  EXPECT_EQ(force[0], 0);  // beyond struct_size
  EXPECT_EQ(name(ist_query_free(query)), "ok");

  ist_query_options asked{};
  asked.struct_size = 56;
  asked.margin = 99;  // beyond struct_size
  ASSERT_EQ(name(ist_tree_build(mesh, &options, &tree)), "ok");
  ASSERT_EQ(name(ist_query_create(tree, tree, &asked, &query)), "ok") << ist_last_error_message();
  EXPECT_EQ(name(ist_query_free(query)), "ok");
  EXPECT_EQ(name(ist_tree_free(tree)), "ok");
  EXPECT_EQ(name(ist_mesh_free(mesh)), "ok");
}

}  // namespace
}  // namespace ist::test
