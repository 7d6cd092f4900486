// What `ist sweep` refuses: words, sweep files, folders and parts.

#include <sys/stat.h>
#include <unistd.h>

#include <utility>

#include "cli/sweep_case.h"
#include "support/effort.h"

namespace ist::test {
namespace {

TEST_F(SweepCommand, RefusesWhatIsNoUseOfIt) {
  const std::string job = sweep_file({});
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
      {{"--share", "2/2"}, "--share: 2/2 is no share: k is from 0 to N - 1"},
      {{"--share", "0/0"}, "--share: 0/0 is no share: k is from 0 to N - 1"},
      {{"--share", "a/b"}, "--share: a/b is no share: give k/N, two whole numbers"},
      {{"--share", "-1/2"}, "--share: -1/2 is no share: give k/N, two whole numbers"},
      {{"--share", "0/1/2"}, "--share: 0/1/2 is no share: give k/N, two whole numbers"},
      {{"--share", "1"}, "--share: 1 is no share: give k/N, such as 0/4"},
      {{"--merge", "--share", "0/2"}, "excludes"},
      {{"--merge", "--threads", "2"}, "excludes"},
      {{"--merge", "--status"}, "excludes"},
      {{"--status", "--share", "0/2"}, "excludes"},
      {{"--verify"}, "--verify requires --status"},
      {{"--threads", "-1"}, "--threads"},
      {{"--threads", "1025"}, "--threads"},
      {{"--shares", "0/2"}, "--share"}};
  for (const auto& [words, text] : wrong) {
    const CommandResult result = sweep(job, "out", words);
    EXPECT_EQ(result.exit_code, 2) << words[0] << " " << words.back();
    EXPECT_TRUE(says(result.err, text));
    EXPECT_FALSE(exists("out")) << words[0];
  }
  const CommandResult nowhere = ist({"sweep", job});
  EXPECT_EQ(nowhere.exit_code, 2);
  EXPECT_TRUE(says(nowhere.err, "--output is required"));
}

// Each wrong file is the right one with a text replaced; the message names its line and a remedy.
TEST_F(SweepCommand, RefusesASweepFileWithLineAndRemedy) {
  struct Wrong {
    std::string from, to;
    int line;  // 0: the message is of another file
    std::string text;
  };
  const std::vector<Wrong> wrong = {
      {"answers", "answrs", 1, "'answrs' in the file is unknown: did you mean 'answers'?"},
      {"\"intersects\"", "\"intersect\"", 1,
       "'answers' has \"intersect\": give some of \"intersects\", "},
      {"\"intersects\", \"distance\"", "", 1,
       "'answers' in the file is an array of 0: give some of"},
      {"tolerance = 0.01", "tolerance = -1", 2,
       "'tolerance' in the file is -1: give a number from 0 to "},
      {"tolerance", "tolerence", 2, "did you mean 'tolerance'?"},
      {"rows_per_part = 10", "rows_per_part = 0", 3,
       "'rows_per_part' in the file is 0: give a whole number, 1 to "},
      {"rows_per_part", "rows_per_parts", 3, "did you mean 'rows_per_part'?"},
      {"[fixed]", "[fixd]", 4, "did you mean 'fixed'?"},
      {"tree =", "fil =", 5, "'fil' in [fixed] is unknown: did you mean 'file'?"},
      {"tree =", "tre =", 5, "'tre' in [fixed] is unknown: did you mean 'tree'?"},
      {"[fixed]\n", "[fixed]\nhash = \"00\"\n", 5, "ball.ist changed: its hash is "},
      {"poses.box", "poses.bx", 8, "'bx' in [poses] is unknown: did you mean 'box'?"},
      {"[poses.box]", "[poses]\n[other.box]", 8,
       "[poses] names none of 'axes', 'box' and 'file': give one"},
      {"[poses.box]", "[poses]\nfile = \"poses.npy\"\n[poses.box]", 8,
       "[poses] names more than one of"},
      {"seed", "sead", 9, "'sead' in [poses.box] is unknown: did you mean 'seed'?"},
      {"count = 25", "count = -3", 10,
       "'count' in [poses.box] is -3: give a whole number, 0 to 1000000000000"},
      {"count = 25", "count = 2.5", 10, "give a whole number"},
      {"count = 25", "count = 1000000000000", 3, "set rows_per_part = 1000000 or more"},
      {"from = [2,", "from = [6,", 12,
       "'to' in [poses.box] is 5 on axis x, below 'from': give 'from' the smaller number"},
      {"turns = \"any\"", "turns = \"all\"", 13,
       "'turns' in [poses.box] is not \"any\": give \"any\""},
      {"turns = \"any\"", "turns = \"any\"\nturns_within = [1, 1, 1]", 13,
       "has both 'turns' and 'turns_within': give one of them"},
      {"[poses.box]\n", "[[poses.axes]]\nmove = [0, 0, 0]\n", 9,
       "'move' in [poses.axes.1] has no length: give a direction"},
      {"answers", "spheres = \"balls\"\nanswers", 1,
       "give \"simple\", \"table\", \"tight\" or \"slab\""},
      {"ball.ist", "none.ist", 5, "there is no file " + path("none.ist") + ": check 'tree'"},
      {"[fixed]\ntree = \"ball.ist\"", "fixed = \"none.stl\"", 4,
       "there is no file " + path("none.stl") + ": check 'fixed'; a relative path starts at"},
      {"ball.ist", "job.csv", 5, "'tree' in [fixed]: " + path("job.csv") + ": "},
      {"ball.ist", "cut.ist", 5, "cut.ist: it is not a tree file: make one with ist build"},
      {"tree =", "voxel_size = 1\ntree =", 5,
       "'voxel_size' is for a mesh, and " + path("ball.ist") + " is a tree: take the key out"},
      {"tree =", "file = \"ball.ist\"\ntree =", 6, "has both 'file' and 'tree'"},
      {"[poses.box]\n", "[poses]\nfile = \"ball.stl\"\n[rest]\n", 0,
       "ball.stl: it is no .npy file: write it by numpy.save()"}};
  write("job.csv", "no mesh");
  write("cut.ist", "no tree");
  for (const Wrong& each : wrong) {
    std::string text = text_of({});
    text.replace(text.find(each.from), each.from.size(), each.to);
    const std::string job = write("wrong.toml", text);
    const CommandResult result = sweep(job, "out");
    EXPECT_EQ(result.exit_code, 3) << text;
    EXPECT_EQ(result.out, "");
    EXPECT_TRUE(says(result.err, each.text));
    if (each.line > 0) {
      EXPECT_TRUE(says(result.err, fmt::format("{}:{}: ", job, each.line)));
    }
    EXPECT_FALSE(exists("out")) << result.err;
  }
}

TEST_F(SweepCommand, ItsHashInTheFileLetsTheTreePass) {
  const std::string job = sweep_file({});
  sweep_well(job, "out");
  const std::string status = sweep_well(job, "out", {"--status"}).out, word = "fixed    ";
  const std::string hash = status.substr(status.find(word) + word.size(), 32);
  std::string text = text_of({});
  text.replace(text.find("[fixed]"), 7, "[fixed]\nhash = \"" + hash + "\"");
  write("job.toml", text);
  EXPECT_TRUE(says(sweep_well(job, "out").out, "parts   made 0, there before 3, given up 0\n"));
}

TEST_F(SweepCommand, RefusesTheFolderOfAnotherSweep) {
  const std::string job = sweep_file({});
  sweep_well(job, "out", {"--share", "0/2"});
  const Files before = files("out");
  const auto refuses = [&](const std::string& changed) {
    for (const std::vector<std::string>& mode :
         {std::vector<std::string>{}, {"--merge"}, {"--status"}}) {
      const CommandResult result = sweep(job, "out", mode);
      EXPECT_EQ(result.exit_code, 3) << changed;
      EXPECT_TRUE(says(result.err, "sweep.json: the folder is of another sweep, "));
      EXPECT_TRUE(says(result.err, "a body, a pose or a question changed; give another folder"));
      EXPECT_TRUE(same(files("out"), before)) << changed;
    }
  };
  sweep_file({.seed = 2});
  refuses("the seed");
  sweep_file({.count = 26});
  refuses("the number of poses");
  sweep_file({.answers = R"("intersects")"});
  refuses("the questions");
  sweep_file({.rows_per_part = 11});
  refuses("the parts");
  sweep_file({});
  static_cast<void>(ball_tree("ball.ist", "tight", {"--voxel-size", "0.4"}));
  refuses("a tree");
  static_cast<void>(ball_tree());
  sweep_well(job, "out");  // it is the old one again
}

TEST_F(SweepCommand, RefusesAPartOfAnotherSweep) {
  const std::string job = sweep_file({}), other = sweep_file({.seed = 2, .name = "other.toml"});
  make_whole(job, "out");
  make_whole(other, "other");
  const Files mine = files("out"), theirs = files("other");
  ASSERT_NE(mine.at("part-000001.npy"), theirs.at("part-000001.npy"));
  const auto refuses = [&](const std::vector<std::string>& mode, const std::string& text) {
    const Files before = files("out");
    const CommandResult result = sweep(job, "out", mode);
    EXPECT_EQ(result.exit_code, 3) << text;
    EXPECT_TRUE(says(result.err, text));
    EXPECT_TRUE(same(files("out"), before));
  };
  // With its record.
  write("out/part-000001.npy", theirs.at("part-000001.npy"));
  write("out/part-000001.json", theirs.at("part-000001.json"));
  for (const std::vector<std::string>& mode :
       {std::vector<std::string>{}, {"--merge"}, {"--status"}}) {
    refuses(mode, "part-000001.npy: the part is of another sweep, ");
  }
  // Beside the record of the part that it replaced.
  remove_table("out");
  write("out/part-000001.json", mine.at("part-000001.json"));
  refuses({"--merge"}, "part-000001.npy: the part is cut off or damaged: remove it");
  refuses({"--status", "--verify"}, "parts are damaged: remove their files to make them anew: 1");
  // Without a record.
  std::filesystem::remove(path("out/part-000001.json"));
  for (const std::vector<std::string>& mode :
       {std::vector<std::string>{}, {"--merge"}, {"--status"}}) {
    refuses(mode, "part-000001.npy: the part has no record beside it: remove it");
  }
  // With the record of another part of its sweep.
  write("out/part-000001.npy", mine.at("part-000000.npy"));
  write("out/part-000001.json", mine.at("part-000000.json"));
  refuses({"--merge"}, "part-000001.npy: the part is of another sweep, ");

  std::filesystem::remove(path("out/part-000001.npy"));
  make_whole(job, "out");
  EXPECT_TRUE(files("out")["rows.npy"] == mine.at("rows.npy"));
}

TEST_F(SweepCommand, NoticesAPartThatIsDamaged) {
  const std::string job = sweep_file({});
  make_whole(job, "out");
  remove_table("out");
  const std::string part = "out/part-000001.npy", bytes = file_content(path(part));
  const auto exit_codes = [&] {
    std::vector<int> codes;
    for (const std::vector<std::string>& mode :
         {std::vector<std::string>{}, {"--status"}, {"--status", "--verify"}, {"--merge"}}) {
      codes.push_back(sweep(job, "out", mode).exit_code);
    }
    return codes;
  };
  const Files before = files("out");
  for (const std::string& other :
       {bytes.substr(0, bytes.size() - 1), bytes + '\0', std::string()}) {
    write(part, other);
    EXPECT_EQ(exit_codes(), (std::vector<int>{3, 3, 3, 3})) << other.size() << " bytes";
    EXPECT_TRUE(says(sweep(job, "out", {"--status"}).out, "\ndamaged  1\n"));
    EXPECT_TRUE(
        says(sweep(job, "out").err, "part-000001.npy: the part is cut off or damaged: remove it"));
  }
  // A byte of the header, of a number, of an answer, and the last one.
  const std::size_t rows = bytes.size() - rows_in(bytes).size();
  for (const std::size_t at : {std::size_t{1}, rows - 2, rows, rows + 40, bytes.size() - 1}) {
    std::string other = bytes;
    other[at] = static_cast<char>(other[at] ^ 1);
    write(part, other);
    EXPECT_EQ(exit_codes(), (std::vector<int>{3, 0, 3, 3})) << "byte " << at;
    EXPECT_TRUE(says(sweep(job, "out", {"--status", "--verify"}).out, "\ndamaged  1\n"));
  }
  Files left = files("out");
  left["part-000001.npy"] = bytes;
  EXPECT_TRUE(same(left, before)) << "more than the part has changed";
  for (const std::string record : {"{}", "[", "", R"({"sweep": 1})"}) {
    write("out/part-000001.json", record);
    EXPECT_EQ(exit_codes(), (std::vector<int>{3, 3, 3, 3})) << record;
  }
  std::filesystem::remove(path(part));
  make_whole(job, "out");
  EXPECT_EQ(exit_codes(), (std::vector<int>{0, 0, 0, 0}));
}

TEST_F(SweepCommand, RefusesAFolderThatItCannotWriteTo) {
  const std::string job = sweep_file({});
  write("file", "older");
  const auto refuses = [&](const CommandResult& result, const std::string& folder,
                           const std::string& cause) {
    EXPECT_EQ(result.exit_code, 3) << folder;
    EXPECT_EQ(result.err, "ist: " + path(folder) + ": cannot write to the folder: " + cause +
                              ": name a folder that you may write to [input-invalid]\n");
  };
  for (const char* folder : {"file", "file/out"})
    refuses(sweep(job, folder), folder, "Not a directory");
  EXPECT_EQ(file_content(path("file")), "older");
  for (const char* mode : {"--merge", "--status"}) {
    const CommandResult result = sweep(job, "none", {mode});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_TRUE(says(result.err, "none/sweep.json: cannot read the file"));
    EXPECT_FALSE(exists("none"));
  }

  // Permissions do not bind root, unless it gives up what sets it above them.
  const std::string bound =
      ::geteuid() == 0 ? "exec setpriv --bounding-set -dac_override -- \"$@\"" : "exec \"$@\"";
  if (run_command("/bin/sh", {"-c", bound, "sh", "true"}).exit_code != 0) {
    IST_SKIP("root may not give up its right to write everywhere");
  }
  sweep_well(job, "out", {"--share", "0/2"});
  const Files before = files("out");
  ASSERT_EQ(::chmod(path("out").c_str(), 0555), 0);
  std::vector<std::string> words = arguments(job, "out");
  words.insert(words.begin(), {"-c", bound, "sh", IST_COMMAND});
  refuses(run_command("/bin/sh", words), "out", "Permission denied");
  words.push_back("--status");
  EXPECT_EQ(run_command("/bin/sh", words).exit_code, 0);  // who only looks writes nothing
  ASSERT_EQ(::chmod(path("out").c_str(), 0755), 0);
  EXPECT_TRUE(same(files("out"), before));

  sweep_well(job, "out");
  remove_table("out");
  const Files whole = files("out");
  ASSERT_EQ(::chmod(path("out").c_str(), 0555), 0);
  words.back() = "--merge";
  refuses(run_command("/bin/sh", words), "out", "Permission denied");
  ASSERT_EQ(::chmod(path("out").c_str(), 0755), 0);
  EXPECT_TRUE(same(files("out"), whole));
}

}  // namespace
}  // namespace ist::test
