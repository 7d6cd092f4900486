// Structs of an older and of a newer header than the library's.

#include "ist/capi/sized_struct.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "capi/c_bodies.h"

namespace ist::test {
namespace {

// What a header gave first, and what it gave later.
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
               "f: options has 24 bytes, and what is behind the first 16 is not zero: this library "
               "is older than that, and does not know what it means");
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
  EXPECT_EQ(pair[0].b, 9);  // not the caller's struct any more
  EXPECT_EQ(pair[1].a, 9);

  New longer{sizeof(New), 9, 9, 9};
  capi::write_sized(Old{0, 4}, as<New, Old>(longer));
  EXPECT_EQ(longer.struct_size, sizeof(New));
  EXPECT_EQ(longer.a, 4);
  EXPECT_EQ(longer.b, 0);
  EXPECT_EQ(longer.c, 0);
}

// Through the interface: options of a time when there was nothing but the voxel size, and a result
// of a time when there were but two counts.
TEST(CSizedStruct, OfAnyAgeServesACall) {
  ist_mesh* mesh = nullptr;
  const std::array<double, 9> corners = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::array<std::uint32_t, 3> triangle = {0, 1, 2};
  ASSERT_EQ(name(ist_mesh_create(corners.data(), 3, triangle.data(), 1, &mesh)), "ok");
  ist_build_options options{};
  options.struct_size = 16;
  options.voxel_size = 0.1;
  options.spheres = 99;  // behind what is there
  ist_tree* tree = nullptr;
  ASSERT_EQ(name(ist_tree_build(mesh, &options, &tree)), "ok") << ist_last_error_message();
  ist_query* query = c_query(tree);

  ist_query_result result{};
  result.struct_size = 24;
  result.written = 99;
  ASSERT_EQ(name(ist_query_collide(query, c_shift(0, 0, 0).data(), nullptr, 0, &result)), "ok");
  EXPECT_GT(result.contacts, 0u);
  EXPECT_EQ(result.written, 99u);
  EXPECT_EQ(name(ist_query_free(query)), "ok");
  EXPECT_EQ(name(ist_mesh_free(mesh)), "ok");
}

}  // namespace
}  // namespace ist::test
