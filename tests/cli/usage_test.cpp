#include "cli/cli_case.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

class Usage : public CliTest {
 protected:
  // What is no use of the command: says so, and does nothing.
  void refuses(const std::vector<std::string>& arguments, const std::string& part) const {
    std::string spelled = "ist";
    for (const std::string& argument : arguments) spelled += " " + argument;
    SCOPED_TRACE(spelled);
    const std::size_t before = dir_.entries();
    const CommandResult result = ist(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_TRUE(says(result.err, part));
    EXPECT_EQ(result.err.rfind("ist: ", 0), 0u) << result.err;
    EXPECT_EQ(dir_.entries(), before);
  }
};

TEST_F(Usage, HelpTeaches) {
  const CommandResult help = ist_well({"--help"});
  EXPECT_TRUE(says(help.out, "ist demo"));
  EXPECT_TRUE(says(help.out,
                   "Exit codes: 0 fine, 1 failed, 2 usage, 3 bad input file, 4 deadlines missed "
                   "(run),\n5 a result breaks a guarantee"));
  EXPECT_EQ(help.err, "");
  const std::vector<std::pair<std::string, std::vector<std::string>>> taught = {
      {"demo", {"--voxel-size", "--seed", "--keep", "--json"}},
      {"build",
       {"MESH", "--output", "--voxel-size", "--unit", "--spheres", "--no-triangles", "--classes",
        "--max-memory", "--json", "Example: ist build"}},
      {"info", {"FILE", "--json"}},
      {"export", {"TREE", "--what", "--level", "--spheres", "--output", "Example: ist export"}},
      {"collide", {"FIXED",        "MOVING",
                   "--move",       "--turn",
                   "--matrix",     "row by row",
                   "--poses",      "column by column",
                   "--voxel-size", "--distance",
                   "--depth",      "--exact",
                   "--escape",     "--spheres",
                   "--engine",     "--workers",
                   "--target",     "IST_TARGET",
                   "--repeat",     "--max-tests",
                   "--timing",     "--verify",
                   "--contacts",   "--fail-if-touching",
                   "--json",       "Examples: ist collide"}},
      {"approach",
       {"FIXED", "MOVING", "--axis", "--from", "--to", "--step", "--first-contact", "--move",
        "Example: ist approach"}},
      {"run",
       {"SCENE", "--check", "--explain", "--rate", "--seconds", "--allow-missed", "--record",
        "--replay", "--unpaced", "--cpu", "--json", "Example: ist run"}},
      {"advise",
       {"FIXED", "MOVING", "--budget-us", "--error", "--poses", "--axis", "--workers", "--target",
        "--max-memory", "--json", "Example: ist advise"}},
      {"sweep",
       {"SWEEP", "--output", "--share", "--threads", "--merge", "--status", "--verify", "--json",
        "Examples: ist sweep"}},
      {"table",
       {"--format", "--vectors", "--seed", "--check", "--output", "--json", "Example: ist table"}}};
  for (const auto& [command, parts] : taught) {
    EXPECT_TRUE(says(help.out, "\n  " + command));
    const CommandResult result = ist_well({command, "--help"});
    EXPECT_TRUE(says(result.out, "Usage: ist " + command));
    for (const std::string& part : parts) EXPECT_TRUE(says(result.out, part)) << command;
    EXPECT_EQ(result.err, "");
  }
}

TEST_F(Usage, HelpAndVersionAreWordsToo) {
  EXPECT_EQ(ist_well({"help"}).out, ist_well({"--help"}).out);
  EXPECT_EQ(ist_well({"help", "approach"}).out, ist_well({"approach", "--help"}).out);
  const std::string version = ist_well({"--version"}).out;
  EXPECT_EQ(ist_well({"version"}).out, version);
  EXPECT_EQ(ist_well({"-V"}).out, version);
  for (const char* part : {"ist 0.", "\ncommit ", "\ncompiler ", "\ninstruction sets ", "scalar",
                           "\ntree file version "}) {
    EXPECT_TRUE(says(version, part));
  }
}

TEST_F(Usage, SubcommandsAndFlagsThatAreNotThere) {
  refuses({}, "subcommand is required");
  refuses({"nonsense"}, "nonsense: no such subcommand\nTry");
  refuses({"--nonsense"}, "--nonsense: no such option");
  refuses({"help", "nonsense"}, "nonsense: no such subcommand");
  for (const char* command : {"demo", "build", "info", "export", "collide", "approach", "advise",
                              "bench", "table", "run"}) {
    const CommandResult result = ist({command, "--nonsense", "1"});
    EXPECT_EQ(result.exit_code, 2) << command;
    EXPECT_EQ(result.out, "");
    EXPECT_TRUE(says(result.err, std::string("Try 'ist ") + command + " --help'"));
  }
  refuses({"info", ball(), "--nonsense"}, "--nonsense");
  refuses({"info", ball(), "more"}, "more");
}

// Before anything that is missing.
TEST_F(Usage, AMisspelledWordIsNamedWithItsNearest) {
  refuses({"colide"}, "colide: no such subcommand; did you mean collide?");
  refuses({"aproach", "x"}, "did you mean approach?");
  refuses({"collide", "--voxelsize", "0.5"},
          "--voxelsize: no such option; did you mean --voxel-size?");
  refuses({"collide", "--pose=x"}, "--pose: no such option; did you mean --poses?");
  refuses({"build", "--ouput", "x"}, "did you mean --output?");
  refuses({"colide"}, "Try 'ist --help'");
  refuses({"close", "a", "b"}, "close: no such subcommand; it is called approach");
  refuses({"collide", "a", "b", "--gap", "1"}, "--gap: no such option; it is called --distance");
}

TEST_F(Usage, VoxelSizes) {
  const std::string mesh = ball(), tree = path("out.ist"), list = poses({0});
  const std::pair<const char*, const char*> bad[] = {{"0", "positive"},
                                                     {"-1", "positive"},
                                                     {"nan", "positive"},
                                                     {"inf", "positive"},
                                                     {"1e-9", "smallest size for this mesh is"},
                                                     {"x", "--voxel-size"}};
  for (const auto& [size, part] : bad) {
    refuses({"build", mesh, "-o", tree, "--voxel-size", size}, part);
    refuses({"collide", mesh, mesh, "--poses", list, "--voxel-size", size}, part);
  }
  for (const char* size : {"0", "-3", "nan", "inf", "3,0", "x"}) {
    refuses({"demo", "--voxel-size", size}, "--voxel-size");
  }
}

TEST_F(Usage, WhatIsNoNumber) {
  for (const char* word : {"banana", "1,5", "0.4mm"}) {
    refuses({"build", ball(), "-o", path("out.ist"), "--voxel-size", word},
            std::string("--voxel-size = ") + word + ": give a number as its help says");
  }
  refuses({"bench", "--seconds", "ten"}, "--seconds = ten: give a number as its help says");
}

TEST_F(Usage, AValueOfAFlag) {
  for (const char* value : {"banana", "", "1", "true", "false"}) {
    refuses({"bench", std::string("--json=") + value}, "--json: takes no value; give it alone");
    refuses({std::string("--version=") + value}, "--version: takes no value; give it alone");
  }
}

TEST_F(Usage, WordsMayBeInAnyCase) {
  const std::string mesh = ball(), tree = path("out.ist");
  ist_well(
      {"build", mesh, "-o", tree, "--voxel-size", "0.5", "--unit", "MM", "--spheres", "Tight"});
  EXPECT_TRUE(says(ist_well({"info", tree}).out, "unit mm"));
  const std::vector<std::string> approach{"approach", mesh, tree,   "--axis", "Z",
                                          "--from",   "4",  "--to", "5"};
  EXPECT_TRUE(says(ist_well(approach).out, "first contact"));
  const auto bite = [&](const std::string& preset, const std::string& frame) {
    return ist_well({"occlusion", mesh, tree, "--move", "0,0,3.9", "--preset", preset, "--frame",
                     frame, "--json"})
        .out;
  };
  EXPECT_EQ(bite("SCAN", "LPS"), bite("scan", "lps"));
}

TEST_F(Usage, OptionsOfBuild) {
  const std::string mesh = ball(), tree = path("out.ist");
  const auto refuses_with = [&](const std::string& flag, const std::string& value,
                                const std::string& part) {
    refuses({"build", mesh, "-o", tree, "--voxel-size", "0.5", flag, value}, part);
  };
  refuses({"build", mesh, "--voxel-size", "0.5"}, "--output");
  refuses_with("--classes", "nonsense", "surface, proximity");
  refuses_with("--classes", "surface,nonsense", "nonsense");
  refuses_with("--classes", "proximity", "surface voxels are always made");
  refuses_with("--spheres", "cubes", "simple, table, tight, slab");
  refuses_with("--unit", "furlong", "mm, m, inch, um");
  refuses_with("--unit", "", "mm, m, inch, um");
  refuses_with("--unit", "INHC",
               "--unit: 'INHC' is none of mm, m, inch, um, µm; did you mean inch?");
  refuses_with("--max-memory", "10", "allow more");
  refuses_with("--max-memory", "-5", "positive");
  refuses_with("--max-memory", "lots", "--max-memory");
  // Under a limit that a coarser grid would keep, it is named.
  refuses({"build", mesh, "-o", tree, "--voxel-size", "0.001", "--max-memory", "1M"},
          "use a voxel size of");
}

TEST_F(Usage, OptionsOfQueries) {
  const std::string mesh = ball(), list = poses({0});
  const auto refuses_with = [&](const std::string& flag, const std::string& value,
                                const std::string& part) {
    refuses({"collide", mesh, mesh, "--poses", list, "--voxel-size", "0.5", flag, value}, part);
  };
  refuses_with("--repeat", "0", "1 to");
  refuses_with("--repeat", "-1", "1 to");
  refuses_with("--repeat", "1.5", "--repeat");
  refuses_with("--engine", "nonsense", "reference");
  refuses_with("--spheres", "nonsense", "simple, table, tight, slab");
  refuses({"collide", mesh, "--poses", list, "--voxel-size", "0.5"}, "MOVING");
}

TEST_F(Usage, OptionsOfApproach) {
  const std::string mesh = ball();
  const auto refuses_with = [&](const std::string& axis, const std::string& from,
                                const std::string& to, const std::string& step,
                                const std::string& part) {
    refuses({"approach", mesh, mesh, "--voxel-size", "0.5", "--axis", axis, "--from", from, "--to",
             to, "--step", step},
            part);
  };
  refuses_with("w", "0", "1", "0.1", "x, y, z");
  refuses_with("xy", "0", "1", "0.1", "--axis");
  for (const char* step : {"0", "-0.1", "nan", "1e-9", "1e-320"}) {
    refuses_with("x", "0", "1", step, "--step");
  }
  refuses_with("x", "nan", "1", "0.1", "finite");
  refuses_with("x", "0", "inf", "0.1", "finite");
  refuses_with("x", "-1e308", "1e308", "1", "--step");
}

TEST_F(Usage, OptionsOfExport) {
  const std::string tree = ball_tree(), out = path("out.ply");
  refuses({"export", tree, "--what", "else", "--level", "0", "-o", out}, "voxels, spheres");
  refuses({"export", tree, "--what", "voxels", "--level", "9", "-o", out}, "levels 0 to 3");
  refuses({"export", tree, "--what", "voxels", "--level", "99", "-o", out}, "--level");
  refuses({"export", tree, "--what", "voxels", "--level", "-1", "-o", out}, "--level");
  refuses({"export", tree, "--what", "voxels", "--level", "0", "--spheres", "table", "-o", out},
          "goes with --what spheres");
  refuses({"export", tree, "--what", "voxels", "-o", out}, "--level");
  refuses({"export", ball_tree("plain.ist", "table"), "--what", "spheres", "--level", "0",
           "--spheres", "tight", "-o", out},
          "build it with spheres tight");
  refuses({"export", tree, "--what", "spheres", "--level", "0", "--spheres", "slab", "-o", out},
          "build it with spheres slab");
  const auto refuses_name = [&](const char* what, const std::string& name, const char* remedy) {
    refuses({"export", tree, "--what", what, "--level", "0", "-o", name}, "-o " + name + remedy);
    EXPECT_FALSE(std::filesystem::exists(name));
  };
  refuses_name("voxels", path("v.stl"),
               ": .stl cannot be written here: name a file that ends in .vtp, .ply or .glb");
  refuses_name("spheres", path("v.glb"),
               ": .glb cannot be written here: name a file that ends in .vtp or .ply");
  refuses_name("spheres", path("v"),
               ": a name without an ending says no format: name a file that ends in .vtp or .ply");
  refuses({"export", tree, "--what", "voxels", "--level", "0", "--unit", "mm", "-o", out},
          "--unit: goes with a .glb");
  refuses(
      {"export", tree, "--what", "voxels", "--level", "0", "--unit", "mile", "-o", path("v.glb")},
      "--unit");
}

TEST_F(Usage, OptionsOfDemo) {
  refuses({"demo", "--keep", path("none")}, "none");
  refuses({"demo", "--seed", "-1"}, "--seed");
}

// The voxel size is for meshes: refused without a mesh.
TEST_F(Usage, VoxelSizeGoesWithMeshes) {
  const std::string mesh = ball(), tree = ball_tree(), list = poses({0});
  refuses({"collide", tree, tree, "--poses", list, "--voxel-size", "0.5"}, "both bodies are trees");
  const auto sizes = [&](const std::string& fixed, const std::string& moving) {
    const auto result =
        ist_well({"collide", fixed, moving, "--poses", list, "--voxel-size", "0.25", "--json"});
    return json_lines(result.out).at(0)["voxel_size"];
  };
  EXPECT_EQ(sizes(tree, mesh), (nlohmann::json{0.5, 0.25}));
  EXPECT_EQ(sizes(mesh, tree), (nlohmann::json{0.25, 0.5}));
  EXPECT_EQ(sizes(mesh, mesh), (nlohmann::json{0.25, 0.25}));
}

TEST_F(Usage, SpheresThatATreeDoesNotHave) {
  const std::string tight = ball_tree(), plain = ball_tree("plain.ist", "table");
  const std::string slab = ball_tree("slab.ist", "slab"), list = poses({0});
  refuses({"collide", tight, plain, "--poses", list, "--spheres", "tight"},
          "plain.ist: the tree holds no tight spheres: build it with spheres tight");
  refuses({"collide", slab, tight, "--poses", list, "--spheres", "slab"},
          "ball.ist: the tree holds no slab spheres: build it with spheres slab");
  const auto spheres = [&](const std::string& fixed, const std::string& moving) {
    const auto result = ist_well({"collide", fixed, moving, "--poses", list, "--json"});
    return json_lines(result.out).at(0)["spheres"];
  };
  EXPECT_EQ(spheres(tight, tight), "tight");
  EXPECT_EQ(spheres(tight, plain), "table");
  EXPECT_EQ(spheres(plain, tight), "table");
  EXPECT_EQ(spheres(slab, slab), "slab");
  EXPECT_EQ(spheres(slab, tight), "tight");
  EXPECT_EQ(spheres(plain, slab), "table");
}

}  // namespace
}  // namespace ist::test
