#pragma once

#include <memory>
#include <string>
#include <vector>

#include "peers/peer.h"

namespace ist::bench {

/// This library: both jaws at 0.2 mm with triangles and slabs, one worker. Candidates are asked of
/// it as pairs, which is more. Two contestants:
///  - `ist`: distance() to the tolerance;
///  - `ist_narrowest`: distance() alone, as narrow as rounding allows.
/// Its crowd is a World of one thread over a tree without voxels, with room for 8 near pairs a
/// body.
[[nodiscard]] Library ist_library();

/// `ist`, which is of ist_library(), on another instruction set, over the same trees: `ist_TARGET`.
/// Null where that is its own, or this processor lacks it.
[[nodiscard]] std::unique_ptr<Peer> ist_on(const Peer& ist, const std::string& target);

/// FCL: BVHModel<OBBRSS<double>>, which collides by oriented boxes and measures by swept
/// rectangles. Two contestants:
///  - `fcl`: collide() with one contact; collide() with all of them and enable_contact off, which
///    still lists both triangles of each and leaves out only their points and normals, so is the
///    fastest complete answer; distance() with the nearest points, which is exact: more than the
///    interval of 0.05 mm that is asked for, and as much as `ist_narrowest` gives.
///  - `fcl_within`: distance alone, and no closer than asked for: the same traversal, which passes
///    over what is at most 0.05 mm nearer than the nearest pair so far, so that the answer is the
///    interval from that pair's distance down to 0.05 mm less. DistanceRequest's abs_err does not
///    do that in 0.7: it is not passed on to a mesh, and does nothing there while rel_err is 0.
/// Its crowd is a DynamicAABBTreeCollisionManager, whose callback calls collide() with one contact.
/// Differences: its predicates are in double and not exact, so nothing is guaranteed where
/// triangles only touch or lie in one plane. Debian's library is built for any x86-64, without
/// FCL's own SSE code, and with assertions.
[[nodiscard]] Library fcl_library();

/// Embree: rtcCollide over two scenes of one user geometry each, in one thread; candidates are told
/// apart by their boxes and meet(), in double, so that all pairs are IST's. Embree cannot
/// be asked for a pose, so the moving mesh is moved, in vectors, and its hierarchy refitted. Three
/// contestants:
///  - `embree`: moves, refits, collides, tests triangles;
///  - `embree_no_refit`: the same, but moved and refitted before its time begins;
///  - `embree_boxes`: rtcCollide alone, which counts candidates and tests none; moved and refitted
///  before.
/// It cannot stop early and knows no distance between meshes.
[[nodiscard]] Library embree_library();

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

/// OpenVDB, as one who has voxels would ask it: a narrow-band level set of the fixed jaw
/// (meshToLevelSet, voxels of 0.2 mm, 3 to either side), read where points of the moving jaw's
/// surface are, as Voxmap-PointShell does. Each point that is in the box of the
/// band reads the voxel that it is in, and the eight
/// round it only where that could change the answer. Two contestants:
///  - `openvdb`: one point for each voxel of 0.2 mm that the surface goes through, in the order of
///    the grid's leaves;
///  - `openvdb_vertices`: the moving mesh's vertices alone.
/// Differences: it samples. What lies between points, or is smaller than a voxel, is missed; a
/// point inside the fixed jaw touches, though no triangles meet; distances beyond the band are not
/// known. It has no pairs of triangles. The fixed mesh must be closed.
[[nodiscard]] Library openvdb_library();

/// All that this program was built with. The first one is IST.
[[nodiscard]] std::vector<Library> libraries();

/// Names of those that it was built without, with a comma between them.
[[nodiscard]] std::string missing_libraries();

/// The compiler's option that compiles others than IST for this processor; empty where it has
/// none.
[[nodiscard]] std::string library_flags();

}  // namespace ist::bench
