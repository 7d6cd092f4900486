#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "cli/cli_case.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"
#include "support/effort.h"
#include "support/mesh_files.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using nlohmann::json;

class Files : public CliTest {};

TEST_F(Files, BuildSaysWhatItMade) {
  const CommandResult result = ist_well({"build", ball(), "-o", path("out.ist"), "--voxel-size",
                                         "0.08", "--json", "--classes", "surface,proximity"});
  const auto lines = json_lines(result.out);
  ASSERT_EQ(lines.size(), 1u);
  const json& line = lines[0];
  const SphereTree tree = read_tree(path("out.ist"));
  EXPECT_EQ(line["file"], "out.ist");
  EXPECT_EQ(line["triangles"], 320);
  EXPECT_EQ(line["voxel_size"], 0.08);
  EXPECT_EQ(line["spheres"], "slab");
  EXPECT_EQ(line["voxels"], tree.leaf_count());
  EXPECT_EQ(line["nodes"], voxels_of(tree).octree.node_count());
  EXPECT_EQ(line["depth"], 6);
  EXPECT_EQ(line["bytes"], std::filesystem::file_size(path("out.ist")));
  EXPECT_TRUE(line["memory"].is_number_unsigned());
  EXPECT_EQ(line["proximity_voxels"], voxels_of(tree).proximity->octree.leaf_count());
  EXPECT_EQ(line["warnings"], json::array());
  EXPECT_GT(line["milliseconds"].size(), 2u);
  for (const json& stage : line["milliseconds"]) EXPECT_TRUE(stage.is_number());
  EXPECT_TRUE(tree.triangles());
  EXPECT_EQ(line["unit"], nullptr);
  EXPECT_EQ(line["source"]["name"], "ball.stl");

  const CommandResult plain =
      ist_well({"build", ball(), "-o", path("out.ist"), "--voxel-size", "0.08"});
  EXPECT_TRUE(says(plain.out, std::to_string(tree.leaf_count()) + " voxels"));
  EXPECT_TRUE(says(plain.out, "depth 6"));
  EXPECT_TRUE(says(plain.out, "ms"));
}

TEST_F(Files, ATreeWithoutVoxelsIsShownAndNotExported) {
  const std::string tree = path("alone.ist");
  ist_well({"build", ball(), "-o", tree, "--unit", "mm"});
  const json line = json_lines(ist_well({"info", tree, "--json"}).out).at(0);
  for (const char* key : {"voxel_size", "cells", "depth", "voxels", "nodes"}) {
    ASSERT_TRUE(line.contains(key)) << key;
    EXPECT_TRUE(line[key].is_null()) << key;
  }
  EXPECT_EQ(line["levels"], json::array());
  EXPECT_EQ(line["triangles"], true);
  EXPECT_EQ(line["closed"], true);
  EXPECT_EQ(line["self_intersections"], 0);
  const CommandResult words = ist_well({"info", tree});
  EXPECT_TRUE(says(words.out, "a tree of triangles without voxels"));
  EXPECT_TRUE(says(words.out, "orientation outward, 320 triangles kept\n"));
  for (const char* what : {"voxels", "spheres"}) {
    const CommandResult refused =
        ist({"export", tree, "--what", what, "--level", "0", "-o", path("out.vtp")});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_TRUE(says(refused.err, "no voxels: build it with a voxel size"));
    EXPECT_FALSE(exists("out.vtp"));
  }
}

