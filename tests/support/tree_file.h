#pragma once

#include <cstddef>
#include <cstring>
#include <string>

#include "ist/tree/sphere_tree.h"

namespace ist::test {

/// The bytes of a tree file, and where its fields lie: written from the description of the format,
/// to damage files one field at a time.
class TreeFile {
 public:
  /// Offsets of the fields that stand at a fixed place.
  static constexpr std::size_t kMagic = 0, kVersion = 8, kByteOrder = 12, kBytes = 16,
                               kChecksum = 24, kBody = 32;
  static constexpr std::size_t kCorner = kBody, kVoxelSize = kBody + 24, kCells = kBody + 32,
                               kDepth = kBody + 36, kOrientation = kBody + 40,
                               kSections = kBody + 44, kHash = kBody + 48, kUnit = kBody + 56,
                               kNameBytes = kBody + 60, kName = kBody + 64;

  /// The file of a tree that has all sections.
  explicit TreeFile(const SphereTree& tree);

  std::string bytes;
  /// Of the arrays, in the order of the file. Nodes of the octree begin with those at level 1.
  std::size_t nodes, leaves, masks, normals, balls, slabs, counts, vertices, triangles, list_begins,
      list_ids, proximity_depth, proximity_nodes, proximity_leaves, proximity_masks, axes, blocks,
      clusters;

  template <typename T>
  [[nodiscard]] T get(std::size_t offset) const {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof(T));
    return value;
  }
  template <typename T>
  void put(std::size_t offset, T value) {
    std::memcpy(bytes.data() + offset, &value, sizeof(T));
  }

  /// Makes size and checksum right again.
  void seal();
};

/// Makes size and checksum of a file right that has at least kBody bytes.
void seal(std::string& tree_file);

/// The bytes that write_tree writes.
[[nodiscard]] std::string file_of(const SphereTree& tree);

/// Throws what read_tree throws for a file of these bytes.
SphereTree tree_of_bytes(const std::string& bytes);

}  // namespace ist::test
