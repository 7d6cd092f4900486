#include "support/tree_file.h"

#include <xxhash.h>

#include <stdexcept>

#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"
#include "support/temp_dir.h"

namespace ist::test {

TreeFile::TreeFile(const SphereTree& tree) : bytes(file_of(tree)) {
  const auto octree = [](std::size_t at, const LinearOctree& of, std::size_t& of_leaves,
                         std::size_t& of_masks) {
    of_leaves = at + 4 * static_cast<std::size_t>(of.depth());
    of_masks = of_leaves + 4;
    return of_masks + of.node_count() - of.leaf_count();
  };
  const std::size_t leaf_count = tree.leaf_count();
  nodes = kName + tree.source().name.size();
  normals = octree(nodes, voxels_of(tree).octree, leaves, masks);
  balls = normals + 4 * leaf_count;
  slabs = balls + 8 * voxels_of(tree).octree.node_count();
  counts = slabs + 5 * voxels_of(tree).octree.node_count();
  vertices = counts + 24;
  const TriangleMesh& mesh = parts_of(tree).triangles->mesh;
  const TriangleLists& lists = voxels_of(tree).lists;
  triangles = vertices + 24 * mesh.vertices.size();
  list_begins = triangles + 12 * mesh.triangles.size();
  list_ids = list_begins + 4 * (leaf_count + 1);
  proximity_depth = list_ids + 4 * lists.ids.size();
  proximity_nodes = proximity_depth + 4;
  axes =
      octree(proximity_nodes, voxels_of(tree).proximity->octree, proximity_leaves, proximity_masks);
  blocks = axes + std::size_t{8} * (9 + 1);
  // The clusters' bounds, and those of each level above, of which the last is one node.
  std::size_t of_level = (mesh.triangles.size() + 15) / 16, levels = 1;
  const std::size_t cluster_count = of_level;
  clusters = blocks + 832 * ((of_level + 15) / 16);
  for (; of_level > 1 || levels < 2; ++levels) {
    of_level = (of_level + 15) / 16;
    clusters += 832 * ((of_level + 15) / 16);
  }
  const std::size_t end = clusters + 704 * cluster_count;
  if (end != bytes.size()) throw std::logic_error("the file is not as its format is described");
}

void TreeFile::seal() { test::seal(bytes); }

void seal(std::string& tree_file) {
  const std::uint64_t size = tree_file.size();
  const std::uint64_t checksum =
      XXH3_64bits(tree_file.data() + TreeFile::kBody, tree_file.size() - TreeFile::kBody);
  std::memcpy(tree_file.data() + TreeFile::kBytes, &size, sizeof size);
  std::memcpy(tree_file.data() + TreeFile::kChecksum, &checksum, sizeof checksum);
}

std::string file_of(const SphereTree& tree) {
  const TempDir folder;
  const auto file = folder.path() / "tree.ist";
  write_tree(tree, file);
  return file_content(file);
}

// A file in memory: thousands of files on a disk would be waited for.
SphereTree tree_of_bytes(const std::string& bytes) {
  const MemoryFile file;
  file.write(bytes);
  return read_tree(file.path());
}

}  // namespace ist::test
