#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/commands/commands.h"
#include "cli/common_options.h"
#include "cli/refusals.h"
#include "ist/base/files.h"
#include "ist/tree/saved_spheres.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"

namespace ist::cli {
namespace {

struct ExportArguments {
  std::filesystem::path tree, output;
  std::string what, spheres;
  int level = 0;
  bool json = false;
};

// A binary PLY file, made in memory because it is small enough to look at.
class PlyFile {
 public:
  explicit PlyFile(const std::string& header)
      : bytes_("ply\nformat binary_little_endian 1.0\n" + header + "end_header\n") {}

  template <typename T>
  void add(T value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  void write(const std::filesystem::path& file) const {
    OutputFile output(file);
    output.write(bytes_.data(), bytes_.size());
    output.commit();
  }

 private:
  std::string bytes_;
};

std::size_t write_spheres(const SphereTree& tree, SpherePolicy policy,
                          const ExportArguments& options) {
  const std::vector<Ball> spheres = level_spheres(tree, policy, options.level);
  PlyFile ply(
      fmt::format("comment {} spheres of level {}: points with a radius\n"
                  "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
                  "property float radius\n",
                  to_string(policy), options.level, spheres.size()));
  for (const Ball& ball : spheres) {
    const Eigen::Vector3d centre = tree.origin() + ball.centre;
    for (Eigen::Index i = 0; i < 3; ++i) ply.add(static_cast<float>(centre[i]));
    ply.add(static_cast<float>(ball.radius));
  }
  ply.write(options.output);
  return spheres.size();
}

// Writes the faces of the cubes that no neighbour hides; returns the number of cubes.
std::size_t write_voxels(const SphereTree& tree, const ExportArguments& options) {
  struct Face {
    std::uint32_t first;
    int axis, side;
  };
  const std::vector<std::uint64_t> codes = tree.parts().octree.codes(options.level);
  const std::uint32_t end = 1u << (tree.depth() - options.level);
  std::vector<Face> faces;
  for (std::uint32_t i = 0; i < codes.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        Cell neighbour = morton_decode(codes[i]);
        std::uint32_t& index = neighbour[static_cast<std::size_t>(axis)];
        index += side == 1 ? 1u : ~0u;
        if (index < end &&
            std::binary_search(codes.begin(), codes.end(), morton_encode(neighbour))) {
          continue;
        }
        faces.push_back({i * 8, axis, side});
      }
    }
  }
  PlyFile ply(
      fmt::format("comment voxels of level {}: cubes, inner faces left out\n"
                  "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
                  "element face {}\nproperty list uchar uint vertex_indices\n",
                  options.level, 8 * codes.size(), faces.size()));
  const double half = 0.5 * tree.parts().lattice.edge(options.level);
  for (const std::uint64_t code : codes) {
    const Eigen::Vector3d centre =
        tree.origin() + tree.voxel_size() * cube_centre(tree.parts().lattice, options.level, code);
    for (int corner = 0; corner < 8; ++corner) {
      for (int i = 0; i < 3; ++i) {
        ply.add(static_cast<float>(centre[i] + ((corner >> i & 1) != 0 ? half : -half)));
      }
    }
  }
  for (const Face& face : faces) {
    // Counter-clockwise as seen from outside.
    const int u = 1 << (face.axis + 1) % 3, v = 1 << (face.axis + 2) % 3;
    const int base = face.side << face.axis;
    std::array<int, 4> corners{base, base + u, base + u + v, base + v};
    if (face.side == 0) std::reverse(corners.begin(), corners.end());
    ply.add(std::uint8_t{4});
    for (const int corner : corners) ply.add(face.first + static_cast<std::uint32_t>(corner));
  }
  ply.write(options.output);
  return codes.size();
}

void run(const ExportArguments& options) {
  refuse_if(options.what == "voxels" && !options.spheres.empty(), "--spheres",
            "goes with --what spheres");
  refuse_to_overwrite(options.output, {options.tree});
  const SphereTree tree = read_tree(options.tree);
  refuse_if(options.level > tree.depth(), "--level",
            fmt::format("the tree has levels 0 to {}", tree.depth()));
  const SpherePolicy policy =
      options.spheres.empty() ? tree.tightest() : *sphere_policy(options.spheres);
  tree.require(policy, options.tree.string());
  const std::size_t count =
      options.what == "voxels" ? write_voxels(tree, options) : write_spheres(tree, policy, options);
  if (options.json) {
    const nlohmann::ordered_json line{{"file", options.output.string()},
                                      {"what", options.what},
                                      {"level", options.level},
                                      {"count", count}};
    fmt::print("{}\n", line.dump());
  } else {
    fmt::print("{}: {} {}\n", options.output.string(), count, options.what);
  }
}

}  // namespace

void add_export(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "export", "Write a level of a tree as PLY, for ParaView, MeshLab or Blender");
  const auto options = std::make_shared<ExportArguments>();
  command->add_option("TREE", options->tree, "tree file")->required();
  command->add_option("--what", options->what, "cubes, or points with a property 'radius'")
      ->required()
      ->check(CLI::IsMember({"voxels", "spheres"}));
  command->add_option("--level", options->level, "0 for the leaves")
      ->required()
      ->check(CLI::Range(0, 17));
  command
      ->add_option("--spheres", options->spheres,
                   "spheres to write, of slab the balls; by default the tightest that the tree has")
      ->check(CLI::IsMember(policy_names()));
  command->add_option("-o,--output", options->output, "the PLY file to write")->required();
  command->add_flag("--json", options->json, "print one JSON object");
  add_example(
      *command,
      "Example: ist export jaw.ist --what spheres --spheres table --level 2 -o spheres.ply");
  command->callback([options] { run(*options); });
}

}  // namespace ist::cli
