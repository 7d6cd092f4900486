#pragma once

#include "peers/peer.h"

namespace ist::bench {

/// Bullet: btGImpactMeshShape with margin 0, in float as Debian's default library is. Two
/// contestants:
///  - `bullet`: btGImpactCollisionAlgorithm, called without a world, its contact points received as
///    btCollisionWorld::contactPairTest receives them and counted by the two triangles that it
///    names with each. It lists all pairs of boxes before it looks at a triangle and cannot stop at
///    the first contact, so whether the meshes meet costs it as much as all pairs.
///  - `bullet_boxes`: btGImpactBoxSet::find_collision, which lists candidates, told apart by
///    meet() in double where pairs are asked for: Bullet's hierarchy without its
///    triangles.
/// Differences: boxes are of 16 bits an axis, rounded to the nearest, so that a pair may be
/// missed; and Bullet's own test of triangles clips one at the edges of the other in float, which
/// names more pairs than meet. It knows no distance between meshes that are apart.
[[nodiscard]] Library bullet_library();

}  // namespace ist::bench
