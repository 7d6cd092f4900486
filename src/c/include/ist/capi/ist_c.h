#ifndef IST_CAPI_IST_C_H
#define IST_CAPI_IST_C_H

/**
 * @file
 * IST for C, and for any language that calls C: collision queries between two rigid meshes, on a
 * 64-bit processor.
 *
 * Handles. A mesh, a tree, a query, a servo (ist_servo.h) and a world (ist_world.h) are opaque
 * handles, not addresses. One function creates each kind, and its ist_..._free releases it. A call
 * with a handle that was freed (until 2^32 later ones have used its slot), has another kind or
 * never existed returns an error code. At most 65,536 handles live at a time.
 *
 * Threads. Any thread may call any function. Meshes and trees are immutable; any number of threads
 * may share them. A query, a servo or a world serves one call at a time; a second, simultaneous
 * call returns IST_HANDLE_BUSY, except ist_servo_get_state. An object that is freed during a call
 * lives until the call returns.
 *
 * Errors. Functions that can fail return an ist_status: IST_OK or an error code. After an error,
 * ist_last_error_message() gives the calling thread's cause and remedy. No C++ exception leaves the
 * library. A call that fails sets its outputs to zero, but for the contents of arrays.
 *
 * Structs that begin with `struct_size`: set it to sizeof and all other members to zero; a zero
 * member selects its default. A program compiled with an older header passes a shorter struct; the
 * missing members take their defaults. A longer struct is accepted if all members unknown to
 * this library are zero. A size below 16, above 4096 or not a multiple of 8 gives IST_STRUCT_SIZE.
 *
 * Poses are double[16] in column-major order: [0..2], [4..6] and [8..10] are the images of the x, y
 * and z axes, [12..14] is the translation, and [3], [7], [11], [15] are 0, 0, 0, 1. A query's pose
 * maps moving mesh coordinates to fixed mesh coordinates. A rotation within 1e-3 of orthonormal, by
 * the largest entry of |R^T R - I|, is projected to the nearest rotation; `rotation_error` in
 * results says how far it was. A pose that is farther off, is not finite, mirrors, or has a scale
 * that differs from 1 by more than 1e-5, gives IST_POSE_INVALID. Both meshes share a unit; trees
 * that name different ones are refused.
 *
 * Real time. Functions marked [real time] allocate no memory, wait for nothing and make no system
 * call. Two exceptions: in a library loaded by dlopen() a thread's first error may allocate memory
 * for its message; a call destroys an object whose handle another thread freed meanwhile.
 */

#include <stddef.h>
#include <stdint.h>

#include "ist/capi/ist_status.h"

