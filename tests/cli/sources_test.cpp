// The unit of a tree's lengths, the file that it was built of, and the sizes that info tells.

#include <fmt/format.h>
#include <xxhash.h>

#include <utility>

#include "cli/cli_case.h"
#include "ist/tree/sphere_tree.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using nlohmann::json;

class Sources : public CliTest {};

TEST_F(Sources, BuildRemembersUnitAndFile) {
  for (const auto& [word, unit] : {std::pair("mm", LengthUnit::kMillimetre),
                                   {"m", LengthUnit::kMetre},
                                   {"inch", LengthUnit::kInch},
                                   {"um", LengthUnit::kMicrometre},
                                   {"µm", LengthUnit::kMicrometre},
                                   {"", LengthUnit::kUnknown}}) {
    std::vector<std::string> arguments{"build", needle("needle.stl", 4), "-o", path("unit.ist")};
    if (*word != '\0') arguments.insert(arguments.end(), {"--unit", word});
    ist_well(arguments);
    const MeshSource source = read_tree(path("unit.ist")).source();
    EXPECT_EQ(source.unit, unit) << word;
    EXPECT_EQ(source.name, "needle.stl");
    const std::string bytes = file_content(path("needle.stl"));
    EXPECT_EQ(source.hash, XXH3_64bits(bytes.data(), bytes.size()));
  }
}

TEST_F(Sources, BuildTellsThemInJson) {
  const std::string of = needle("needle.stl", 4);
  const std::vector<std::string> arguments{"build", of, "-o", path("t.ist"), "--json"};
  std::vector<std::string> told = arguments;
  told.insert(told.end(), {"--unit", "um"});
  const json line = json_lines(ist_well(told).out).at(0),
             plain = json_lines(ist_well(arguments).out).at(0);
  const std::string bytes = file_content(of);
  const json source{{"name", "needle.stl"},
                    {"hash", fmt::format("{:016x}", XXH3_64bits(bytes.data(), bytes.size()))}};
  EXPECT_EQ(line["unit"], "µm");
  EXPECT_EQ(line["source"], source);
  EXPECT_EQ(plain["unit"], nullptr);
  EXPECT_EQ(plain["source"], source);
}

TEST_F(Sources, AStrangeFileNameIsMarkedWhereItIsStrange) {
  const std::string file = needle("a\nb\\c\xFF.stl", 4);
  ist_well({"build", file, "-o", path("t.ist"), "--voxel-size", "0.1"});
  EXPECT_EQ(read_tree(path("t.ist")).source().name, "a?b?c?.stl");
}

TEST_F(Sources, TrianglesAreKeptUnlessTheyAreDeclined) {
  EXPECT_NE(read_tree(ball_tree()).triangles(), nullptr);
  EXPECT_EQ(read_tree(ball_tree("b.ist", "slab", {"--no-triangles"})).triangles(), nullptr);
}

TEST_F(Sources, BuildMakesNoVoxelsUnlessItIsAskedTo) {
  const std::string of = needle("n.stl", 1.1641), to = path("t.ist");
  const CommandResult result = ist_well({"build", of, "-o", to, "--json"});
  EXPECT_EQ(result.err, "");
  const json line = json_lines(result.out).at(0);
  EXPECT_EQ(line["triangles"], 12);
  EXPECT_GT(line["bytes"], 0);
  for (const char* key : {"voxel_size", "spheres", "voxels", "nodes", "depth"}) {
    ASSERT_TRUE(line.contains(key)) << key;
    EXPECT_TRUE(line[key].is_null()) << key;
  }
  EXPECT_FALSE(read_tree(to).has_voxels());
  EXPECT_TRUE(says(ist_well({"build", of, "-o", to}).out, "12 triangles, no voxels"));
  const std::string before = file_content(to);
  for (const std::vector<std::string>& more : {std::vector<std::string>{"--spheres", "tight"},
                                               {"--no-triangles"},
                                               {"--classes", "surface,proximity"}}) {
    std::vector<std::string> arguments{"build", of, "-o", to};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult refused = ist(arguments);
    EXPECT_EQ(refused.exit_code, 2) << more[0];
    EXPECT_TRUE(says(refused.err, more[0] + ": goes with --voxel-size"));
  }
  const CommandResult zero = ist({"build", of, "-o", to, "--voxel-size", "0"});
  EXPECT_EQ(zero.exit_code, 2);
  EXPECT_TRUE(says(zero.err, "leave the option out for no voxels"));
  EXPECT_EQ(file_content(to), before);
}

