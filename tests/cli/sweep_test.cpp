// The parts that `ist sweep` makes, and the table of all rows.

#include <xxhash.h>

#include <array>

#include "cli/sweep_case.h"

namespace ist::test {
namespace {

using nlohmann::json;

std::string hash_of(const std::string& bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

TEST_F(SweepCommand, MakesPartsAndMergesThem) {
  const std::string job = sweep_file({});
  const CommandResult made = sweep_well(job, "out");
  EXPECT_EQ(made.out, fmt::format("parts   made 3, there before 0, given up 0\n"
                                  "rows    25 in {}/rows.npy\n",
                                  path("out")));
  for (const char* line : {"part 0: 10 rows in ", "part 1: 10 rows in ", "part 2: 5 rows in "}) {
    EXPECT_TRUE(says(made.err, line));
  }
  EXPECT_TRUE(says(made.err, "; 1 of 3 done, about "));
  EXPECT_EQ(names("out"),
            (std::vector<std::string>{"manifest.json", "part-000000.json", "part-000000.npy",
                                      "part-000001.json", "part-000001.npy", "part-000002.json",
                                      "part-000002.npy", "rows.npy", "sweep.json"}));
  const Files all = files("out");

  const json sweep = json::parse(all.at("sweep.json")),
             manifest = json::parse(all.at("manifest.json"));
  std::string rows;
  for (std::size_t part = 0; part < 3; ++part) {
    const std::string name = fmt::format("part-{:06}", part), &bytes = all.at(name + ".npy");
    json record = json::parse(all.at(name + ".json"));
    EXPECT_GT(record["seconds"], 0);
    record.erase("seconds");
    EXPECT_EQ(record, (json{{"sweep", sweep["sweep"]},
                            {"part", part},
                            {"rows", part == 2 ? 5 : 10},
                            {"xxh3_128", hash_of(bytes)}}));
    EXPECT_EQ(manifest["xxh3_128"]["parts"][part], hash_of(bytes));
    rows += rows_in(bytes);
  }
  EXPECT_EQ(rows_in(all.at("rows.npy")), rows);
  EXPECT_EQ(manifest["xxh3_128"]["rows.npy"], hash_of(all.at("rows.npy")));
  EXPECT_EQ(sweep["rows"], 25);
  EXPECT_EQ(sweep["parts"], 3);
  EXPECT_EQ(manifest["columns"], sweep["columns"]);
}

TEST_F(SweepCommand, ItsRowsAreTheAnswersOfCollide) {
  std::vector<double> moves;
  for (int i = 0; i < 9; ++i) moves.push_back(3 + 0.25 * i);
  const std::string job =
      write("job.toml",
            "answers = [\"intersects\", \"leaf_pairs\", \"distance\"]\ntolerance = 0.01\n"
            "rows_per_part = 4\n[fixed]\ntree = \"ball.ist\"\n[moving]\ntree = \"ball.ist\"\n"
            "[[poses.axes]]\nmove = [2, 0, 0]\nfrom = 3\nto = 5\ncount = 9\n");
  make_whole(job, "out");
  const std::string tree = path("ball.ist");
  const std::vector<json> lines = json_lines(
      ist_well({"collide", tree, tree, "--poses", poses(moves), "--distance", "0.01", "--json"})
          .out);
  ASSERT_EQ(lines.size(), moves.size());
  const std::vector<double> touch = column("out", "intersects"),
                            pairs = column("out", "leaf_pairs"),
                            lower = column("out", "distance_lower"),
                            upper = column("out", "distance_upper"), index = column("out", "index"),
                            status = column("out", "status"), complete = column("out", "complete");
  ASSERT_EQ(touch.size(), moves.size());
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const json& line = lines[i];
    EXPECT_EQ(touch[i], line["touch"] == "yes" ? 3 : 1) << i;
    EXPECT_EQ(pairs[i], line["leaf_pairs"].get<double>()) << i;
    EXPECT_LE(lower[i], line["distance_upper"].get<double>()) << i;
    EXPECT_GE(upper[i], line["distance_lower"].get<double>()) << i;
    EXPECT_LE(upper[i] - lower[i], 0.02) << i;
    EXPECT_EQ(index[i], static_cast<double>(i));
    EXPECT_EQ(status[i], 0);
    EXPECT_EQ(complete[i], 1);
  }
  EXPECT_EQ(touch.front(), 3);
  EXPECT_EQ(touch.back(), 1);
}

TEST_F(SweepCommand, PartsThatAreThereStay) {
  const std::string job = sweep_file({});
  sweep_well(job, "out");
  const auto times = [&] {
    std::map<std::string, std::filesystem::file_time_type> found;
    for (const auto& entry : std::filesystem::directory_iterator(path("out"))) {
      found[entry.path().filename()] = entry.last_write_time();
    }
    return found;
  };
  const auto before = times();
  const Files made = results("out");
  const CommandResult again = sweep_well(job, "out");
  EXPECT_TRUE(says(again.out, "parts   made 0, there before 3, given up 0\nrows    25 in "));
  EXPECT_EQ(again.err, "");
  EXPECT_EQ(times(), before);

  std::filesystem::remove(path("out/part-000001.npy"));
  EXPECT_TRUE(
      says(sweep_well(job, "out").out, "parts   made 1, there before 2, given up 0\nrows    25"));
  EXPECT_TRUE(same(results("out"), made));
  const json told = object_of(sweep_well(job, "out", {"--json"}));
  EXPECT_EQ(told, (json{{"made", json::array()},
                        {"there", {0, 1, 2}},
                        {"given_up", json::array()},
                        {"rows", 25}}));
}

TEST_F(SweepCommand, SharesAndThreadsChangeNoByte) {
  const std::string job = sweep_file(
      {.count = 64, .answers = R"("intersects", "distance", "contacts", "penetration")"});
  make_whole(job, "whole");
  const Files whole = results("whole");
  ASSERT_EQ(whole.size(), 7u + 3);
  for (const std::uint64_t shares : {1u, 2u, 3u, 20u}) {
    const std::string folder = fmt::format("shares-{}", shares);
    std::uint64_t parts = 0;
    for (std::uint64_t share = 0; share < shares; ++share) {
      const std::string words = fmt::format("{}/{}", share, shares);
      const json told = object_of(sweep_well(job, folder, {"--share", words, "--json"}));
      json expected = json::array();
      for (std::uint64_t part = share; part < 7; part += shares) expected.push_back(part);
      EXPECT_EQ(told["made"], expected) << words;
      EXPECT_EQ(told["there"], json::array()) << words;
      parts += told["made"].size();
      EXPECT_EQ(told["rows"], parts == 7 ? 64 : 0) << words;
    }
    EXPECT_TRUE(same(results(folder), whole)) << shares;
  }
  for (const char* threads : {"1", "2", "5"}) {
    const std::string folder = std::string("threads-") + threads;
    sweep_well(job, folder, {"--threads", threads});
    EXPECT_TRUE(same(results(folder), whole)) << threads;
  }
}

TEST_F(SweepCommand, AnyNumberOfPosesMakesATable) {
  for (const std::uint64_t count : {0u, 1u, 9u, 10u, 11u}) {
    const std::string folder = fmt::format("out-{}", count);
    const std::string job = sweep_file({.count = count});
    const std::uint64_t parts = (count + 9) / 10;
    EXPECT_EQ(
        sweep_well(job, folder).out,
        fmt::format("parts   made {}, there before 0, given up 0\nrows    {} in {}/rows.npy\n",
                    parts, count, path(folder)));
    EXPECT_EQ(object_of(sweep_well(job, folder, {"--merge", "--json"}))["rows"], count);
    EXPECT_EQ(parts_in(folder), static_cast<std::ptrdiff_t>(parts));
    std::vector<double> numbers(count);
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<double>(i);
    EXPECT_EQ(column(folder, "index"), numbers);
    const std::string npy = files(folder)["rows.npy"];
    EXPECT_TRUE(says(npy.substr(0, npy.size() - rows_in(npy).size()),
                     fmt::format("'shape': ({},)", count)));
    const json status = object_of(sweep_well(job, folder, {"--status", "--verify", "--json"}));
    EXPECT_EQ(status["parts"], parts);
    EXPECT_EQ(status["done"], parts);
    EXPECT_EQ(status["rows"], count);
  }
}

// The rows of fewer poses are the first ones of more: pose i depends on i alone.
TEST_F(SweepCommand, APoseDependsOnItsNumberAndTheSeedAlone) {
  make_whole(sweep_file({.count = 12}), "few");
  make_whole(sweep_file({.count = 25, .rows_per_part = 7}), "many");
  make_whole(sweep_file({.count = 12, .seed = 2}), "other");
  const std::string few = rows_in(files("few")["rows.npy"]);
  EXPECT_TRUE(rows_in(files("many")["rows.npy"]).starts_with(few));
  EXPECT_NE(rows_in(files("other")["rows.npy"]), few);
}

TEST_F(SweepCommand, AMergeNamesTheMissingPartsAndWritesNothing) {
  const std::string job = sweep_file({.count = 70});
  EXPECT_EQ(sweep_well(job, "out", {"--share", "0/3"}).out,
            "parts   made 3, there before 0, given up 0\n"
            "rows    not merged yet: parts are missing\n");
  const Files before = files("out");
  const CommandResult merged = sweep(job, "out", {"--merge"});
  EXPECT_EQ(merged.exit_code, 1);
  EXPECT_EQ(merged.out, "");
  EXPECT_EQ(merged.err, "ist: parts are missing, and nothing was merged: 1-2, 4-5\n");
  EXPECT_TRUE(same(files("out"), before));
  const CommandResult told = sweep(job, "out", {"--merge", "--json"});
  EXPECT_EQ(told.exit_code, 1);
  EXPECT_EQ(object_of(told),
            (json{{"rows", 0}, {"missing", {1, 2, 4, 5}}, {"given_up", json::array()}}));
  EXPECT_TRUE(says(sweep_well(job, "out", {"--status"}).out, "\nmissing  1-2, 4-5\n"));

  sweep_well(job, "out");
  const Files whole = files("out");
  std::filesystem::remove(path("out/part-000006.npy"));
  EXPECT_EQ(sweep(job, "out", {"--merge"}).exit_code, 1);
  Files left = whole;
  left.erase("part-000006.npy");
  EXPECT_TRUE(same(files("out"), left)) << "the older table changed";
}

TEST_F(SweepCommand, NoFileHoldsAPath) {
  const std::string job = sweep_file({});
  make_whole(job, "out");
  const Files all = files("out");
  ASSERT_EQ(all.size(), 9u);
  for (const auto& [name, bytes] : all) {
    for (const std::string& part :
         {dir_.path().string(), std::string("ball.ist"), std::string("job.toml")}) {
      EXPECT_EQ(bytes.find(part), std::string::npos) << name << " holds " << part;
    }
  }
  // So a folder, and the files that it is made of, may be moved.
  std::filesystem::create_directory(path("elsewhere"));
  for (const char* name : {"ball.ist", "job.toml", "out"}) {
    std::filesystem::rename(path(name), path(std::string("elsewhere/") + name));
  }
  EXPECT_TRUE(says(sweep_well(path("elsewhere/job.toml"), "elsewhere/out").out,
                   "parts   made 0, there before 3, given up 0\n"));
}

TEST_F(SweepCommand, JsonBeginsWithTheFilesAndTheirHashes) {
  const std::string job = sweep_file({});
  sweep_well(job, "out");
  const std::string hash = hash_of(file_content(path("ball.ist"))), text = file_content(job);
  for (const char* mode : {"--status", "--merge", "--threads=1"}) {
    const std::string out = sweep_well(job, "out", {mode, "--json"}).out;
    json header = json::parse(out.substr(0, out.find('\n')));
    EXPECT_EQ(header["subcommand"], "sweep");
    EXPECT_EQ(header["fixed"], (json{{"file", "ball.ist"}, {"hash", hash}}));
    EXPECT_EQ(header["moving"], header["fixed"]);
    EXPECT_EQ(header["sweep"],
              (json{{"file", "job.toml"},
                    {"hash", fmt::format("{:016x}", XXH3_64bits(text.data(), text.size()))}}));
  }
  EXPECT_TRUE(says(sweep_well(job, "out", {"--status"}).out, "fixed    " + hash + " "));
}

}  // namespace
}  // namespace ist::test
