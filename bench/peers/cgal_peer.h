#pragma once

#include "peers/peer.h"

namespace ist::bench {

/// CGAL: a box tree of each mesh, with its triangles kept in it, and exact predicates on doubles
/// (EPICK), so that its pairs are IST's. Two contestants:
///  - `cgal`: the moving tree is gone through, its boxes turned in intervals; each triangle that is
///    reached is moved, and asks the fixed tree for all that it meets. Ends at the first where only
///    that is asked. CGAL's parts, put together here: its own compute_face_face_intersection is
///    not documented, takes no pose, and makes a box of each face of both meshes each time.
///  - `cgal_rigid`: Rigid_triangle_mesh_collision_detection, which CGAL has for the question
///    whether meshes meet. It turns the boxes of both trees, also where one does not move.
/// CGAL knows no distance between two meshes that is both exact and public: its closest points are
/// of a point to a mesh, and its Hausdorff distances are of the farthest points. It takes only
/// meshes whose faces meet in twos along their edges.
[[nodiscard]] Library cgal_library();

}  // namespace ist::bench
