#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "answers/formats/csv_writer.h"
#include "support/errors.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

class Csv : public ::testing::Test {
 protected:
  const TempDir dir_;
  const std::filesystem::path file_ = dir_.path() / "table.csv";
};

TEST_F(Csv, QuotesWhatHasToBe) {
  answers::CsvWriter csv(file_, {"plain", "a,b", "say \"a\""});
  csv.row("text", "line\nline", std::string("\r"));
  csv.row("", "\"", " kept ");
  csv.commit();
  EXPECT_EQ(file_content(file_),
            "plain,\"a,b\",\"say \"\"a\"\"\"\n"
            "text,\"line\nline\",\"\r\"\n"
            "\"\",\"\"\"\", kept \n");
}

TEST_F(Csv, NumbersHaveTheFewestDigitsThatReadBack) {
  answers::CsvWriter csv(file_, {"a", "b", "c", "d"});
  csv.row(0.1, 0.1f, 1.0 / 3, -0.0);
  csv.row(1e300, 5e-324, std::nan(""), -std::numeric_limits<double>::infinity());
  csv.row(std::uint8_t{200}, std::int64_t{INT64_MIN}, std::uint64_t{UINT64_MAX}, true);
  csv.row(std::optional<double>(2.5), std::optional<double>(), std::optional<std::string>("x"), 7);
  csv.commit();
  EXPECT_EQ(file_content(file_),
            "a,b,c,d\n"
            "0.1,0.1,0.3333333333333333,-0\n"
            "1e+300,5e-324,nan,-inf\n"
            "200,-9223372036854775808,18446744073709551615,true\n"
            "2.5,,x,7\n");
}

TEST_F(Csv, ADecimalCommaPartsFieldsBySemicolons) {
  OutputFile file(file_);
  answers::CsvWriter csv(file, {"a", "b;c", "d"}, answers::DecimalSign::kComma);
  csv.row(0.5, "1.5, text", "x;y");
  csv.row(std::optional<double>(), 7, -2.25);
  csv.flush();
  file.commit();
  EXPECT_EQ(file_content(file_), "a;\"b;c\";d\n0,5;1.5, text;\"x;y\"\n;7;-2,25\n");
}

TEST_F(Csv, RowsMayBeCountedAtRunTime) {
  answers::CsvWriter csv(file_, std::vector<std::string>(40, "column"));
  std::string expected;
  for (int row = 0; row < 20000; ++row) {  // more than is kept in memory
    for (int i = 0; i < 40; ++i) {
      csv.add(row + i);
      expected += std::to_string(row + i) + (i < 39 ? "," : "\n");
    }
    csv.end_row();
  }
  csv.commit();
  const std::string content = file_content(file_);
  EXPECT_EQ(content.substr(content.find('\n') + 1), expected);
}

TEST_F(Csv, IsWholeOrNotThere) {
  {
    answers::CsvWriter csv(file_, {"a"});
    csv.row(1);
  }
  EXPECT_EQ(dir_.entries(), 0u);
  EXPECT_EQ(error_name([] { answers::CsvWriter("/none/table.csv", {"a"}); }), "file-unwritable");
}

}  // namespace
}  // namespace ist::test
