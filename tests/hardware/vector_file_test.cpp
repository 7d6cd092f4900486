#include "hardware/vector_file.h"

#include <gtest/gtest.h>
#include <xxhash.h>

#include <sstream>

#include "support/errors.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

std::string written(std::uint64_t count, std::uint64_t seed) {
  std::string text;
  write_vectors(count, seed, "ist 1.2.3",
                [&text](std::string_view part) { text.append(part.data(), part.size()); });
  return text;
}

std::string behind_header(const std::string& text) {
  std::size_t at = 0;
  for (int i = 0; i < 8; ++i) at = text.find('\n', at) + 1;
  return text.substr(at);
}

// With the checksum that the vectors have now.
std::string sealed(std::string text) {
  const std::string vectors = behind_header(text);
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx",
                static_cast<unsigned long long>(XXH64(vectors.data(), vectors.size(), 0)));
  return text.replace(text.find("xxh64 ") + 6, 16, digits);
}

class VectorFile : public ::testing::Test {
 protected:
  [[nodiscard]] VectorCheck checked(const std::string& text) const {
    return check_vectors(dir_.write("vectors.txt", text), 4);
  }
  // The error's name and text.
  [[nodiscard]] std::string refused(const std::string& text) const {
    const auto error = error_of([&] { static_cast<void>(checked(text)); });
    return error ? std::string(to_string(error->code())) + ": " + error->what() : "none";
  }
  // A file of one vector, `line`.
  [[nodiscard]] static std::string file_of(const std::string& line) {
    return sealed("#\n#\n# count 1\n#\n#\n#\n#\n# checksum xxh64 0000000000000000\n" + line + "\n");
  }
  const TempDir dir_;
};

// A vector whose answer is known: two full leaves at one place, not turned.
constexpr const char* kLine =
    "00000 00000 00000 00 ff 00000000 00000000 00000000 00 ff "
    "10000 00000 00000 00000 10000 00000 00000 00000 10000 "
    "0533 075a 0901 09cd 0a65 0004 00000014ce 1";

