#pragma once

#include <cstdint>
#include <filesystem>

#include "ist/base/api.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// The tree file, `.ist`, version 2. Little-endian, packed, in this order:
///
///     8 bytes   magic 89 49 53 54 0D 0A 1A 0A
///     u32       version
///     u32       0x01020304, to know another byte order by
///     u64       bytes in the file
///     u64       XXH3-64 of all that follows
///     f64 × 3   the grid's corner      f64  voxel size
///     u32       cells an axis          u32  depth
///     u32       orientation            u32  sections: 1 balls, 2 triangles, 4 proximity, 8 slabs
///     u32 × depth, u32                 nodes at levels 1 … depth; leaves
///     u8 …      masks of level 1, 2 … depth
///     u32 …     normals, one a leaf (PackedNormal)
///     balls:      i16 × 3, u16 …       centre, radius, of the nodes of level 0, 1 … depth
///     slabs:      i8 × 4, u8 …         normal, offset, half width, likewise
///     triangles:  u64 × 3              vertices, triangles, list entries
///                 f64 × 3 …, u32 × 3 … vertices, triangles
///                 u32 …, u32 …         the lists' beginnings (leaves + 1), their entries
///     proximity:  u32, u32 × depth, u32, u8 …   depth, nodes, leaves, masks
///
/// Children's indices and cubes are not stored: they follow from the masks. A ball's and a slab's
/// numbers are those of PackedBall and PackedSlab.
inline constexpr std::uint32_t kTreeFileVersion = 2;

/// Writes the file whole or not at all. Throws kFileUnwritable. Cost: bound by the disk.
/// Returns the bytes written.
IST_API std::uint64_t write_tree(const SphereTree& tree, const std::filesystem::path& file);

/// Reads a tree into memory of its own. The checksum and then every count, index and number is
/// verified before the tree is made, so no file can make a query crash or never end.
///
/// Cost: 1 ns a byte. Throws kFileUnreadable, kNotATree, kTreeVersion, kTreeTruncated,
/// kTreeCorrupt.
[[nodiscard]] IST_API SphereTree read_tree(const std::filesystem::path& file);

/// Whether the file begins as a tree file does. Throws kFileUnreadable.
[[nodiscard]] IST_API bool is_tree_file(const std::filesystem::path& file);

}  // namespace ist