TEST_F(Files, BuildSavesTheSpheresThatItIsAskedFor) {
  std::uintmax_t bytes = 0;
  for (const char* spheres : {"table", "tight", "slab"}) {
    const auto lines = json_lines(ist_well({"build", ball(), "-o", path("out.ist"), "--voxel-size",
                                            "0.5", "--spheres", spheres, "--json"})
                                      .out);
    EXPECT_EQ(lines.at(0)["spheres"], spheres);
    const SphereTree tree = read_tree(path("out.ist"));
    EXPECT_EQ(to_string(tree.tightest()), spheres);
    // 8 bytes a ball, and 5 a slab.
    const std::uintmax_t more = std::filesystem::file_size(path("out.ist")) - bytes;
    if (bytes > 0) {
      EXPECT_EQ(more,
                voxels_of(tree).octree.node_count() * (tree.has(SpherePolicy::kSlab) ? 5 : 8));
    }
    bytes += more;
  }
}

TEST_F(Files, BuildReplacesAFileOnlyWhenItSucceeds) {
  const std::string tree = ball_tree(), before = file_content(tree);
  const std::size_t entries = dir_.entries();
  EXPECT_EQ(ist({"build", write("bad.stl", "solid"), "-o", tree, "--voxel-size", "1"}).exit_code,
            3);
  EXPECT_EQ(ist({"build", ball(), "-o", tree, "--voxel-size", "0"}).exit_code, 2);
  EXPECT_EQ(file_content(tree), before);
  ist_well({"build", ball(), "-o", tree, "--voxel-size", "1"});
  EXPECT_NE(file_content(tree), before);
  EXPECT_EQ(read_tree(tree).voxel_size(), 1);
  EXPECT_EQ(dir_.entries(), entries + 1);
}

