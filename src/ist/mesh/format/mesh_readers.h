#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

#include "ist/mesh/mesh.h"

namespace ist {

/// The parts of a binary STL, bytes: a header, the number of facets, and the facets.
inline constexpr std::size_t kStlHeaderBytes = 80;
inline constexpr std::size_t kStlCountEnd = 84;
inline constexpr std::size_t kStlNormalBytes = 12;  ///< at the begin of a facet
inline constexpr std::size_t kStlFacetBytes = 50;

struct VtkLabels;

/// The formats that read_content() reads with ist-import, for messages and helps. Headers and pages
/// name the same.
inline constexpr std::string_view kMeshFormats =
    "STL, PLY, OBJ, OFF, VTK PolyData, glTF, 3MF, COLLADA, FBX, X3D, AMF, 3DS, AC3D or LightWave";

/// Reads the content of a mesh file, whose format the content tells (of an OBJ and an OFF also the
/// name). The file itself is not opened. glTF, 3MF and formats of assimp go to read_imported().
///
/// Cost: linear in the content, for any counts that the file claims. Errors: kNotAMesh, kMeshEmpty,
/// kMeshPointsOnly, kMeshTruncated, kMeshBadIndex, kMeshNotFinite, kMeshTooLarge.
[[nodiscard]] TriangleMesh read_content(std::string_view content,
                                        const std::filesystem::path& file);

/// Reads the content of one format; `file` is named in errors only.
[[nodiscard]] TriangleMesh read_binary_stl(std::string_view content, std::string_view file);
[[nodiscard]] TriangleMesh read_text_stl(std::string_view content, std::string_view file);
[[nodiscard]] TriangleMesh read_ply(std::string_view content, std::string_view file);
[[nodiscard]] TriangleMesh read_obj(std::string_view content, std::string_view file);
[[nodiscard]] TriangleMesh read_off(std::string_view content, std::string_view file);
/// The legacy form of VTK PolyData (.vtk), of versions up to 5.1: text and binary. Fills `labels`,
/// if it is not null, with all arrays.
[[nodiscard]] TriangleMesh read_vtk(std::string_view content, std::string_view file,
                                    VtkLabels* labels = nullptr);
/// The XML form of VTK PolyData (.vtp): text, base64 and raw appended data, packed by zlib or not.
[[nodiscard]] TriangleMesh read_vtp(std::string_view content, std::string_view file,
                                    VtkLabels* labels = nullptr);

/// How each legacy VTK file begins.
inline constexpr std::string_view kVtkBegin = "# vtk DataFile";

/// Whether the size matches the facet count of a binary STL.
[[nodiscard]] bool has_size_of_binary_stl(std::string_view content);
/// Whether the content could be a binary STL of the wrong size. It must begin with finite facets,
/// and have room for a 65,536th to 64 times as many facets as its header counts. Other data rarely
/// pass.
[[nodiscard]] bool begins_like_binary_stl(std::string_view content);
/// Whether a line of an OBJ may begin with `word`.
[[nodiscard]] bool is_obj_statement(std::string_view word);

}  // namespace ist
