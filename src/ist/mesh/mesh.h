#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ist/base/api.h"
#include "ist/base/progress.h"

namespace ist {

/// The indices of a triangle's three vertices.
using Triangle = std::array<std::uint32_t, 3>;

// Vector3d must be three plain doubles for every instruction set of the including code.
static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double) &&
              alignof(Eigen::Vector3d) == alignof(double));

/// Says how the outer side of a mesh is known.
enum class Orientation : std::uint8_t {
  kOutward,  ///< every component is closed: the outside is known
  kAssumed,  ///< some component is not: the file's winding is trusted
};

/// The directions of the patient that a mesh's axes point to. 3D Slicer writes SPACE=RAS or
/// SPACE=LPS into its files. A half turn about z leads from one frame to the other.
/// Tree files and the C interface hold the numbers.
enum class PatientFrame : std::uint8_t {
  kUnknown,  ///< 0: the file does not say
  kRas,      ///< 1: +x right, +y front, +z up
  kLps,      ///< 2: +x left, +y back, +z up
};

/// All frames but kUnknown.
inline constexpr std::array kPatientFrames = {PatientFrame::kRas, PatientFrame::kLps};

/// Returns "ras" or "lps"; "unknown" for kUnknown.
[[nodiscard]] constexpr std::string_view to_string(PatientFrame frame) noexcept {
  constexpr std::array<std::string_view, 3> kNames = {"unknown", "ras", "lps"};
  const auto at = static_cast<std::size_t>(frame);
  return at < kNames.size() ? kNames[at] : "";
}

/// Returns the frame of that name, or nullopt for another text.
[[nodiscard]] constexpr std::optional<PatientFrame> patient_frame(std::string_view name) noexcept {
  for (const PatientFrame frame : kPatientFrames) {
    if (name == to_string(frame)) return frame;
  }
  return std::nullopt;
}

/// Returns whether both frames are known, and differ.
[[nodiscard]] constexpr bool contradict(PatientFrame a, PatientFrame b) noexcept {
  return a != b && a != PatientFrame::kUnknown && b != PatientFrame::kUnknown;
}

/// The unit of a mesh's lengths. Most mesh files do not tell it.
/// Tree files and the C interface hold the numbers.
enum class LengthUnit : std::uint8_t {
  kUnknown,     ///< 0: nobody told
  kMillimetre,  ///< 1
  kMetre,       ///< 2
  kInch,        ///< 3
  kMicrometre,  ///< 4
};

/// All units but kUnknown.
inline constexpr std::array kLengthUnits = {LengthUnit::kMillimetre, LengthUnit::kMetre,
                                            LengthUnit::kInch, LengthUnit::kMicrometre};

/// Returns "mm", "m", "inch" or "µm"; "unknown" for kUnknown.
[[nodiscard]] constexpr std::string_view to_string(LengthUnit unit) noexcept {
  constexpr std::array<std::string_view, 5> kNames = {"unknown", "mm", "m", "inch", "µm"};
  const auto at = static_cast<std::size_t>(unit);
  return at < kNames.size() ? kNames[at] : "";
}

/// Returns the unit of that name, which may be "um" too, or nullopt for another text.
[[nodiscard]] constexpr std::optional<LengthUnit> length_unit(std::string_view name) noexcept {
  if (name == "um") return LengthUnit::kMicrometre;
  for (const LengthUnit unit : kLengthUnits) {
    if (name == to_string(unit)) return unit;
  }
  return std::nullopt;
}

/// Returns the metres in a unit; 0 for kUnknown.
[[nodiscard]] constexpr double metres_per_unit(LengthUnit unit) noexcept {
  constexpr std::array<double, 5> kMetres = {0, 1e-3, 1, 0.0254, 1e-6};
  const auto at = static_cast<std::size_t>(unit);
  return at < kMetres.size() ? kMetres[at] : 0;
}

/// Returns whether both units are known, and differ.
[[nodiscard]] constexpr bool contradict(LengthUnit a, LengthUnit b) noexcept {
  return a != b && a != LengthUnit::kUnknown && b != LengthUnit::kUnknown;
}

