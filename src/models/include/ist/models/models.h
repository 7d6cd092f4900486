#pragma once

/// @file
/// Built-in jaws and shapes. Link libist_loop (CMake ist::loop).
#include <Eigen/Core>
#include <cstdint>

#include "ist/base/api.h"
#include "ist/mesh/mesh.h"

namespace ist {

/// The jaws of make_jaw().
enum class Jaw {
  kLower,  ///< the mandible, with its condyles
  kUpper,  ///< the maxilla
};

/// Makes a human jaw with its teeth, the stand-in for a scan in the demo and the tests.
///
/// Millimetres; x left to right, y from the incisors (-48) back to the condyles (+37), z up, the
/// teeth meeting at z = 48. Both jaws share the frame. As made they are in full occlusion, with
/// molars and canines about 1 mm too close, for any two seeds; moving the lower jaw by dz = -2
/// separates them, and with most seeds dz = -1.5 does.
///
/// @param jaw  the jaw to make
/// @param seed varies size, position, rotation and wear of the teeth, and the bone's surface
///
/// The surface is closed, of genus 0, and faces outward. The lower jaw has 119,096 triangles, the
/// upper one 106,676. Coordinates are floats held as doubles. Only + - * / and sqrt are used, so
/// one seed gives the same bytes on every machine. Cost: some 5 ms, one thread.
IST_API TriangleMesh make_jaw(Jaw jaw, std::uint64_t seed);

/// Makes an occlusal splint to lie between both jaws of make_jaw(), the lower one lowered by dz =
/// -`opening`: a demonstration shape, not a design for a patient.
///
/// @param seed    of both jaws
/// @param opening mm
///
/// A horseshoe, 10.5 mm wide all along the dental arch, from molar to molar. Its upper face is a
/// height over the occlusal plane, and so is its lower one: teeth leave imprints, and either arch
/// comes free along z. Its surface is at least 0.2 mm from either jaw's. Where no tooth is near it
/// ends 1.5 mm beyond the occlusal plane of either arch. It is thinnest between canines; with an
/// opening of 5 mm, 1.5 mm or more for each seed up to 200.
///
/// Closed, of genus 0, facing outward, of 33,520 triangles. Coordinates are floats held as doubles;
/// the same bytes on every machine. Cost: some 0.2 s, part of it on all cores.
///
/// Errors: kArgumentInvalid for an opening outside 0 to 20 mm, or one that leaves less than 0.5 mm
/// of splint somewhere; the text names the least opening that leaves as much.
[[nodiscard]] IST_API TriangleMesh make_splint(std::uint64_t seed, double opening);

// Basic shapes: closed, of genus 0, facing outward, mesh units, the same bits on every machine.

/// Makes a box of 12 triangles between two opposite corners. Precondition: min < max on every axis.
[[nodiscard]] IST_API TriangleMesh make_box(const Eigen::Vector3d& min, const Eigen::Vector3d& max);

/// Makes an icosahedron subdivided `level` times, with its vertices on the sphere round the origin:
/// 20 * 4^level triangles, with edges of at most 1.33 * radius / 2^level.
/// Precondition: level from 0 to 12.
[[nodiscard]] IST_API TriangleMesh make_icosphere(int level, double radius);

/// Makes a cylinder round the z axis, from z = 0 up, of 4 * `quarter` sides with corners on the
/// circle: 16 * `quarter` triangles. Precondition: quarter from 1 to 2^24.
[[nodiscard]] IST_API TriangleMesh make_cylinder(int quarter, double radius, double height);

/// Makes a fossa, the socket of a condyle: the solid between two half spheres round the origin,
/// z >= 0, of `radius` and of `radius + thickness`; it opens towards -z, with a flat rim at z = 0.
/// All vertices lie on the spheres: 16 * `quarter`^2 triangles, no deeper below their sphere than
/// 1/`quarter`^2 of its radius. Precondition: quarter from 1 to 2^12.
///
/// Round (+-49.2, 33.5, 74) a radius of 7 holds the condyles of make_jaw(), 0.4 mm free, also where
/// the lower jaw turns about the axis through both centres.
[[nodiscard]] IST_API TriangleMesh make_fossa(int quarter, double radius, double thickness);

}  // namespace ist
