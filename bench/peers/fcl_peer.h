#pragma once

#include "peers/peer.h"

namespace ist::bench {

/// FCL: BVHModel<OBBRSS<double>>, which collides by oriented boxes and measures by swept
/// rectangles. Two contestants:
///  - `fcl`: collide() with one contact; collide() with all of them and enable_contact off, which
///    still lists both triangles of each and leaves out only their points and normals, so is the
///    fastest complete answer; distance() without nearest points, which is exact: more than the
///    interval of 0.05 mm that is asked for.
///  - `fcl_within`: distance alone, and no closer than asked for: the same traversal, which passes
///    over what is at most 0.05 mm nearer than the nearest pair so far, so that the answer is the
///    interval from that pair's distance down to 0.05 mm less. DistanceRequest's abs_err does not
///    do that in 0.7: it is not passed on to a mesh, and does nothing there while rel_err is 0.
/// Differences: its predicates are in double and not exact, so nothing is guaranteed where
/// triangles only touch or lie in one plane. Debian's library is built for any x86-64, without
/// FCL's own SSE code, and with assertions.
[[nodiscard]] Library fcl_library();

}  // namespace ist::bench
