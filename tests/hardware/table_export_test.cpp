#include "hardware/table_export.h"

#include <gtest/gtest.h>
#include <xxhash.h>

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "ist/tree/lookup_table.h"
#include "support/run_command.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

using Words = std::array<unsigned, 256>;

// From the table, and not from the library's words.
Words expected_words() {
  const auto code = [](int x) {
    return x < 0 ? 4u + static_cast<unsigned>(-x) : static_cast<unsigned>(x);
  };
  Words words{};
  for (std::size_t mask = 0; mask < 256; ++mask) {
    const TableBall ball = kLookupTable[mask];
    unsigned radius = 7;
    for (unsigned i = 0; i < 5; ++i) {
      if (std::array{27, 54, 81, 96, 108}[i] == ball.radius_squared) radius = i;
    }
    words[mask] = code(ball.x) + 8 * code(ball.y) + 64 * code(ball.z) + 512 * radius;
  }
  return words;
}

std::string expected_checksum() {
  std::array<unsigned char, 512> bytes{};
  for (std::size_t mask = 0; mask < 256; ++mask) {
    bytes[2 * mask] = static_cast<unsigned char>(expected_words()[mask] % 256);
    bytes[2 * mask + 1] = static_cast<unsigned char>(expected_words()[mask] / 256);
  }
  char text[17];
  std::snprintf(text, sizeof text, "%016llx",
                static_cast<unsigned long long>(XXH64(bytes.data(), bytes.size(), 0)));
  return text;
}

std::string text_of(TableFormat format) { return table_text(format, "ist 1.2.3"); }

// The hexadecimal numbers that a pattern's first group finds, in their order.
Words words_in(const std::string& text, const char* pattern) {
  Words words{};
  const std::regex number(pattern);
  std::size_t found = 0;
  for (std::sregex_iterator at(text.begin(), text.end(), number), end; at != end; ++at, ++found) {
    if (found < words.size())
      words[found] = static_cast<unsigned>(std::stoul((*at)[1], nullptr, 16));
  }
  EXPECT_EQ(found, words.size());
  return words;
}

TEST(TableExport, NamesItsChecksumAndWhoWroteIt) {
  for (const auto& [name, format] : kTableFormats) {
    const std::string text = text_of(format);
    EXPECT_NE(text.find("ist 1.2.3"), std::string::npos) << name;
    EXPECT_NE(text.find("xxh64 " + expected_checksum()), std::string::npos) << name;
    EXPECT_EQ(text.back(), '\n') << name;
  }
}

TEST(TableExport, MemHoldsTheWords) {
  std::istringstream stream(text_of(TableFormat::kMem));
  std::string words;
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("//", 0) != 0) words += line + "\n";
  }
  EXPECT_EQ(words_in(words, "([0-9a-f]{3})\\b"), expected_words());
  EXPECT_EQ(words.find_first_not_of("0123456789abcdef \n"), std::string::npos);
}

TEST(TableExport, VerilogAndVhdlHoldTheWords) {
  EXPECT_EQ(words_in(text_of(TableFormat::kVerilog), "= 12'h([0-9a-f]{3});"), expected_words());
  EXPECT_EQ(words_in(text_of(TableFormat::kVhdl), "x\"([0-9a-f]{3})\""), expected_words());
}

TEST(TableExport, JsonIsAnArrayOfBalls) {
  const nlohmann::json balls = nlohmann::json::parse(text_of(TableFormat::kJson));
  ASSERT_EQ(balls.size(), 255u);
  for (std::size_t mask = 1; mask < 256; ++mask) {
    const nlohmann::json& ball = balls[mask - 1];
    const TableBall expected = kLookupTable[mask];
    EXPECT_EQ(ball["mask"], mask);
    EXPECT_EQ(ball["centre"], (nlohmann::json{expected.x, expected.y, expected.z}));
    EXPECT_EQ(ball["radius_squared"], expected.radius_squared);
    EXPECT_EQ(ball["generator"], "ist 1.2.3");
    EXPECT_EQ(ball["checksum"], "xxh64 " + expected_checksum());
  }
}

// The header, as a C11 compiler understands it: all that it decodes of each mask is printed by a
// program that includes it.
TEST(TableExport, CIsReadByACCompiler) {
  const TempDir dir;
  dir.write("ist_table_rom.h", text_of(TableFormat::kC));
  const std::string source = dir.write("print.c", R"(
#include "ist_table_rom.h"
#include <stdio.h>
int main(void) {
  printf("%s %016llx", IST_TABLE_GENERATOR, (unsigned long long)IST_TABLE_CHECKSUM);
  for (int code = 0; code < 5; ++code) {
    printf(" %d %d", ist_table_radius_squared[code], ist_table_fixed_radius[code]);
  }
  printf("\n");
  for (int mask = 0; mask < 256; ++mask) {
    const uint16_t word = ist_table_rom[mask];
    printf("%d %d %d %d %d\n", word, IST_TABLE_X(word), IST_TABLE_Y(word), IST_TABLE_Z(word),
           IST_TABLE_RADIUS_CODE(word));
  }
  return 0;
}
)");
  const std::string program = dir.path() / "print";
  const CommandResult compiled =
      run_command(IST_COMPILER, {"-x", "c", "-std=c11", "-Wall", "-Wextra", "-Wpedantic",
                                 "-Wconversion", "-Werror", source, "-o", program});
  ASSERT_EQ(compiled.exit_code, 0) << compiled.err;
  std::istringstream out(run_command(program, {}).out);
  std::string line;
  std::getline(out, line);
  EXPECT_EQ(line, "ist 1.2.3 " + expected_checksum() + " 27 1331 54 1882 81 2304 96 2509 108 2661");
  for (std::size_t mask = 0; mask < 256; ++mask) {
    const TableBall ball = kLookupTable[mask];
    const unsigned word = expected_words()[mask];
    std::getline(out, line);
    std::ostringstream expected;
    expected << word << ' ' << int{ball.x} << ' ' << int{ball.y} << ' ' << int{ball.z} << ' '
             << word / 512;
    EXPECT_EQ(line, expected.str()) << mask;
  }
}

}  // namespace
}  // namespace ist::test
