#pragma once

#include <cstdint>

#include "ist/base/api.h"
#include "ist/mesh/triangle_mesh.h"

namespace ist {

enum class Jaw { kLower, kUpper };

/// A human jaw with its teeth, made from nothing: the demo's and the tests' stand-in for a scan.
///
/// Millimetres; x left to right, y from the incisors (-48) back to the condyles (+37), z up, the
/// teeth meeting at z = 48. Both jaws share the frame: as made they stand in full occlusion, molars
/// and canines 1 mm or so too close, whatever the two seeds are; moving the lower jaw by dz = -2
/// frees it, with most seeds -1.5 does.
///
/// @param seed varies size, place, turn and wear of the teeth, and the bone's surface
///
/// The surface is closed, of genus 0, and faces outward. The lower jaw has 119,096 triangles, the
/// upper one 106,676. Coordinates are floats held as doubles. Only + - * / and sqrt are used, so
/// one seed gives the same bytes on every machine. Cost: some 5 ms, one thread.
IST_API TriangleMesh make_jaw(Jaw jaw, std::uint64_t seed);

}  // namespace ist
