#include <algorithm>
#include <string>
#include <vector>

#include "cli/cli_case.h"

namespace ist::test {
namespace {

class Table : public CliTest {
 protected:
  void refuses(const std::vector<std::string>& arguments, const std::string& part) const {
    std::vector<std::string> all{"table"};
    std::string spelled = "ist table";
    for (const std::string& argument : arguments) {
      all.push_back(argument);
      spelled += " " + argument;
    }
    SCOPED_TRACE(spelled);
    const std::size_t before = dir_.entries();
    const CommandResult result = ist(all);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_TRUE(says(result.err, part));
    EXPECT_EQ(result.err.rfind("ist: ", 0), 0u) << result.err;
    EXPECT_EQ(dir_.entries(), before);
  }

  // A file of vectors in which one passage is another.
  [[nodiscard]] std::string changed(const std::string& from, const std::string& to) const {
    std::string text = ist_well({"table", "--vectors", "3"}).out;
    const std::size_t at = text.find(from, from[0] == '#' ? 0 : text.find("xxh64"));
    EXPECT_NE(at, std::string::npos);
    return write("changed.txt", text.replace(at, from.size(), to));
  }
};

TEST_F(Table, WritesEachFormatToStdoutOrAFile) {
  const std::vector<std::pair<std::string, std::string>> formats = {
      {"c", "static const uint16_t ist_table_rom[256]"},
      {"verilog", "module ist_table_rom"},
      {"vhdl", "entity ist_table_rom"},
      {"mem", "// checksum"},
      {"json", "\"radius_squared\": 108"}};
  const std::string version = ist_well({"--version"}).out;
  for (const auto& [format, part] : formats) {
    const CommandResult printed = ist_well({"table", "--format", format});
    EXPECT_TRUE(says(printed.out, part));
    EXPECT_TRUE(says(printed.out, version.substr(0, version.find('\n'))));
    EXPECT_EQ(printed.err, "");
    const CommandResult kept = ist_well({"table", "--format", format, "-o", path("table")});
    EXPECT_EQ(kept.out, path("table") + ": the table, as " + format + "\n");
    EXPECT_EQ(file_content(path("table")), printed.out);
  }
  const auto json =
      json_lines(ist_well({"table", "--format", "c", "-o", path("table.h"), "--json"}).out);
  ASSERT_EQ(json.size(), 1u);
  EXPECT_EQ(json[0], (nlohmann::json{{"file", "table.h"}, {"format", "c"}}));
}

TEST_F(Table, WritesVectorsThatItsModelAgreesWith) {
  const CommandResult printed = ist_well({"table", "--vectors", "4000", "--seed", "7"});
  EXPECT_TRUE(says(printed.out, "# seed 7\n# count 4000\n"));
  const std::string file = path("vectors.txt");
  ist_well({"table", "--vectors", "4000", "--seed", "7", "-o", file});
  EXPECT_EQ(file_content(file), printed.out);
  EXPECT_EQ(ist_well({"table", "--vectors", "4000"}).out,
            ist_well({"table", "--vectors", "4000", "--seed", "1"}).out);
  EXPECT_NE(ist_well({"table", "--vectors", "4000"}).out, printed.out);

  EXPECT_TRUE(says(ist_well({"table", "--check", file}).out, "4000 vectors agree with the model"));
  const auto json = json_lines(ist_well({"table", "--check", file, "--json"}).out);
  ASSERT_EQ(json.size(), 1u);
  EXPECT_EQ(json[0]["vectors"], 4000);
  EXPECT_GT(json[0]["hits"], 1000);
  EXPECT_EQ(json[0]["wrong"], 0);
  EXPECT_EQ(json[0]["checksum_holds"], true);
  const auto made =
      json_lines(ist_well({"table", "--vectors", "9", "--seed", "2", "-o", file, "--json"}).out);
  ASSERT_EQ(made.size(), 1u);
  EXPECT_EQ(made[0]["vectors"], 9);
  EXPECT_EQ(made[0]["seed"], 2);
  EXPECT_TRUE(says(file_content(file), "# checksum " + made[0]["checksum"].get<std::string>()));
}

TEST_F(Table, SaysWhereAnswersDiffer) {
  const std::string file = changed(" 0\n", " 1\n");
  const CommandResult result = ist({"table", "--check", file});
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_EQ(result.out, file + ", line 9: hit is 1, and 0 in the model\n");
  EXPECT_TRUE(says(result.err, "1 of 3 vectors differ from the model"));
  EXPECT_TRUE(says(result.err, "the checksum does not match the vectors"));

  const CommandResult json = ist({"table", "--check", file, "--json"});
  EXPECT_EQ(json.exit_code, 5);
  const auto lines = json_lines(json.out);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0]["wrong"], 1);
  EXPECT_EQ(lines[0]["differences"],
            (nlohmann::json{{{"line", 9}, {"field", "hit"}, {"is", 1}, {"should_be", 0}}}));
  EXPECT_EQ(lines[0]["checksum_holds"], false);
}

