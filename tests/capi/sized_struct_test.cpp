// Structs of an older and of a newer header than the library's.

#include "ist/capi/sized_struct.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "capi/c_bodies.h"

namespace ist::test {
namespace {

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
const capi::Call kCall("f");

template <typename Given, typename Known>
Known& as(Given& given) {
  return reinterpret_cast<Known&>(given);
}

TEST(CSizedStruct, OfAnOlderHeaderGetsDefaults) {
  Old given{sizeof(Old), 2.5};
  New known{0, 1, 1, 1};
  ASSERT_EQ(name(capi::read_sized(kCall, "options", as<Old, New>(given), known)), "ok");
  EXPECT_EQ(known.a, 2.5);
  EXPECT_EQ(known.b, 0);
  EXPECT_EQ(known.c, 0);
}

TEST(CSizedStruct, OfANewerHeaderMayAskForWhatIsKnownOnly) {
  New given{sizeof(New), 2.5, 0, 0};
  Old known{};
  ASSERT_EQ(name(capi::read_sized(kCall, "options", as<New, Old>(given), known)), "ok");
  EXPECT_EQ(known.a, 2.5);
  EXPECT_EQ(known.struct_size, sizeof(Old));
  given.c = 1;
  EXPECT_EQ(name(capi::read_sized(kCall, "options", as<New, Old>(given), known)), "struct-size");
  EXPECT_STREQ(ist_last_error_message(),
               "f: options has 24 bytes, and a member after byte 16 is not zero: this library is "
               "older and does not know the member; set it to zero, or update the library");
}

TEST(CSizedStruct, NeedsASize) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{8}, std::size_t{17}, std::size_t{20},
                                 std::size_t{4104}, SIZE_MAX}) {
    New given{size, 1, 0, 0}, known{};
    EXPECT_EQ(name(capi::read_sized(kCall, "options", given, known)), "struct-size") << size;
    EXPECT_EQ(name(capi::clear_sized(kCall, "result", &given)), "struct-size") << size;
    EXPECT_EQ(given.a, 1);
  }
  EXPECT_EQ(name(capi::clear_sized<New>(kCall, "result", nullptr)), "null-argument");
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