#ifdef __cplusplus
extern "C" {
#endif

/** An immutable surface of triangles. */
typedef struct ist_mesh ist_mesh;

/** Creates a mesh from copies of 3 * vertex_count coordinates and 3 * triangle_count indices. The
 * vertices of a triangle run counter-clockwise, seen from outside. An array may be NULL if its
 * count is 0, but a mesh without triangles is an error.
 *
 * Errors: IST_MESH_EMPTY, IST_MESH_POINTS_ONLY; IST_MESH_NOT_FINITE and IST_MESH_BAD_INDEX, with
 * the first vertex or triangle in the message; IST_ARGUMENT_INVALID beyond 2^32 - 1 vertices or
 * triangles. Cost: 10 ns per vertex and triangle. */
IST_C_API ist_status ist_mesh_create(const double* vertices, size_t vertex_count,
                                     const uint32_t* triangles, size_t triangle_count,
                                     ist_mesh** mesh) IST_NOEXCEPT;
/** Creates a mesh from single-precision coordinates, by the rules of ist_mesh_create. */
IST_C_API ist_status ist_mesh_create_float(const float* vertices, size_t vertex_count,
                                           const uint32_t* triangles, size_t triangle_count,
                                           ist_mesh** mesh) IST_NOEXCEPT;

/** Reads an STL, PLY, OBJ, OFF or VTK PolyData file, or by the program ist-import a glTF, 3MF,
 * COLLADA, FBX, X3D, AMF, 3DS, AC3D or LightWave file, and merges vertices with equal coordinates.
 * Errors: IST_FILE_UNREADABLE, IST_NOT_A_MESH and all IST_MESH_... codes; the message names the
 * file and the position in it; IST_CANCELLED. `progress` may be NULL. Cost: about 50 ms for
 * 100,000 triangles. */
IST_C_API ist_status ist_mesh_read(const char* path, const ist_progress* progress,
                                   ist_mesh** mesh) IST_NOEXCEPT;

/** Gives the numbers of vertices and triangles, for ist_mesh_copy. Cost: 1 us. */
IST_C_API ist_status ist_mesh_get_size(const ist_mesh* mesh, uint64_t* vertices,
                                       uint64_t* triangles) IST_NOEXCEPT;

/** The counts of a mesh's elements and defects. */
typedef struct ist_mesh_info {
  size_t struct_size;            /**< the size of this struct, bytes */
  uint64_t vertices,             /**< vertices that the mesh holds, used or not */
      triangles;                 /**< triangles, degenerate ones included */
  uint64_t boundary_edges;       /**< edges of one triangle only */
  uint64_t non_manifold_edges;   /**< edges of more than two triangles */
  uint64_t degenerate_triangles; /**< triangles with two equal indices or zero area */
  uint64_t components;           /**< parts connected by vertices */
  int32_t closed;                /**< 1: every edge belongs to exactly two triangles */
  int32_t consistent;            /**< 1: neighbours traverse each edge in opposite directions */
  double box_min[3],             /**< least coordinates of all vertices, mesh units */
      box_max[3];                /**< greatest coordinates */
  double signed_volume; /**< mesh units^3, positive outward; unreliable where open or above 1e100 */
  uint64_t self_intersections; /**< pairs of triangles that meet beyond what they share */
} ist_mesh_info;

/** Gives the size and the defects of a mesh. `progress` may be NULL. Errors: IST_CANCELLED. Cost:
 * about 150 ms for 100,000 triangles. */
IST_C_API ist_status ist_mesh_get_info(const ist_mesh* mesh, const ist_progress* progress,
                                       ist_mesh_info* info) IST_NOEXCEPT;

/** Copies the first `vertex_capacity` vertices, 3 coordinates each, and the first
 * `triangle_capacity` triangles, 3 indices each, in the order of the indices in answers. An array
 * may be NULL if its capacity is 0. Cost: 1 ns per number. */
IST_C_API ist_status ist_mesh_copy(const ist_mesh* mesh, double* vertices, size_t vertex_capacity,
                                   uint32_t* triangles, size_t triangle_capacity) IST_NOEXCEPT;

/** Frees a mesh. Every ..._free accepts NULL; a second call returns IST_HANDLE_FREED. */
IST_C_API ist_status ist_mesh_free(ist_mesh* mesh) IST_NOEXCEPT;

/** An immutable sphere tree: a body prepared for queries. */
typedef struct ist_tree ist_tree;

/** The bounds of tree nodes, from loose to tight. A tree with one kind has all looser kinds too. */
enum {
  IST_SPHERES_DEFAULT = 0, /**< for a tree: slabs; for a query: the tightest in both trees */
  IST_SPHERES_SIMPLE = 1,  /**< spheres around the nodes' cubes */
  IST_SPHERES_TABLE = 2,   /**< spheres around the children's cubes, by lookup table */
  IST_SPHERES_TIGHT = 3,   /**< spheres around the triangles in the cubes */
  IST_SPHERES_SLAB = 4     /**< tight spheres, cut by thin slabs */
};

/** The directions of the patient that a mesh's axes point to. 3D Slicer writes SPACE=RAS or
 * SPACE=LPS into its files. A half turn about z leads from one frame to the other. A query refuses
 * two trees of different known frames with IST_ARGUMENT_INVALID, as a world and
 * ist_tree_distance_map do. */
enum {
  IST_FRAME_UNKNOWN = 0, /**< the file does not say */
  IST_FRAME_RAS = 1,     /**< +x right, +y front, +z up */
  IST_FRAME_LPS = 2      /**< +x left, +y back, +z up */
};

/** How a tree is built. */
typedef struct ist_build_options {
  size_t struct_size;     /**< the size of this struct, bytes */
  double voxel_size;      /**< edge of a voxel, mesh units; 0: no voxels, which only leaf pairs and
                             contacts need */
  int32_t spheres;        /**< IST_SPHERES_...: the bounds of voxels to save */
  int32_t drop_triangles; /**< 1: keep no triangles: no exact answers; 0 without voxels */
  int32_t proximity;      /**< 1: add the voxels near the outside, for a scene's proximity effect */
  int32_t no_weld;        /**< 1: vertices at one position stay apart; 0: they count as one */
  uint64_t max_memory;    /**< memory limit, bytes; default 4 GiB */
  const ist_progress* progress; /**< follows the build; may be NULL */
  int32_t frame;    /**< IST_FRAME_...: a mesh of the other known frame is turned into it */
  int32_t reserved; /**< 0 */
} ist_build_options;

/** Builds a tree, and turns a closed mesh outward where it is inside out. The mesh may be freed
 * afterwards. `options` may be NULL. The call uses all cores. Errors: IST_VOXEL_SIZE_INVALID,
 * IST_VOXEL_SIZE_TOO_SMALL, IST_ARGUMENT_INVALID for drop_triangles or proximity without voxels,
 * IST_MESH_EXTENT, IST_MEMORY_LIMIT, IST_CANCELLED. Cost: 2.5 s for 1.7 million voxels on two
 * cores, 0.2 s for the same 107,000 triangles without voxels. */
IST_C_API ist_status ist_tree_build(const ist_mesh* mesh, const ist_build_options* options,
                                    ist_tree** tree) IST_NOEXCEPT;

/** Reads a tree file and checks every number in it. `progress` may be NULL. Cost: 1 ns per byte.
 * Errors: IST_FILE_UNREADABLE, IST_NOT_A_TREE, IST_TREE_VERSION, IST_TREE_TRUNCATED,
 * IST_TREE_CORRUPT, IST_CANCELLED. */
IST_C_API ist_status ist_tree_load(const char* path, const ist_progress* progress,
                                   ist_tree** tree) IST_NOEXCEPT;

/** Writes a tree file completely or not at all. `progress` may be NULL. Errors:
 * IST_FILE_UNWRITABLE; IST_CANCELLED, and an older file stays. A file that already waits for the
 * disk is completed, with IST_OK. Cost: disk time. */
IST_C_API ist_status ist_tree_save(const ist_tree* tree, const char* path,
                                   const ist_progress* progress) IST_NOEXCEPT;

/** Gives the size of the tree's file, and writes it to `memory` if `capacity` is no less. `memory`
 * may be NULL if `capacity` is 0; `progress` may be NULL. Errors: IST_CANCELLED. Cost: 1 ns per
 * byte. */
IST_C_API ist_status ist_tree_to_memory(const ist_tree* tree, void* memory, size_t capacity,
                                        const ist_progress* progress, uint64_t* bytes) IST_NOEXCEPT;

/** Reads a tree from its file's bytes, with the errors of ist_tree_load. The bytes may go
 * afterwards. `progress` may be NULL. */
IST_C_API ist_status ist_tree_from_memory(const void* memory, size_t bytes,
                                          const ist_progress* progress,
                                          ist_tree** tree) IST_NOEXCEPT;

/** Creates a mesh from the triangles that a tree keeps, turned outward. Errors:
 * IST_TRIANGLES_MISSING. Cost: 10 ns per vertex and triangle. */
IST_C_API ist_status ist_tree_get_mesh(const ist_tree* tree, ist_mesh** mesh) IST_NOEXCEPT;

/** The properties of a tree; lengths in mesh units. */
typedef struct ist_tree_info {
  size_t struct_size;         /**< the size of this struct, bytes */
  double voxel_size;          /**< edge of a voxel; 0: the tree lacks voxels */
  uint64_t leaves;            /**< voxels on the surface; 0 without voxels */
  uint64_t triangles;         /**< triangles kept */
  uint64_t bytes;             /**< memory in use */
  int32_t depth;              /**< levels above the leaves; 0 without voxels */
  int32_t spheres;            /**< IST_SPHERES_...: the tightest bounds; 0 without voxels */
  int32_t has_triangles;      /**< 1: the tree keeps its triangles */
  int32_t has_proximity;      /**< 1: the tree has the voxels near the outside */
  int32_t outward;            /**< 1: the mesh is closed and consistent, outside is known */
  int32_t unit;               /**< of lengths: 0 unknown, 1 mm, 2 m, 3 inch, 4 micrometre */
  double origin[3];           /**< of the tree's frame, mesh coordinates: the root cube's centre, or
                                 without voxels the middle of the triangles' box */
  double bounding_radius;     /**< around the origin; contains every sphere and triangle */
  double largest_leaf_radius; /**< of the tightest spheres; 0 without voxels */
  int32_t frame;              /**< IST_FRAME_... of the coordinates, as the mesh's file says it */
  int32_t prepared_for_depth; /**< 1: the tree has outer balls: ist_tree_prepare_depth() */
} ist_tree_info;

/** Gives the properties of a tree. Cost: 1 us. */
IST_C_API ist_status ist_tree_get_info(const ist_tree* tree, ist_tree_info* info) IST_NOEXCEPT;

/** Gives the number of pairs of triangles that meet beyond the corners and edges that they share.
 * Triangles that only touch count. Errors: IST_TRIANGLES_MISSING. Cost: the first call for a tree
 * takes 1.2 us per triangle. */
IST_C_API ist_status ist_tree_self_intersections(const ist_tree* tree,
                                                 uint64_t* pairs) IST_NOEXCEPT;

/** Makes the outer balls of a body. If both bodies of a query have them, ist_query_penetration()
 * takes a 20th of the time. ist_tree_save() saves them. A tree that has them stays as it is. Do not
 * call it within a tick. `max_memory`: bytes of the balls, 0 for 1 GiB; a body needs at most 28 a
 * triangle. `progress` may be NULL. Errors: IST_TRIANGLES_MISSING, IST_MEMORY_LIMIT, IST_CANCELLED.
 * Cost: 9 to 18 us a triangle, on all cores. */
IST_C_API ist_status ist_tree_prepare_depth(const ist_tree* tree, uint64_t max_memory,
                                            const ist_progress* progress) IST_NOEXCEPT;

/** Copies the centres of the first `capacity` leaves, 3 mesh coordinates each, in the order of the
 * indices in leaf pairs. A leaf is a cube of edge voxel_size. None without voxels. `centres` may be
 * NULL if `capacity` is 0. Cost: 20 ns per leaf. */
IST_C_API ist_status ist_tree_copy_leaf_centres(const ist_tree* tree, double* centres,
                                                size_t capacity) IST_NOEXCEPT;

/** Frees a tree. Queries of the tree keep it alive. */
IST_C_API ist_status ist_tree_free(ist_tree* tree) IST_NOEXCEPT;

/** Two trees and the working memory of their queries. Each thread needs a query of its own. */
typedef struct ist_query ist_query;

/** How a query searches, and the memory that it reserves. */
typedef struct ist_query_options {
  size_t struct_size;      /**< the size of this struct, bytes */
  int32_t spheres;         /**< IST_SPHERES_... */
  int32_t workers;         /**< 1 (default) or 2: a resident thread helps */
  int64_t period_ns;       /**< with two workers: interval of queries; default 1 ms, -1: no pause */
  uint64_t frontier_pairs; /**< most node pairs of a level, 12 bytes each; default 2^16, to 2^26 */
  uint64_t reserved;       /**< passed over; was a capacity that exact questions do without */
  int64_t contacts;        /**< most contacts, up to 4096; default 32; -1: none, 3 MB less memory */
  const char* target;      /**< instruction set, such as "avx2"; default: the best. Same answers */
  double margin;           /**< distance at which springs begin, in mean voxel sizes, 0 to 2;
                              default 0: where surfaces meet, to within 0.25 with slabs */
  uint64_t front_pairs;    /**< most leaf pairs kept in slow motion, 224 bytes each, to 2^26;
                              0: none */
  uint64_t near_pairs;     /**< most near pairs of triangles kept in slow motion, 390 bytes each, to
                              2^26; 0: none. 2,048 is a good number */
} ist_query_options;

/** Creates a query and reserves all its memory. `options` may be NULL. Both trees may be the same,
 * and may be freed afterwards. Errors: IST_POLICY_MISSING, also for spheres of a tree without
 * voxels; IST_VOXELS_MISSING if one tree lacks voxels and the other no triangles;
 * IST_TARGET_MISSING, IST_MEMORY_LIMIT, IST_OUT_OF_MEMORY, IST_ARGUMENT_INVALID, also for trees of
 * different units or different frames. Cost: a few ms. */
IST_C_API ist_status ist_query_create(const ist_tree* fixed, const ist_tree* moving,
                                      const ist_query_options* options,
                                      ist_query** query) IST_NOEXCEPT;

/** The properties of a query. */
typedef struct ist_query_info {
  size_t struct_size;    /**< the size of this struct, bytes */
  uint64_t bytes;        /**< memory reserved */
  uint64_t contacts;     /**< most contacts; 0: no contacts, as without voxels */
  int32_t spheres;       /**< IST_SPHERES_...: the bounds in use; 0 without voxels */
  int32_t workers;       /**< threads that search, 1 or 2 */
  int32_t has_triangles; /**< 1: both trees have triangles */
  int32_t reserved;      /**< zero */
  char target[16];       /**< instruction set in use */
} ist_query_info;

/** Gives the properties of a query. [real time] */
IST_C_API ist_status ist_query_get_info(ist_query* query, ist_query_info* info) IST_NOEXCEPT;

/** Two leaves with overlapping bounds, by their indices in the two trees. */
typedef struct IST_MAY_ALIAS ist_leaf_pair {
  uint32_t fixed, /**< leaf of the fixed tree */
      moving;     /**< leaf of the moving tree */
} ist_leaf_pair;

/** How an answer was found. */
enum {
  IST_FOUND_FRESH = 0, /**< by a search */
  IST_FOUND_KEPT = 1,  /**< among the leaf pairs kept from earlier poses */
  IST_FOUND_CLEAR = 2  /**< by the roots, or a clearance found at an earlier pose */
};

/** The answer of ist_query_leaf_pairs and ist_query_contacts; lengths in mesh units. */
typedef struct ist_query_result {
  size_t struct_size;    /**< the size of this struct, bytes */
  uint64_t leaf_pairs;   /**< all leaf pairs found, in the array or not */
  uint64_t contacts;     /**< all contacts, in the array or not; of ist_query_contacts alone */
  uint64_t written;      /**< valid elements of the array; later elements may be overwritten */
  uint64_t sphere_tests; /**< pairs of bounds tested */
  int32_t complete;  /**< 1: the search reached the end. 0: the budget ended it; then bodies without
                        leaf pairs may still overlap, and contacts give no valid force */
  int32_t truncated; /**< 1: the array was too short and holds the first elements */
  int32_t level;     /**< levels above the leaves at which the search ended */
  int32_t distance_known; /**< 1: the distance between the surfaces is in [lower, upper] */
  double distance_lower,  /**< no pair of surface points is nearer; 0 where unknown */
      distance_upper;     /**< some pair is no farther apart; 0 where unknown */
  double resolution;      /**< greatest distance between the surfaces in a leaf pair */
  int32_t found;          /**< IST_FOUND_...; only sphere_tests and the distance depend on it */
  int32_t reserved;       /**< zero */
  double rotation_error;  /**< of the given pose: the largest entry of |R^T R - I| */
} ist_query_result;

/** The limits of one query, with one contract for every function that takes them. A search never
 * makes more tests than allowed, but for the test of the roots. With a limit of time it reads the
 * clock every 500 tests, 512 leaf pairs or 2,048 kept ones. A limit of tests alone gives the same
 * answer in every run, and keeps nothing from pose to pose. */
typedef struct ist_budget {
  size_t struct_size;   /**< the size of this struct, bytes */
  uint64_t tests;       /**< most pairs of bounds to test; 0: no limit */
  uint64_t nanoseconds; /**< most time from the start of the call; 0: no limit */
} ist_budget;

/** Finds all pairs of leaves with overlapping bounds, sorted by fixed and then by moving leaf.
 * `pairs` may be NULL if `capacity` is 0, to count; `budget` may be NULL: no limit. With a
 * budget the distance is known. Errors: IST_POSE_INVALID; IST_VOXELS_MISSING. Cost: 1 to 3 ns per
 * test. [real time] */
IST_C_API ist_status ist_query_leaf_pairs(ist_query* query, const double pose[16],
                                          const ist_budget* budget, ist_leaf_pair* pairs,
                                          size_t capacity, ist_query_result* result) IST_NOEXCEPT;

/** A contact point of the two surfaces, fixed mesh coordinates. */
typedef struct ist_contact {
  double position[3]; /**< half way between the surfaces */
  double normal[3];   /**< of unit length, from the fixed body to the moving body */
  double depth;       /**< overlap along the normal, negative where apart; at most one voxel */
  double weight;      /**< an area, mesh units^2; falls to 0 where a contact ends */
} ist_contact;

/** Sums over all leaf pairs, for forces on the moving body, of meshes in mm. A pair has weight w,
 * normal n, depth d and position p. Springs begin at the margin m of the query's options, mesh
 * units. */
typedef struct ist_contact_sums {
  size_t struct_size;        /**< the size of this struct, bytes */
  uint64_t pairs;            /**< leaf pairs with a weight above 0 */
  double weight;             /**< sum of w, mm^2 */
  double pressure_force[3];  /**< sum of w n, mm^2 */
  double pressure_torque[3]; /**< sum of p x w n, mm^3 */
  double spring_force[3];    /**< sum of w (d + m) n, mm^3 */
  double spring_torque[3];   /**< sum of p x w (d + m) n, mm^4 */
  double about[3];           /**< reference point of the torques, fixed mesh coordinates */
} ist_contact_sums;

/** Reduces all leaf pairs to a few contacts and to sums. `contacts` may be NULL where `capacity` is
 * 0; `sums` may be NULL; `budget` may be NULL: no limit. If the budget ends it, there are no
 * contacts and the sums make no force. Errors: IST_POSE_INVALID; IST_VOXELS_MISSING;
 * IST_NOT_PREPARED if options->contacts was -1. Cost: ist_query_leaf_pairs plus 10 to 15 ns per
 * pair. [real time] */
IST_C_API ist_status ist_query_contacts(ist_query* query, const double pose[16],
                                        const ist_budget* budget, ist_contact* contacts,
                                        size_t capacity, ist_contact_sums* sums,
                                        ist_query_result* result) IST_NOEXCEPT;

/** Gives the wrench of springs on the moving body, about sums->about. A stiffness in N/mm^3 and
 * meshes in mm give N and N mm. IST_ARGUMENT_INVALID for one that is not finite. [real time] */
IST_C_API ist_status ist_contact_sums_wrench(const ist_contact_sums* sums, double stiffness,
                                             double force[3], double torque[3]) IST_NOEXCEPT;

/** The answer of ist_query_distance; lengths in mesh units. */
typedef struct ist_distance_result {
  size_t struct_size;      /**< the size of this struct, bytes */
  double lower,            /**< the distance between the surfaces is no less */
      upper;               /**< and no more */
  uint64_t sphere_tests;   /**< tests made, as ist_budget counts them */
  int32_t complete;        /**< 1: the interval is no wider than the tolerance */
  int32_t nearest_known;   /**< 1: the members below hold the nearest triangles that were found */
  double narrowest;        /**< the width that rounding allows at this pose, or voxels if a tree has
                              no triangles: a smaller tolerance may be missed */
  double rotation_error;   /**< of the given pose: the largest entry of |R^T R - I| */
  double nearest_fixed[3], /**< the fixed triangle's closest point, fixed mesh coordinates */
      nearest_moving[3];   /**< the moving triangle's; a common point if they intersect */
  double direction[3];     /**< of unit length, from the fixed point to the moving one; 0 if
                              the triangles intersect */
  uint32_t nearest_triangles[2]; /**< of the fixed and of the moving mesh */
} ist_distance_result;

/** Bounds the distance between the surfaces by an interval no wider than `tolerance`, or by
 * `narrowest` if that is more. Finds triangles whose distance lies in the interval, if both trees
 * have triangles. `budget` as for leaf pairs. Errors: IST_POSE_INVALID, IST_ARGUMENT_INVALID.
 * Cost: 0.02 to 0.7 ms for jaws. [real time] */
IST_C_API ist_status ist_query_distance(ist_query* query, const double pose[16], double tolerance,
                                        const ist_budget* budget,
                                        ist_distance_result* result) IST_NOEXCEPT;

/** The questions of ist_query_rows, to be added up, and of ist_world_ask, one at a time. */
enum {
  IST_ASK_NEAR = 0,           /**< ist_world_ask alone: lists the pairs of bodies that are near */
  IST_ASK_INTERSECTS = 1,     /**< ist_query_intersects */
  IST_ASK_LEAF_PAIRS = 2,     /**< ist_query_leaf_pairs; ist_query_rows counts them */
  IST_ASK_DISTANCE = 4,       /**< ist_query_distance, to the tolerance */
  IST_ASK_CONTACTS = 8,       /**< ist_query_contacts; rows have ist_contact_sums_wrench */
  IST_ASK_PENETRATION = 16,   /**< ist_query_rows alone: ist_query_penetration, to the tolerance */
  IST_ASK_TRIANGLE_PAIRS = 32 /**< ist_world_ask alone: ist_query_triangle_pairs */
};

/** The answer of ist_query_intersects. */
enum {
  IST_ANSWER_UNKNOWN = 0, /**< no answer: after an error, or the budget ended the search */
  IST_ANSWER_NO = 1,      /**< the surfaces are apart; one body may lie inside the other */
  IST_ANSWER_NEAR = 2,    /**< bounds of leaves overlap, and a tree has no triangles to decide by */
  IST_ANSWER_YES = 3      /**< triangles have a point in common, exactly */
};

/** Decides whether the bodies intersect: an IST_ANSWER_... Errors: IST_POSE_INVALID. [real time] */
IST_C_API ist_status ist_query_intersects(ist_query* query, const double pose[16],
                                          const ist_budget* budget, int32_t* answer) IST_NOEXCEPT;

/** Gives how far the rotation R of a pose is from orthonormal: the largest entry of |R^T R - I|.
 * Each question answers at the nearest rotation. INFINITY if a number is not finite. [real time] */
IST_C_API ist_status ist_rotation_error(const double pose[16], double* error) IST_NOEXCEPT;

/** Two triangles with a common point, by index. */
typedef struct IST_MAY_ALIAS ist_triangle_pair {
  uint32_t fixed, /**< triangle of the fixed mesh */
      moving;     /**< triangle of the moving mesh */
} ist_triangle_pair;

/** The answer of ist_query_triangle_pairs. */
typedef struct ist_triangle_pairs_result {
  size_t struct_size;    /**< the size of this struct, bytes */
  uint64_t pairs;        /**< all pairs found, in the array or not */
  uint64_t written;      /**< valid elements of the array */
  uint64_t sphere_tests; /**< tests made, as ist_budget counts them */
  int32_t truncated;     /**< 1: the array was too short and holds the first pairs */
  int32_t complete;      /**< 0: the budget ended the search; there may be more pairs */
  double rotation_error; /**< of the given pose: the largest entry of |R^T R - I| */
} ist_triangle_pairs_result;

/** Finds all pairs of triangles with a common point, exactly, sorted as leaf pairs are. Errors:
 * IST_POSE_INVALID; IST_TRIANGLES_MISSING. Cost: 0.1 to 0.2 us per pair. [real time] */
IST_C_API ist_status ist_query_triangle_pairs(ist_query* query, const double pose[16],
                                              const ist_budget* budget, ist_triangle_pair* pairs,
                                              size_t capacity,
                                              ist_triangle_pairs_result* result) IST_NOEXCEPT;

/** A part of a triangle. */
enum {
  IST_PART_CORNER0 = 0, /**< the first corner */
  IST_PART_CORNER1 = 1, /**< the second corner */
  IST_PART_CORNER2 = 2, /**< the third corner */
  IST_PART_EDGE0 = 3,   /**< the edge from the first corner to the second */
  IST_PART_EDGE1 = 4,   /**< the edge from the second corner to the third */
  IST_PART_EDGE2 = 5,   /**< the edge from the third corner to the first */
  IST_PART_FACE = 6     /**< the inside */
};

/** Closest points of two triangles, or of parts of them; fixed mesh coordinates. */
typedef struct IST_MAY_ALIAS ist_near_pair {
  uint32_t fixed,        /**< triangle of the fixed mesh */
      moving;            /**< triangle of the moving mesh */
  double distance;       /**< mesh units; 0 if the triangles intersect */
  double fixed_point[3], /**< on the fixed triangle */
      moving_point[3];   /**< on the moving one; a common point if the triangles intersect */
  double direction[3];   /**< of unit length, from the fixed point to the moving one; 0 if the
                            triangles intersect, or if the points are the same */
  int32_t fixed_part,    /**< IST_PART_...: the smallest part that holds the fixed point */
      moving_part;       /**< the smallest part that holds the moving point */
} ist_near_pair;

/** The answer of ist_query_near_pairs and ist_query_near_parts. */
typedef struct ist_near_pairs_result {
  size_t struct_size;    /**< the size of this struct, bytes */
  uint64_t pairs;        /**< all pairs found, in the array or not */
  uint64_t written;      /**< valid elements of the array */
  uint64_t sphere_tests; /**< tests made, as ist_budget counts them */
  int32_t truncated;     /**< 1: the array was too short and holds the nearest pairs */
  int32_t complete;      /**< 0: the search ended early; there may be more pairs */
  int32_t found;         /**< IST_FOUND_...; only sphere_tests depends on it */
  int32_t reserved;      /**< zero */
  double pad;            /**< no pair is farther apart than the margin and this, mesh units */
  double rotation_error; /**< of the given pose: the largest entry of |R^T R - I| */
} ist_near_pairs_result;

/** Finds all pairs of triangles within `margin` of each other, mesh units, with their closest
 * points, sorted by distance, then by fixed and by moving triangle. Triangles that intersect are
 * among them. `pairs` may be NULL if `capacity` is 0, to count; `budget` as for leaf pairs. Bodies
 * that are too far apart for float give a result that is not complete. Errors: IST_POSE_INVALID;
 * IST_TRIANGLES_MISSING; IST_ARGUMENT_INVALID for a margin that is negative, infinite or NaN. Cost:
 * 0.3 ms for jaws that touch and a margin of 0.06 mm, 0.3 us per near pair. [real time] */
IST_C_API ist_status ist_query_near_pairs(ist_query* query, const double pose[16], double margin,
                                          const ist_budget* budget, ist_near_pair* pairs,
                                          size_t capacity,
                                          ist_near_pairs_result* result) IST_NOEXCEPT;

/** The most pairs of parts that two triangles have. */
#define IST_MOST_NEAR_PARTS 15

/** Lists the parts of two triangles, by index, within `margin` of each other, sorted by distance:
 * each corner above the face of the other triangle, and the closest points of each two edges.
 * `parts` may be NULL if `capacity` is 0; IST_MOST_NEAR_PARTS is always enough. Errors: as
 * ist_query_near_pairs; IST_ARGUMENT_INVALID for an index out of range. Cost: 0.5 us. [real time]
 */
IST_C_API ist_status ist_query_near_parts(ist_query* query, const double pose[16], uint32_t fixed,
                                          uint32_t moving, double margin, ist_near_pair* parts,
                                          size_t capacity,
                                          ist_near_pairs_result* result) IST_NOEXCEPT;

/** Forgets what earlier poses left behind: next answers are those of a new query. [real time] */
IST_C_API ist_status ist_query_forget(ist_query* query) IST_NOEXCEPT;

/** Frees a query. */
IST_C_API ist_status ist_query_free(ist_query* query) IST_NOEXCEPT;

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* IST_CAPI_IST_C_H */