TEST_F(Table, RefusesNumbersOutOfRange) {
  const std::vector<std::pair<std::string, std::string>> changes = {
      {" 03 00 ", " 11 00 "},  // level 17
      {"\n00000 ", "\n60001 "},
      {"\n00000 ", "\n9ffff "},
      {" 00000000 ", " 000000000 "},
      {" 0\n", " 2\n"}};
  for (const auto& [from, to] : changes) {
    SCOPED_TRACE(to);
    const CommandResult result = ist({"table", "--check", changed(from, to)});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_TRUE(says(result.err, "changed.txt, line 9, field "));
    EXPECT_TRUE(says(result.err, "[fixed-point-range]"));
  }
}

TEST_F(Table, RefusesFilesThatAreNone) {
  const auto malformed = [](const std::string& file, const std::string& part) {
    const CommandResult result = ist({"table", "--check", file});
    EXPECT_EQ(result.exit_code, 3) << file;
    EXPECT_EQ(result.out, "");
    EXPECT_TRUE(says(result.err, part));
    EXPECT_TRUE(says(result.err, file));
  };
  malformed(path("none.txt"), "[file-unreadable]");
  malformed(write("empty.txt", ""), "line 1: a vector file begins with 8 lines");
  malformed(ball(), "[input-invalid]");
  malformed(changed("# count 3", "# count 4"),
            "announces 4 vectors, but the file ends before them");
  malformed(changed(" 0005 ", " 00o5 "), "line 9: field pad: '00o5' is not a hexadecimal number");
  malformed(changed("# checksum xxh64 ", "# checksum xxh32 "), "line 8");
}

TEST_F(Table, RefusesOptionsThatMakeNoSense) {
  refuses({}, "--format, --vectors, --check: give one of them");
  refuses({"--format", "cobol"}, "c, verilog, vhdl, mem, json");
  refuses({"--format", "D"}, "c, verilog, vhdl, mem, json");
  refuses({"--format", ""}, "--format");
  for (const char* count : {"0", "10000001", "99999999999999999999", "1.5", "many", "", "nan"}) {
    refuses({"--vectors", count}, "--vectors");
    refuses({"--vectors", count, "-o", path("out.txt")}, "--vectors");
  }
  refuses({"--vectors", "-1"}, "the number of vectors as decimal digits");
  refuses({"--vectors", "10", "--seed", "-1"}, "--seed");
  refuses({"--vectors", "10", "--seed", "x"}, "--seed");
  refuses({"--vectors", "10", "--seed", "18446744073709551616"}, "--seed");
  refuses({"--vectors", "10", "--seed", "010"}, "--seed");
  refuses({"--vectors", "010"}, "--vectors");
  refuses({"--vectors", "10", "--format", "c"}, "give one of them");
  refuses({"--check", path("in.txt"), "--format", "c"}, "give one of them");
  refuses({"--check", path("in.txt"), "--vectors", "10"}, "give one of them");
  refuses({"--seed", "1"}, "give one of them");
  refuses({"--format", "c", "--seed", "1"}, "--seed: goes with --vectors");
  refuses({"--check", path("in.txt"), "--seed", "1"}, "--seed: goes with --vectors");
  refuses({"--check", path("in.txt"), "-o", path("out.txt")}, "goes with --format or --vectors");
  refuses({"--format", "c", "--json"}, "--json");
  refuses({"--vectors", "10", "--json"}, "--json");
}

TEST_F(Table, WhatCannotBeWrittenIsNotThere) {
  const CommandResult result =
      ist({"table", "--format", "c", "-o", path("no-such-folder") + "/table.h"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(says(result.err, "[file-unwritable]"));
  EXPECT_EQ(dir_.entries(), 0u);
}

}  // namespace
}  // namespace ist::test