/// A surface of indexed triangles. Coordinates are in mesh units (millimetres by habit), in the
/// body's own frame. A triangle's vertices run counterclockwise as seen from its outer side.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;        ///< positions, used or not
  std::vector<Triangle> triangles;              ///< each index is below vertices.size()
  PatientFrame frame = PatientFrame::kUnknown;  ///< of the coordinates, if the file says it
  LengthUnit unit = LengthUnit::kUnknown;       ///< of the coordinates, if the file says it
};

/// Reads a mesh from STL (binary or text), PLY (binary or text), OBJ, OFF (text) or VTK PolyData
/// (.vtk or .vtp). The program ist-import, started by this call, reads glTF 2.0, 3MF, COLLADA, FBX,
/// X3D, AMF, 3DS, AC3D and LightWave. The content decides the format; the file's name helps
/// only for an OBJ, an OFF without a keyword and formats without a mark. Several solids, groups,
/// pieces or meshes of a scene become one mesh, polygons and strips become triangles, and vertices
/// at exactly the same position become one. Vertices are in the order in which the faces first use
/// them. Unused vertices and the file's normals, colours and materials are dropped. The file is
/// read once. No other file is read, except the ones in its folder or below that a scene names.
///
/// Coordinates are what the file holds: in an STL floats, in text as well; in a PLY or VTK file the
/// type that it declares; in an OBJ, an OFF or a 3MF doubles; in the others floats. What a scene
/// transforms is placed in double; where it mirrors a mesh its triangles are turned round. No
/// coordinate is beyond the range of a float. At most 2^25 vertices and corners are placed, and
/// 2^29 bytes unpacked. A frame comes from the header of an STL, from comments in a PLY or OBJ, or
/// from the title or field data of a VTK file: SPACE=RAS or SPACE=LPS. A unit comes from a glTF,
/// COLLADA or X3D (metres), a 3MF, an AMF or an FBX. No length is converted, but centimetres become
/// 10 mm, feet 12 inches, each unit of an FBX millimetres and each unit of an X3D metres. A COLLADA
/// gets y up.
///
/// Cost: linear in the file, some 50 ms for 100,000 triangles; memory, at most five times a binary
/// STL, and twice for a closed surface.
/// A file for ist-import takes 10 ms more. After 60 s of processor time the file is refused.
/// Errors: kFileUnreadable, kNotAMesh, kMeshEmpty, kMeshPointsOnly, kMeshTruncated, kMeshBadIndex,
/// kMeshNotFinite, kMeshExtent, kMeshTooLarge; the text names the file and the place in it. If the
/// importer crashes, kNotAMesh says so.
[[nodiscard]] IST_API TriangleMesh read_mesh(const std::filesystem::path& file);

/// Writes binary STL: little-endian, coordinates rounded to float, normals from the winding, and a
/// known frame in the header. The file appears whole or not at all: it is written under a temporary
/// name in the same folder and then renamed.
///
/// Errors: kFileUnwritable, and kMeshNotFinite for a coordinate beyond float.
IST_API void write_stl(const TriangleMesh& mesh, const std::filesystem::path& file);

/// Two triangles of a mesh that meet beyond the corners and edges that they share.
struct SelfIntersection {
  std::array<std::uint32_t, 2> triangles;  ///< the lower index first
  Eigen::Vector3d near;                    ///< the middle of the overlap of their boxes, mesh units
};