std::string with_field(std::size_t field, const std::string& value) {
  std::istringstream stream(kLine);
  std::string line, number;
  for (std::size_t i = 0; stream >> number; ++i) {
    line += (i == 0 ? "" : " ") + (i == field ? value : number);
  }
  return line;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(VectorFile, IsTheSameBytesEverywhere) {
  const auto checksum = [](std::uint64_t seed) {
    return write_vectors(20'000, seed, "ist 1.2.3", [](std::string_view) {});
  };
  EXPECT_EQ(checksum(1), 10919414297252463850u);
  EXPECT_EQ(checksum(2), 7777665724677356235u);
}

TEST_F(VectorFile, HasAHeaderAndAllDigits) {
  const std::string text = written(5000, 9);
  EXPECT_EQ(sealed(text), text) << "the checksum is not that of the vectors";
  std::istringstream stream(text);
  std::string line;
  const char* const known[] = {
      "; ist 1.2.3",   "# seed 9", "# count 5000",     "# fixed_x/20s", "# rotation0/20s",
      "# radius0/16u", "#",        "# checksum xxh64 "};
  for (const char* part : known) {
    std::getline(stream, line);
    EXPECT_TRUE(line[0] == '#' && has(line, part)) << line;
  }
  std::size_t lines = 0;
  for (; std::getline(stream, line); ++lines) {
    ASSERT_EQ(line.size(), std::string(kLine).size());
    for (std::size_t i = 0; i < line.size(); ++i) {
      ASSERT_EQ(line[i] == ' ', kLine[i] == ' ') << line;
    }
  }
  EXPECT_EQ(lines, 5000u);
}

TEST_F(VectorFile, AgreesWithTheModelThatWroteIt) {
  for (const std::uint64_t count : {1u, 100u, 30'000u}) {
    const VectorCheck check = checked(written(count, 4));
    EXPECT_EQ(check.vectors, count);
    EXPECT_EQ(check.wrong, 0u);
    EXPECT_TRUE(check.checksum_holds);
    EXPECT_TRUE(check.differences.empty());
  }
  EXPECT_EQ(checked(file_of(kLine)).hits, 1u);
  // With the ends of lines that other systems write, and in capitals.
  std::string text = file_of(with_field(4, "FF"));
  text.insert(text.size() - 1, "\r");
  EXPECT_EQ(checked(text).wrong, 0u);
  text.resize(text.size() - 2);  // and without the last
  EXPECT_EQ(checked(text).wrong, 0u);
}

TEST_F(VectorFile, SaysWhereAnswersDiffer) {
  VectorCheck check = checked(file_of(with_field(26, "0")));
  EXPECT_EQ(check.wrong, 1u);
  ASSERT_EQ(check.differences.size(), 1u);
  EXPECT_EQ(check.differences[0].line, 9u);
  EXPECT_STREQ(check.differences[0].field, "hit");
  EXPECT_EQ(check.differences[0].is, 0u);
  EXPECT_EQ(check.differences[0].should_be, 1u);

  check = checked(file_of(with_field(25, "00000014cf")));
  ASSERT_EQ(check.differences.size(), 1u);
  EXPECT_STREQ(check.differences[0].field, "reach");
  EXPECT_EQ(check.differences[0].is, 0x14cfu);
  EXPECT_EQ(check.differences[0].should_be, 0x14ceu);

  // Each input that is changed shows too: here all of one file, of which the first four are kept.
  std::string text = written(1000, 4);
  for (std::size_t end = text.find('\n', text.find("xxh64")); end + 1 < text.size();) {
    end = text.find('\n', end + 1);
    text[end - 1] = text[end - 1] == '0' ? '1' : '0';
  }
  check = checked(text);
  EXPECT_EQ(check.wrong, 1000u);
  EXPECT_EQ(check.differences.size(), 4u);
  EXPECT_FALSE(check.checksum_holds);
}

TEST_F(VectorFile, RefusesNumbersThatDoNotFit) {
  const std::vector<std::pair<std::size_t, std::string>> bad = {
      {0, "000000"},       {0, "60001"},       {1, "9ffff"},   {2, "7ffff"},     {3, "11"},
      {3, "1f"},           {3, "ff"},          {4, "100"},     {5, "100000000"}, {8, "11"},
      {9, "0ff"},          {10, "110000"},     {18, "000000"}, {19, "10000"},    {24, "fffff"},
      {25, "00000014cef"}, {25, "0200000000"}, {26, "2"},      {26, "f"},        {26, "01"}};
  for (const auto& [field, value] : bad) {
    const std::string refusal = refused(file_of(with_field(field, value)));
    EXPECT_EQ(refusal.rfind("fixed-point-range: ", 0), 0u)
        << field << ' ' << value << ' ' << refusal;
    EXPECT_TRUE(has(refusal, "vectors.txt, line 9, field ")) << refusal;
    EXPECT_TRUE(has(refusal, vector_fields()[field].name)) << refusal;
  }
  // And the last that do.
  for (const auto& [field, value] :
       std::vector<std::pair<std::size_t, std::string>>{{0, "60000"},
                                                        {1, "a0000"},
                                                        {3, "10"},
                                                        {8, "10"},
                                                        {5, "80000000"},
                                                        {10, "80000"},
                                                        {25, "01ffffffff"}}) {
    EXPECT_EQ(refused(file_of(with_field(field, value))), "none") << field << ' ' << value;
  }
}

TEST_F(VectorFile, RefusesWhatIsNone) {
  const std::string text = written(50, 4);
  const auto malformed = [&](const std::string& bad, const std::string& part) {
    const std::string refusal = refused(bad);
    EXPECT_EQ(refusal.rfind("input-invalid: ", 0), 0u) << refusal;
    EXPECT_TRUE(has(refusal, "vectors.txt")) << refusal;
    EXPECT_TRUE(has(refusal, part)) << refusal;
  };
  malformed("", "line 1: a vector file begins with 8 lines");
  malformed("hello\n", "line 1");
  malformed(std::string(5000, 'x'), "over 1000 characters");
  malformed("#\n#\n# count 1\n" + std::string(kLine), "line 4: a vector file begins");
  malformed(std::string(text).replace(text.find("# count 50"), 10, "# count ab"), "line 3");
  malformed(std::string(text).replace(text.find("# count 50"), 10, "# count 51"), "announces 51");
  malformed(std::string(text).replace(text.find("# count 50"), 10, "# count 49"), "holds more");
  malformed(std::string(text).replace(text.find("# count 50"), 10, "# count 00"), "0 vectors");
  malformed(std::string(text).replace(text.find("xxh64"), 5, "md5sm"), "line 8");
  malformed(text.substr(0, text.size() - 200), "");
  malformed(file_of(""), "line 9: 0 fields");
  malformed(file_of(std::string(kLine, std::string(kLine).rfind(' '))),
            "26 fields, and a vector has 27");
  malformed(file_of(std::string(kLine) + " 1"), "after the 27 fields");
  malformed(file_of(with_field(5, "0000000x")), "field moving_x: '0000000x' is not a hexadecimal");
  malformed(file_of(with_field(5, "-0000001")), "not a hexadecimal");
  malformed(file_of(with_field(10, "1000")), "must have 5 digits");
  // Two vectors changed about, whose answers are right: only the checksum tells.
  const std::size_t line = std::string(kLine).size() + 1, end = text.size();
  malformed(
      text.substr(0, end - 2 * line) + text.substr(end - line) + text.substr(end - 2 * line, line),
      "the vectors do not match the checksum");
}

}  // namespace
}  // namespace ist::test