TEST_F(Files, WhatCannotBeWrittenIsAFailure) {
  for (const std::string& target : {path("none/out.ist"), dir_.path().string()}) {
    const CommandResult result = ist({"build", ball(), "-o", target, "--voxel-size", "1"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.out, "");
    EXPECT_TRUE(says(result.err, target + ": "));
  }
  EXPECT_FALSE(exists("none"));
  const CommandResult result =
      ist({"export", ball_tree(), "--what", "voxels", "--level", "0", "-o", path("none/out.ply")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(says(result.err, "none/out.ply: "));
}

// A mesh that cannot be read shows that the output is checked first.
TEST_F(Files, WhatCannotBeWrittenIsFoundBeforeTheWork) {
  const std::string bad = write("bad.stl", "solid");
  for (const std::string& folder : {path("none/"), path("bad.stl/")}) {
    const std::vector<std::pair<std::vector<std::string>, std::string>> commands = {
        {{"build", bad, "-o"}, "out.ist"},
        {{"export", bad, "--what", "voxels", "--level", "0", "-o"}, "out.ply"},
        {{"occlusion", bad, bad, "-o"}, "out.vtp"},
        {{"collide", bad, bad, "--contacts"}, "out.csv"},
        {{"approach", bad, bad, "--axis", "z", "--from", "0", "--to", "1", "--contacts"},
         "out.csv"},
        {{"run", bad, "--record"}, "out.csv"}};
    for (auto [words, name] : commands) {
      words.push_back(folder + name);
      const CommandResult result = ist(words);
      EXPECT_EQ(result.exit_code, 1) << words[0];
      EXPECT_TRUE(result.err.starts_with("ist: " + folder + name + ": cannot create the file: "))
          << result.err;
    }
  }
}

TEST_F(Files, InfoOfAMesh) {
  const auto lines = json_lines(ist_well({"info", ball(), "--json"}).out);
  ASSERT_EQ(lines.size(), 1u);
  const json& line = lines[0];
  EXPECT_EQ(line["kind"], "mesh");
  EXPECT_EQ(line["vertices"], 162);
  EXPECT_EQ(line["triangles"], 320);
  EXPECT_EQ(line["components"], 1);
  for (const char* key : {"boundary_edges", "non_manifold_edges", "duplicate_triangles",
                          "degenerate_triangles", "inconsistent_edges"}) {
    EXPECT_EQ(line[key], 0) << key;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(line["box_min"][i].get<double>(), -2, 0.1);
    EXPECT_NEAR(line["box_max"][i].get<double>(), 2, 0.1);
  }
  EXPECT_EQ(line["warnings"], json::array());
  EXPECT_TRUE(says(ist_well({"info", ball()}).out, "320 triangles and 162 vertices"));
  EXPECT_TRUE(says(ist_well({"info", mesh("one.stl", open_strip(1))}).out, ", 1 component\n"));
  const auto open = json_lines(ist_well({"info", mesh("open.stl", open_strip(2)), "--json"}).out);
  EXPECT_EQ(open.at(0)["boundary_edges"], 6);
  EXPECT_GT(open.at(0)["warnings"].size(), 0u);
}

TEST_F(Files, InfoOfATree) {
  const std::string file = ball_tree("ball.ist", "tight", {"--no-triangles"});
  const SphereTree tree = read_tree(file);
  const auto lines = json_lines(ist_well({"info", file, "--json"}).out);
  ASSERT_EQ(lines.size(), 1u);
  const json& line = lines[0];
  EXPECT_EQ(line["kind"], "tree");
  EXPECT_EQ(line["voxel_size"], 0.5);
  EXPECT_EQ(line["cells"], 8);
  EXPECT_EQ(line["depth"], 3);
  EXPECT_EQ(line["voxels"], tree.leaf_count());
  EXPECT_EQ(line["orientation"], "outward");
  EXPECT_EQ(line["triangles"], false);
  EXPECT_EQ(line["proximity"], false);
  ASSERT_EQ(line["levels"].size(), 4u);
  for (std::size_t level = 0; level < 4; ++level) {
    const json& row = line["levels"][level];
    EXPECT_EQ(row["level"], level);
    EXPECT_EQ(row["edge"], std::ldexp(0.5, static_cast<int>(level)));
    EXPECT_EQ(row["nodes"], voxels_of(tree).octree.node_count(static_cast<int>(level)));
    EXPECT_LE(row["volume"]["table"], row["volume"]["simple"]);
    EXPECT_GT(row["volume"]["tight"], 0);
    EXPECT_FALSE(row["volume"].contains("slab"));
  }
  EXPECT_TRUE(says(ist_well({"info", file}).out, "orientation outward"));
}

TEST_F(Files, ExportedSpheresAreThoseOfTheTree) {
  const std::string file = ball_tree("ball.ist", "slab");
  const SphereTree tree = read_tree(file);
  for (const char* spheres : {"simple", "table", "tight", "slab", ""}) {
    for (int level = 0; level <= 3; ++level) {
      std::vector<std::string> arguments{"export",  file,          "--what",
                                         "spheres", "--level",     std::to_string(level),
                                         "-o",      path("s.ply"), "--json"};
      if (*spheres != '\0') arguments.insert(arguments.end(), {"--spheres", spheres});
      const auto lines = json_lines(ist_well(arguments).out);
      const PlyFile ply = parse_ply(file_content(path("s.ply")));
      EXPECT_EQ(ply.vertices.size(), voxels_of(tree).octree.node_count(level));
      ASSERT_EQ(lines.size(), 1u);
      EXPECT_EQ(lines[0]["count"], ply.vertices.size());
      EXPECT_EQ(lines[0]["what"], "spheres");
      EXPECT_EQ(lines[0]["level"], level);
      EXPECT_TRUE(ply.faces.empty());
      const double circumradius = std::ldexp(0.8660254037844386, level - 1);
      for (const auto& sphere : ply.vertices) {
        ASSERT_EQ(sphere.size(), 4u);
        // Each reaches the surface of the ball, and none is larger than its cube asks for.
        const double distance = std::hypot(sphere.at("x"), sphere.at("y"), sphere.at("z"));
        EXPECT_LE(std::abs(distance - 2), sphere.at("radius") + 0.1);
        EXPECT_LE(sphere.at("radius"), circumradius * 1.01);
        if (std::string(spheres) == "simple") {
          EXPECT_EQ(sphere.at("radius"), static_cast<float>(circumradius));
        }
      }
    }
  }
}

TEST_F(Files, ExportedVoxelsAreClosed) {
  const std::string file = ball_tree();
  const SphereTree tree = read_tree(file);
  for (int level = 0; level <= 3; ++level) {
    const auto lines = json_lines(ist_well({"export", file, "--what", "voxels", "--level",
                                            std::to_string(level), "-o", path("v.ply"), "--json"})
                                      .out);
    EXPECT_EQ(lines.at(0)["count"], voxels_of(tree).octree.node_count(level));
    const PlyFile ply = parse_ply(file_content(path("v.ply")));
    const auto place = [&](std::uint32_t vertex) {
      const auto& v = ply.vertices.at(vertex);
      return std::array<double, 3>{v.at("x"), v.at("y"), v.at("z")};
    };
    // Each corner of the lattice is there once, and used.
    std::set<std::array<double, 3>> corners;
    std::set<std::uint32_t> used;
    for (std::uint32_t i = 0; i < ply.vertices.size(); ++i) corners.insert(place(i));
    for (const auto& face : ply.faces) used.insert(face.begin(), face.end());
    EXPECT_EQ(corners.size(), ply.vertices.size());
    EXPECT_EQ(used.size(), ply.vertices.size());
    for (const auto& corner : corners) {
      for (std::size_t i = 0; i < 3; ++i) {
        const double edges =
            (corner[i] - voxels_of(tree).lattice.corner[i]) / std::ldexp(0.5, level);
        EXPECT_NEAR(edges, std::round(edges), 1e-6);
      }
    }
    // How often each edge runs forward, less how often back; and the volume under the faces.
    std::map<std::pair<std::array<double, 3>, std::array<double, 3>>, std::pair<int, int>> edges;
    std::set<std::set<std::array<double, 3>>> places;
    double volume = 0;
    for (const auto& face : ply.faces) {
      ASSERT_EQ(face.size(), 4u);
      for (std::size_t i = 0; i < 4; ++i) {
        const auto a = place(face[i]), b = place(face[(i + 1) % 4]);
        ASSERT_NE(a, b);
        auto& [uses, turn] = edges[std::minmax(a, b)];
        ++uses;
        turn += a < b ? 1 : -1;
      }
      EXPECT_TRUE(
          places.insert({place(face[0]), place(face[1]), place(face[2]), place(face[3])}).second)
          << "a face between two voxels";
      const auto p = place(face[0]), q = place(face[1]), r = place(face[2]);
      const Eigen::Vector3d a(p[0], p[1], p[2]), b(q[0], q[1], q[2]), c(r[0], r[1], r[2]);
      volume += a.dot((b - a).cross(c - a)) / 3;
    }
    for (const auto& [edge, count] : edges) {
      EXPECT_EQ(count.first % 2, 0);
      EXPECT_EQ(count.second, 0);
    }
    const double cube = std::pow(std::ldexp(0.5, level), 3);
    EXPECT_NEAR(volume, cube * voxels_of(tree).octree.node_count(level), 1e-4)
        << "faces turn outward";
  }
}

// A tree that knows its unit needs none, and no other is believed.
TEST_F(Files, AGlbIsInMetresByTheTreesUnit) {
  const std::string tree = path("metres.ist"), glb = path("v.glb");
  ist_well({"build", ball(), "-o", tree, "--voxel-size", "0.5", "--unit", "m"});
  const std::vector<std::string> asked{"export",  tree, "--what", "voxels",
                                       "--level", "0",  "-o",     glb};
  EXPECT_EQ(ist_well(asked).err, "");
  EXPECT_TRUE(says(file_content(glb), "\"matrix\":[1.0,"));
  std::vector<std::string> otherwise = asked;
  otherwise.insert(otherwise.end(), {"--unit", "inch"});
  const CommandResult refused = ist(otherwise);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(says(refused.err, "--unit: the tree holds m"));
  std::vector<std::string> unknown = asked;
  unknown[1] = ball_tree();
  EXPECT_TRUE(says(ist_well(unknown).err, "unit: mm (assumed)"));
}

TEST_F(Files, AnInputIsNeverOverwritten) {
  const std::string mesh = ball(), tree = path("kept.ply");
  ASSERT_EQ(ist({"build", mesh, "-o", tree, "--voxel-size", "0.5"}).exit_code, 0);
  const std::string mesh_before = file_content(mesh), tree_before = file_content(tree);
  EXPECT_EQ(ist({"build", mesh, "-o", mesh, "--voxel-size", "0.5"}).exit_code, 2);
  EXPECT_TRUE(says(ist({"export", tree, "--what", "voxels", "--level", "0", "-o", tree}).err,
                   "writing it would destroy an input"));
  EXPECT_EQ(ist({"approach", tree, tree, "--axis", "z", "--from", "0", "--to", "1", "--step", "1",
                 "--contacts", tree})
                .exit_code,
            2);
  EXPECT_EQ(file_content(mesh), mesh_before);
  EXPECT_EQ(file_content(tree), tree_before);
}

TEST_F(Files, DemoMakesItsJawsAndClosesThem) {
  IST_SLOW();
  const CommandResult result =
      ist_well({"demo", "--voxel-size", "3", "--json", "--keep", dir_.path()});
  EXPECT_EQ(result.err, "");
  const auto lines = json_lines(result.out);
  EXPECT_EQ(lines.size(), 21u);  // the published query, one worker, two; seven displacements
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const json& line = lines[i];
    for (const char* key : {"voxel_size", "spheres", "engine", "target", "workers", "displacement",
                            "leaf_pairs", "sphere_tests", "microseconds_median", "hertz"}) {
      EXPECT_TRUE(line.contains(key)) << key;
    }
    EXPECT_EQ(line["engine"], i < 7 ? "reference" : "simd");
    EXPECT_EQ(line["workers"], i < 14 ? 1 : 2);
    EXPECT_EQ(line["leaf_pairs"], lines[i < 14 ? i : i - 7]["leaf_pairs"]);
    EXPECT_EQ(line["voxel_size"], 3);
    EXPECT_TRUE(line["displacement"] != 0 || line["leaf_pairs"] > 0);
  }
  EXPECT_EQ(dir_.entries(), 2u);
  const CommandResult table = ist_well({"demo", "--voxel-size", "3"});
  EXPECT_TRUE(says(table.out, "published"));
  EXPECT_TRUE(says(table.out, "Their bite at dz = -0.6 mm:\ntouch yes, 0.407 to 0.419 mm deep"));
  EXPECT_TRUE(says(table.out, std::string("Try next: ") + IST_COMMAND + " demo --keep"));
  EXPECT_EQ(std::count(table.out.begin(), table.out.end(), '|'), 8);  // a row each, and its legend

  // What it keeps are meshes for the other subcommands.
  const std::string upper = path("upper_jaw.stl"), lower = path("lower_jaw.stl");
  const CommandResult built =
      ist_well({"build", upper, "-o", path("upper.ist"), "--voxel-size", "2"});
  EXPECT_EQ(built.err, "");
  const CommandResult closed =
      ist_well({"approach", path("upper.ist"), lower, "--voxel-size", "2", "--axis", "z", "--from",
                "-12", "--to", "0", "--step", "3", "--json"});
  EXPECT_EQ(closed.err, "");
  const auto path_lines = json_lines(closed.out);
  ASSERT_EQ(path_lines.size(), 6u);
  EXPECT_EQ(path_lines.front()["touch"], "no");
  EXPECT_EQ(path_lines[4]["touch"], "yes");
  EXPECT_EQ(path_lines.back()["first_contact"], "contact");
}

}  // namespace
}  // namespace ist::test