/// The counts of a mesh's elements and defects. Vertices count as one only if they share an index,
/// even where their positions are equal.
///
/// A triangle with two equal indices has no sides: it is degenerate, and no other defect counts it.
struct MeshReport {
  std::size_t vertices = 0;             ///< all vertices, used or not
  std::size_t triangles = 0;            ///< all triangles, degenerate ones included
  std::size_t edges = 0;                ///< pairs of vertices that sides of triangles join
  std::size_t boundary_edges = 0;       ///< edges of only one triangle
  std::size_t non_manifold_edges = 0;   ///< edges of more than two triangles
  std::size_t inconsistent_edges = 0;   ///< edges that two triangles traverse in the same direction
  std::size_t duplicate_triangles = 0;  ///< same vertices as an earlier one, in any order
  /// Triangles with two equal indices, or no area: |cross product| at most 1e-12 of the longest
  /// side squared.
  std::size_t degenerate_triangles = 0;
  /// Pairs of triangles that meet beyond the corners and edges that they share. Triangles that only
  /// touch count, those of area 0 do not.
  std::size_t self_intersections = 0;
  /// False if there may be more: the search ends after some 2^20 pairs. It also needs a largest
  /// extent in [1e-12, 1e15].
  bool self_intersections_complete = true;
  std::vector<SelfIntersection> first_self_intersections;  ///< at most 8, by their indices
  std::size_t components = 0;       ///< sets of triangles connected by vertices
  std::size_t open_components = 0;  ///< components with a boundary edge
  bool closed = false;              ///< each edge belongs to an even number of triangles
  /// Of each edge of an even number of triangles, as many traverse it one way as the other.
  bool consistent = false;
  Eigen::Vector3d box_min = Eigen::Vector3d::Zero();  ///< least x, y, z of all vertices, mesh units
  Eigen::Vector3d box_max = Eigen::Vector3d::Zero();  ///< greatest x, y, z
  double signed_volume = 0;  ///< mesh units cubed; positive if outward; means little if not closed
};

/// Throws kMeshEmpty, kMeshPointsOnly, kMeshNotFinite or kMeshBadIndex, naming the first vertex or
/// triangle, for a mesh that no tree can be built of. build_tree() calls it. Cost: 2 ns a triangle.
IST_API void require_valid(const TriangleMesh& mesh);

/// Checks the topology of a mesh, and finds its self-intersections exactly. Throws kMeshNotFinite
/// or kMeshBadIndex, as require_valid() does.
/// Cost: O(t log t), some 150 ms for 100,000 triangles.
[[nodiscard]] IST_API MeshReport check_mesh(const TriangleMesh& mesh);

/// Returns a sentence for people for each kind of defect; empty for a mesh without defects.
[[nodiscard]] IST_API std::vector<std::string> warnings(const MeshReport& report);

/// Makes all triangles use the first vertex at each position, so that triangles whose corners have
/// equal coordinates are neighbours. All vertices and triangles keep their numbers. A triangle with
/// two corners at one position gets two equal indices. Throws kMeshNotFinite or kMeshBadIndex, as
/// require_valid() does. Cost: 50 ns a vertex.
IST_API void weld(TriangleMesh& mesh);

/// Turns a mesh from one known frame of a patient into the other: x and y change their signs. It
/// does nothing if either frame is unknown. Cost: 1 ns a vertex.
IST_API void turn_into(TriangleMesh& mesh, PatientFrame frame);

/// The result of orient_outward().
struct OrientationResult {
  Orientation orientation = Orientation::kAssumed;  ///< of the mesh after the turns
  std::size_t turned_components = 0;                ///< components turned; worth a warning
};

/// Turns a mesh that is inside out, so that its normals can be trusted.
///
/// A component is a set of triangles connected by edges. It is closed if as many of its triangles
/// traverse each edge one way as the other. An outermost closed component of negative volume is
/// turned, with all components inside it. So a cavity stays a cavity, and a solid inside a solid
/// stays one. A component lies inside another if all its vertices do, by exact winding numbers; if
/// the other is open, by the crossings of a ray. If all its vertices lie on the other's surface,
/// the middles of its triangles decide. A component that is not closed makes the result `kAssumed`,
/// and so does a mesh whose volumes are all 0. Triangles with two equal indices stay.
///
/// Throws kMeshNotFinite or kMeshBadIndex, as require_valid() does.
/// Neither the unit nor the position of the mesh matters. `progress` may be nullptr; it can end the
/// call, as Progress says, and then the mesh is as it was.
/// Cost: 0.2 µs a triangle; if a component has a negative volume, 1 µs a triangle and core more,
/// and some µs for each vertex inside another component.
[[nodiscard]] IST_API OrientationResult orient_outward(TriangleMesh& mesh,
                                                       Progress* progress = nullptr);

}  // namespace ist