TEST_F(Sources, InfoTellsTheSizeByUnit) {
  const std::string jaw = mesh("jaw.stl", box({-34.1, 0, 7}, {34.1, 116.4, 62}));
  const CommandResult words = ist_well({"info", jaw});
  EXPECT_TRUE(says(words.out,
                   "\nextent 68.2 x 116.4 x 55.0 (as mm: 6.8 x 11.6 x 5.5 cm; as inches: 1.73 x "
                   "2.96 x 1.40 m)\nbox [-34.1, 34.1] [0.0, 116.4] [7.0, 62.0]\nclosed, wound "
                   "consistently, volume 436616\n"));
  for (const auto& [unit, told] : {std::pair("mm", "68.2 x 116.4 x 55.0 mm (6.8 x 11.6 x 5.5 cm)"),
                                   {"m", "68.2 x 116.4 x 55.0 m (68 x 116 x 55 m)"},
                                   {"inch", "68.2 x 116.4 x 55.0 inch (1.73 x 2.96 x 1.40 m)"},
                                   {"um", "68.2 x 116.4 x 55.0 µm (68 x 116 x 55 µm)"}}) {
    ist_well({"build", jaw, "-o", path("jaw.ist"), "--voxel-size", "5", "--unit", unit});
    const CommandResult tree = ist_well({"info", path("jaw.ist")});
    EXPECT_TRUE(says(tree.out, std::string("\nextent ") + told + "\n"));
    EXPECT_TRUE(says(tree.out, "\nbuilt of jaw.stl, XXH3 "));
    EXPECT_FALSE(says(tree.out, "as mm"));
  }
}

TEST_F(Sources, InfoWritesFarAndTinyBodiesShortly) {
  const auto extent = [&](double scale) {
    const std::string file = mesh("b.stl", box({0, 0, 0}, {scale, scale / 2, scale / 8}));
    const std::string out = ist_well({"info", file}).out;
    const std::size_t at = out.find("extent");
    return out.substr(at, out.find('\n', at) - at);
  };
  EXPECT_EQ(extent(0.5),
            "extent 0.5000 x 0.2500 x 0.0625 (as mm: 500 x 250 x 63 µm; as inches: 1.27 x 0.64 x "
            "0.16 cm)");
  EXPECT_TRUE(
      says(extent(1e-6), "extent 1.000e-06 x 5.000e-07 x 1.250e-07 (as mm: 0.00100 x 0.00050 x"));
  EXPECT_TRUE(says(extent(1e12), "extent 1.000e+12 x 5.000e+11 x 1.250e+11 (as mm: 999999996 x"));
}

TEST_F(Sources, InfoTellsThemInJson) {
  const auto info = [&](const std::string& file) {
    return json_lines(ist_well({"info", file, "--json"}).out).at(0);
  };
  const std::string closed = mesh("closed.stl", box({0, 0, 0}, {4, 2, 1}));
  const json mesh_line = info(closed);
  EXPECT_EQ(mesh_line["extent"], (json{4, 2, 1}));
  EXPECT_EQ(mesh_line["closed"], true);
  EXPECT_EQ(mesh_line["consistent"], true);
  EXPECT_EQ(mesh_line["volume"], 8);
  EXPECT_EQ(mesh_line["unit"], nullptr);
  EXPECT_EQ(mesh_line["source"]["name"], "closed.stl");
  EXPECT_EQ(mesh_line["source"]["hash"].get<std::string>().size(), 16u);

  ist_well({"build", closed, "-o", path("t.ist"), "--voxel-size", "0.5", "--unit", "inch"});
  const json tree_line = info(path("t.ist"));
  for (const char* key : {"extent", "closed", "consistent", "volume", "source"}) {
    EXPECT_EQ(tree_line[key], mesh_line[key]) << key;
  }
  EXPECT_EQ(tree_line["unit"], "inch");

  ist_well({"build", closed, "-o", path("t.ist"), "--voxel-size", "0.5", "--no-triangles"});
  const json bare = info(path("t.ist"));
  EXPECT_EQ(bare["extent"], (json{4, 2.5, 1.5}));  // of its voxels, which meet the sides
  for (const char* key : {"closed", "consistent", "volume"}) EXPECT_EQ(bare[key], nullptr) << key;

  const json open = info(mesh("open.stl", open_strip(2)));
  EXPECT_EQ(open["closed"], false);
  EXPECT_EQ(open["consistent"], true);
  EXPECT_EQ(open["volume"], nullptr);
}

TEST_F(Sources, InfoSaysWhereAMeshIsOpen) {
  EXPECT_TRUE(says(ist_well({"info", mesh("open.stl", open_strip(2))}).out,
                   "\nopen, wound consistently\n"));
}

// Old archives name files in Latin-1.
TEST_F(Sources, JsonStaysUtf8WhateverFilesAreCalled) {
  const std::string mesh = needle("Z\xE4hne.stl", 4), tree = path("Z\xE4hne.ist");
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"info", mesh, "--json"},
        {"build", mesh, "-o", tree, "--voxel-size", "0.02", "--json"},
        {"info", tree, "--json"},
        {"export", tree, "--what", "voxels", "--level", "0", "-o", path("Z\xE4hne.vtp"), "--json"},
        {"collide", mesh, tree, "--json"},
        {"table", "--format", "mem", "-o", path("t\xE4.mem"), "--json"}}) {
    const CommandResult result = ist_well(arguments);
    EXPECT_TRUE(result.out.starts_with("{")) << arguments[0] << result.out;
    EXPECT_EQ(result.out.find('\xE4'), std::string::npos) << arguments[0];
  }
  // And without the folder.
  for (const std::string& file : {mesh, tree}) {
    const CommandResult result = ist_well({"info", file, "--json"});
    EXPECT_EQ(result.out.find(path("")), std::string::npos) << result.out;
    EXPECT_TRUE(says(result.out, "Z?hne."));
  }
}

}  // namespace
}  // namespace ist::test
