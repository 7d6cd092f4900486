#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "ist/mesh/mesh.h"

namespace ist {

/// The first bytes of an answer of ist-import. All numbers have the byte order of the machine: both
/// programs run on it. The body follows, and then kImportEnd:
///   a mesh   `vertices` times three doubles; of each polygon its number of corners, 32 bits; of
///            each corner the index of its vertex, 32 bits
///   an error the place, `vertices` bytes, and the cause with its remedy, `polygons` bytes
struct ImportHeader {
  enum Kind : std::uint32_t { kMesh, kError };

  std::array<char, 8> magic;
  std::uint32_t protocol;        ///< kImportProtocol
  std::uint32_t kind;            ///< Kind
  std::array<char, 16> version;  ///< of the project, filled up with zeros
  std::uint32_t unit;            ///< a LengthUnit; of an error its ErrorCode
  std::uint32_t frame;           ///< a PatientFrame
  std::uint64_t vertices, polygons, corners;
};
static_assert(sizeof(ImportHeader) == 64);

inline constexpr std::array<char, 8> kImportMagic = {'I', 'S', 'T', '-', 'M', 'E', 'S', 'H'};
inline constexpr std::uint32_t kImportProtocol = 1;
/// Shows that the answer is complete.
inline constexpr std::string_view kImportEnd = "IST-DONE";

/// A mesh has at most so many vertices, and as many corners.
inline constexpr std::size_t kMostPlaced = std::size_t{1} << 25;

/// The remedy for a mesh that is not read.
inline constexpr std::string_view kConvert =
    "convert the mesh to STL, PLY or OBJ, for example with Blender or MeshLab";

/// Returns the header of this library's version, without its numbers.
[[nodiscard]] ImportHeader import_header();

/// Returns whether an answer has a header and an end.
[[nodiscard]] bool is_complete_import(std::string_view answer);

/// Makes a mesh of an answer. Nothing in it is trusted. `importer` and `file` are named in errors.
/// Errors: the one that the answer states; kFileUnreadable if the importer has another version or
/// breaks the format; kMeshBadIndex, kMeshNotFinite and kNotAMesh for the mesh's numbers.
[[nodiscard]] TriangleMesh read_import_message(std::string_view answer,
                                               const std::filesystem::path& importer,
                                               std::string_view file);

}  // namespace ist
