#include "ist/sweep/thrift_struct.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sweep/hex.h"

namespace ist::test {
namespace {

std::string hex_of(const ThriftStruct& fields) { return hex(fields.bytes()); }

TEST(ThriftStruct, WithoutFieldsIsTheStop) { EXPECT_EQ(hex_of(ThriftStruct()), "00"); }

TEST(ThriftStruct, FieldsCountFromTheLastId) {
  // 1 of 1 is 0x15, 3 of 2 more is 0x25, 18 of 15 more is 0xF5.
  EXPECT_EQ(hex_of(ThriftStruct().i32(1, 0).i32(3, 0).i32(18, 0)), "15 00 25 00 F5 00 00");
}

TEST(ThriftStruct, HasATypeForEachField) {
  const ThriftStruct fields =
      ThriftStruct().boolean(1, true).boolean(2, false).i8(3, -1).i32(4, 1).i64(5, 1).binary(6,
                                                                                             "a");
  EXPECT_EQ(hex_of(fields), "11 12 13 FF 15 02 16 02 18 01 61 00");
}

TEST(ThriftStruct, NumbersAreZigzagVarints) {
  const std::vector<std::pair<std::int32_t, std::string>> cases{
      {0, "00"},
      {-1, "01"},
      {1, "02"},
      {-2, "03"},
      {2, "04"},
      {63, "7E"},
      {-64, "7F"},
      {64, "80 01"},
      {-65, "81 01"},
      {8191, "FE 7F"},
      {-8192, "FF 7F"},
      {8192, "80 80 01"},
      {1048575, "FE FF 7F"},
      {1048576, "80 80 80 01"},
      {134217727, "FE FF FF 7F"},
      {134217728, "80 80 80 80 01"},
      {std::numeric_limits<std::int32_t>::max(), "FE FF FF FF 0F"},
      {std::numeric_limits<std::int32_t>::min(), "FF FF FF FF 0F"},
  };
  for (const auto& [number, varint] : cases) {
    EXPECT_EQ(hex_of(ThriftStruct().i32(1, number)), "15 " + varint + " 00") << number;
    EXPECT_EQ(hex_of(ThriftStruct().i64(1, number)), "16 " + varint + " 00") << number;
  }
}

TEST(ThriftStruct, LongNumbersTakeUpToTenBytes) {
  const std::vector<std::pair<std::int64_t, std::string>> cases{
      {std::int64_t{1} << 31, "80 80 80 80 10"},
      {-(std::int64_t{1} << 31) - 1, "81 80 80 80 10"},
      {(std::int64_t{1} << 62) - 1, "FE FF FF FF FF FF FF FF 7F"},
      {std::int64_t{1} << 62, "80 80 80 80 80 80 80 80 80 01"},
      {std::numeric_limits<std::int64_t>::max(), "FE FF FF FF FF FF FF FF FF 01"},
      {std::numeric_limits<std::int64_t>::min(), "FF FF FF FF FF FF FF FF FF 01"},
  };
  for (const auto& [number, varint] : cases) {
    EXPECT_EQ(hex_of(ThriftStruct().i64(1, number)), "16 " + varint + " 00") << number;
  }
}

TEST(ThriftStruct, LengthsAreVarintsWithoutSign) {
  EXPECT_EQ(hex_of(ThriftStruct().binary(1, "")), "18 00 00");
  EXPECT_EQ(hex_of(ThriftStruct().binary(1, std::string_view("\0\xFF", 2))), "18 02 00 FF 00");
  const auto header_of = [](std::size_t length, std::size_t bytes) {
    const std::string written = ThriftStruct().binary(1, std::string(length, 'x')).bytes();
    EXPECT_EQ(written.size(), bytes + length + 1);
    EXPECT_EQ(written.substr(bytes), std::string(length, 'x') + '\0');
    return hex(written.substr(0, bytes));
  };
  EXPECT_EQ(header_of(127, 2), "18 7F");
  EXPECT_EQ(header_of(128, 3), "18 80 01");
  // The specification's example.
  EXPECT_EQ(header_of(50399, 4), "18 DF 89 03");
}

TEST(ThriftStruct, StructsNestAndCountTheirIdsAnew) {
  const ThriftStruct inner = ThriftStruct().i32(1, -1).structure(2, ThriftStruct());
  EXPECT_EQ(hex_of(ThriftStruct().structure(10, inner).i32(11, 1)), "AC 15 01 1C 00 00 15 02 00");
}

TEST(ThriftStruct, ListsHaveTheirTypeAndTheirSize) {
  EXPECT_EQ(hex_of(ThriftStruct().i32_list(1, {})), "19 05 00");
  EXPECT_EQ(hex_of(ThriftStruct().i32_list(1, std::array{0, -1, 300})), "19 35 00 01 D8 04 00");
  const std::array<std::string_view, 2> words{"ab", ""};
  EXPECT_EQ(hex_of(ThriftStruct().binary_list(2, words)), "29 28 02 61 62 00 00");
  const std::array structs{ThriftStruct().boolean(1, true), ThriftStruct()};
  EXPECT_EQ(hex_of(ThriftStruct().struct_list(1, structs).i32(2, 0)), "19 2C 11 00 00 15 00 00");
}

TEST(ThriftStruct, ListsOfFifteenAndMoreSayTheirSizeBehind) {
  const auto list_of = [](std::size_t size) {
    return ThriftStruct().i32_list(1, std::vector<std::int32_t>(size, 1)).bytes();
  };
  const auto elements = [](std::size_t size) { return std::string(size, '\x02') + '\0'; };
  EXPECT_EQ(list_of(14), "\x19\xE5" + elements(14));
  EXPECT_EQ(list_of(15), "\x19\xF5\x0F" + elements(15));
  EXPECT_EQ(list_of(127), "\x19\xF5\x7F" + elements(127));
  EXPECT_EQ(list_of(128), "\x19\xF5\x80\x01" + elements(128));

  const std::vector<ThriftStruct> structs(16);
  EXPECT_EQ(ThriftStruct().struct_list(1, structs).bytes(), "\x19\xFC\x10" + std::string(17, '\0'));
  const std::vector<std::string_view> words(20, "");
  EXPECT_EQ(ThriftStruct().binary_list(1, words).bytes(), "\x19\xF8\x14" + std::string(21, '\0'));
}

}  // namespace
}  // namespace ist::test
