#ifndef IST_CAPI_IST_H
#define IST_CAPI_IST_H

/*
 * IST for C, and for any language that calls C: where two rigid triangle meshes touch. For
 * processors of 64 bits.
 *
 * Handles. A mesh, a tree, a query and a servo (ist_servo.h) are handles: values that look like
 * pointers and are none. Each is given by one function, and given back by its ist_..._free. A
 * handle that was freed, is of another kind or is no handle gives a code. A freed one is recognised
 * until as many as 2^32 others had its place. At most 65,536 handles live at a time.
 *
 * Threads. Every function may be called from any thread. Meshes and trees never change, so several
 * threads may use one. A query or a servo serves one call at a time: another one meanwhile gets
 * IST_HANDLE_BUSY. A handle that one thread frees while another is in a call with it lives until
 * that call returns.
 *
 * Errors. What can fail returns an ist_status: IST_OK, or a code, and then the calling thread's
 * ist_last_error_message() says what and how to mend it. No C++ exception comes out. Where a call
 * fails, what it would have filled in is zero, but for contents of arrays.
 *
 * Structs that begin with `struct_size`: set it to sizeof, and all else to zero; a member that is
 * zero stands for its default. What was compiled with an older header passes a shorter struct, and
 * gets defaults; a longer one is taken where all that this library does not know is zero. A size
 * below 16, beyond 4096 or no multiple of 8 is IST_STRUCT_SIZE.
 *
 * Poses are double[16], column by column: [0..2], [4..6], [8..10] are where the x, y and z axis go,
 * [12..14] is the translation, and [3], [7], [11], [15] are 0, 0, 0, 1. A query's maps moving mesh
 * coordinates to fixed ones. One that is not finite, or farther than 1e-5 from a rigid motion, is
 * IST_POSE_INVALID. Lengths are in the meshes' unit, whatever it is, but the same for both.
 *
 * Real time. Functions marked [real time] allocate nothing, wait for nothing and make no system
 * call. Two exceptions: a thread's first error, where the library was loaded by dlopen(), may take
 * memory for the message; and a call during which another thread freed its handle gives back the
 * memory.
 */

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define IST_C_API __attribute__((visibility("default")))
#define IST_MAY_ALIAS __attribute__((may_alias))
#else
#define IST_C_API
#define IST_MAY_ALIAS
#endif
#ifdef __cplusplus
#define IST_NOEXCEPT noexcept
extern "C" {
#else
#define IST_NOEXCEPT
#endif

/* What this header describes. It grows where functions or members are added; where one changes its
 * meaning the library's SONAME changes. */
#define IST_ABI_VERSION 1

/* What a call came to. The numbers never change. */
typedef int32_t ist_status;
enum {
  IST_OK = 0,
  IST_NULL_ARGUMENT = 1,    /* a pointer is NULL that must not be */
  IST_STRUCT_SIZE = 2,      /* struct_size is none, or there is more in the struct than is known */
  IST_ARGUMENT_INVALID = 3, /* a number that has no sense there */
  IST_NOT_A_HANDLE = 4,     /* never given by this library */
  IST_HANDLE_KIND = 5,      /* a handle of something else */
  IST_HANDLE_FREED = 6,     /* freed before */
  IST_HANDLE_BUSY = 7,      /* a query or a servo that another thread is in a call with */
  IST_TOO_MANY_HANDLES = 8,
  IST_OUT_OF_MEMORY = 9,
  IST_SYSTEM_ERROR = 10,   /* the operating system refused */
  IST_INTERNAL_ERROR = 11, /* a bug of this library */
  IST_NOT_PREPARED = 12,   /* the query was made without what is asked for */
  IST_SERVO_FAULT = 13,    /* forces that are no numbers: nothing is felt */

  IST_FILE_UNREADABLE = 101,
  IST_FILE_UNWRITABLE = 102,
  IST_NOT_A_MESH = 103,           /* the content is in no mesh format that is read */
  IST_MESH_EMPTY = 104,           /* no triangle and no vertex */
  IST_MESH_POINTS_ONLY = 105,     /* no triangle */
  IST_MESH_TRUNCATED = 106,       /* the file ends before its content does */
  IST_MESH_BAD_INDEX = 107,       /* a triangle names a vertex that is not there */
  IST_MESH_NOT_FINITE = 108,      /* a vertex is NaN or infinite */
  IST_MESH_EXTENT = 109,          /* the largest extent is zero or outside [1e-12, 1e15] */
  IST_VOXEL_SIZE_INVALID = 110,   /* not positive and finite, or too large for the mesh */
  IST_VOXEL_SIZE_TOO_SMALL = 111, /* needs more than 2^16 voxels an axis */
  IST_MEMORY_LIMIT = 112,         /* would take more memory than is allowed */
  IST_NOT_A_TREE = 113,           /* not a tree file */
  IST_TREE_VERSION = 114,         /* a tree file of another version */
  IST_TREE_TRUNCATED = 115,
  IST_TREE_CORRUPT = 116,      /* checksum or content does not hold */
  IST_POLICY_MISSING = 117,    /* a tree was built without the spheres that are asked for */
  IST_TRIANGLES_MISSING = 118, /* a tree was built without its triangles */
  IST_TARGET_MISSING = 119,    /* this processor lacks the instruction set that is asked for */
  IST_POSE_INVALID = 120,      /* not a rigid motion */
  IST_INPUT_INVALID = 121,     /* a scene, or another file, whose content does not hold */
  IST_FIXED_POINT_RANGE = 122  /* a number that the hardware's format does not hold */
};

/* The IST_ABI_VERSION that the library was built with. [real time] */
IST_C_API uint32_t ist_abi_version(void) IST_NOEXCEPT;

/* The library's version, such as "0.1.0". [real time] */
IST_C_API const char* ist_version_string(void) IST_NOEXCEPT;

/* A code's own name, such as "mesh-truncated", for logs; "unknown" for a number that is no code.
 * [real time] */
IST_C_API const char* ist_status_name(ist_status status) IST_NOEXCEPT;

/* What went wrong in the calling thread's last call that failed: function, cause, remedy. Empty
 * before the first. At most 511 bytes; where it was longer, its beginning. Calls that succeed leave
 * it alone. The text is the thread's, and stands until its next failure. [real time] */
IST_C_API const char* ist_last_error_message(void) IST_NOEXCEPT;

/* A surface of triangles, as given: immutable. */
typedef struct ist_mesh ist_mesh;

/* A mesh of 3 * vertex_count coordinates and 3 * triangle_count indices; both are copied. Seen from
 * outside, a triangle's vertices turn counter clockwise. Arrays may be NULL where their count is 0,
 * but a mesh without triangles is an error.
 *
 * Errors: IST_MESH_EMPTY, IST_MESH_POINTS_ONLY, IST_MESH_NOT_FINITE and IST_MESH_BAD_INDEX, which
 * name the first place; IST_ARGUMENT_INVALID beyond 2^32 - 1 vertices or triangles. Cost: 10 ns a
 * vertex and triangle. */
IST_C_API ist_status ist_mesh_create(const double* vertices, size_t vertex_count,
                                     const uint32_t* triangles, size_t triangle_count,
                                     ist_mesh** mesh) IST_NOEXCEPT;
/* Likewise, of floats. */
IST_C_API ist_status ist_mesh_create_float(const float* vertices, size_t vertex_count,
                                           const uint32_t* triangles, size_t triangle_count,
                                           ist_mesh** mesh) IST_NOEXCEPT;

/* Reads STL (binary or text), PLY or OBJ; vertices in the same place become one.
 * Errors: IST_FILE_UNREADABLE, IST_NOT_A_MESH and those named IST_MESH_...; the message names the
 * file and the place in it. Cost: some 50 ms for 100,000 triangles. */
IST_C_API ist_status ist_mesh_read(const char* path, ist_mesh** mesh) IST_NOEXCEPT;

typedef struct ist_mesh_info {
  size_t struct_size;
  uint64_t vertices, triangles;
  uint64_t boundary_edges;       /* sides of one triangle only */
  uint64_t non_manifold_edges;   /* sides of more than two */
  uint64_t degenerate_triangles; /* two equal indices, or no area */
  uint64_t components;           /* parts that hang together by vertices */
  int32_t closed;                /* 1: every edge is the side of exactly two triangles */
  int32_t consistent;            /* 1: no two triangles run along an edge the same way */
  double box_min[3], box_max[3]; /* of all vertices */
  double signed_volume;          /* positive outward; little worth where not closed or > 1e100 */
} ist_mesh_info;

/* What a mesh holds, and what is wrong with it. Cost: some 40 ms for 100,000 triangles. */
IST_C_API ist_status ist_mesh_get_info(const ist_mesh* mesh, ist_mesh_info* info) IST_NOEXCEPT;

/* Copies vertices, 3 coordinates each, and triangles, 3 indices each, as they are counted in
 * answers: of each the first that there is room for. Either array may be NULL where its capacity,
 * in vertices or triangles, is 0. Cost: 1 ns a number. */
IST_C_API ist_status ist_mesh_copy(const ist_mesh* mesh, double* vertices, size_t vertex_capacity,
                                   uint32_t* triangles, size_t triangle_capacity) IST_NOEXCEPT;

/* NULL is fine, for this and for all other ..._free; a second time is IST_HANDLE_FREED. */
IST_C_API ist_status ist_mesh_free(ist_mesh* mesh) IST_NOEXCEPT;

/* A body made ready for queries: immutable. */
typedef struct ist_tree ist_tree;

/* How a node of a tree is bounded: what is farther down is tighter, and has what is above it. */
enum {
  IST_SPHERES_DEFAULT = 0, /* of a build: slabs; of a query: the tightest that both trees have */
  IST_SPHERES_SIMPLE = 1,  /* round the node's cube */
  IST_SPHERES_TABLE = 2,   /* round the children's cubes, by the lookup table */
  IST_SPHERES_TIGHT = 3,   /* round the triangles in the cube */
  IST_SPHERES_SLAB = 4     /* likewise, cut by a thin slab */
};

typedef struct ist_build_options {
  size_t struct_size;
  double voxel_size;      /* to be given; edge of a voxel */
  int32_t spheres;        /* IST_SPHERES_...: what to save */
  int32_t keep_triangles; /* 1: for exact answers */
  int32_t proximity;      /* 1: also the voxels near the outside, for a scene's proximity effect */
  int32_t reserved;       /* zero */
  uint64_t max_memory;    /* bytes; default 4 GiB */
} ist_build_options;

/* Builds a tree. The mesh may be freed then. What is closed and inside out is turned outward.
 * Errors: IST_VOXEL_SIZE_INVALID, IST_VOXEL_SIZE_TOO_SMALL, IST_MESH_EXTENT, IST_MEMORY_LIMIT.
 * Cost: on two cores, for 100,000 triangles and 1.7 million voxels, 2.5 s; all cores work. */
IST_C_API ist_status ist_tree_build(const ist_mesh* mesh, const ist_build_options* options,
                                    ist_tree** tree) IST_NOEXCEPT;

/* Reads a tree file. Every number in it is checked. Cost: 1 ns a byte.
 * Errors: IST_FILE_UNREADABLE, IST_NOT_A_TREE, IST_TREE_VERSION, IST_TREE_TRUNCATED,
 * IST_TREE_CORRUPT. */
IST_C_API ist_status ist_tree_load(const char* path, ist_tree** tree) IST_NOEXCEPT;

/* Writes a tree file, whole or not at all. Errors: IST_FILE_UNWRITABLE. Cost: bound by the disk. */
IST_C_API ist_status ist_tree_save(const ist_tree* tree, const char* path) IST_NOEXCEPT;

typedef struct ist_tree_info {
  size_t struct_size;
  double voxel_size;
  uint64_t leaves;            /* voxels that the surface meets */
  uint64_t triangles;         /* that were kept */
  uint64_t bytes;             /* in memory */
  int32_t depth;              /* levels above the leaves */
  int32_t spheres;            /* IST_SPHERES_...: the tightest that it has */
  int32_t has_triangles;      /* 1: where both trees have, answers may be exact */
  int32_t has_proximity;      /* 1: the voxels near the outside are there */
  int32_t outward;            /* 1: closed and consistent, so that outside is known */
  int32_t reserved;           /* zero */
  double origin[3];           /* of the tree's frame, mesh coordinates: the grid's centre */
  double reach;               /* no sphere reaches farther from there */
  double largest_leaf_radius; /* of the tightest spheres */
} ist_tree_info;

/* Cost: 1 us. */
IST_C_API ist_status ist_tree_get_info(const ist_tree* tree, ist_tree_info* info) IST_NOEXCEPT;

/* Copies the centres of leaves, 3 mesh coordinates each, in the order by which contacts count them:
 * the first `capacity` of them. A leaf is a cube of edge voxel_size. `centres` may be NULL where
 * `capacity` is 0. Cost: 20 ns a leaf. */
IST_C_API ist_status ist_tree_copy_leaf_centres(const ist_tree* tree, double* centres,
                                                size_t capacity) IST_NOEXCEPT;

/* Queries that use the tree keep it alive. */
IST_C_API ist_status ist_tree_free(ist_tree* tree) IST_NOEXCEPT;

/* Two trees, and memory to ask where they touch. One for each thread; trees are shared. */
typedef struct ist_query ist_query;

typedef struct ist_query_options {
  size_t struct_size;
  int32_t spheres;         /* IST_SPHERES_... */
  int32_t workers;         /* default 1; 2: a resident thread helps where it can */
  int64_t period_ns;       /* with two: how soon after a query the next is expected; default 1 ms,
                              -1: at once */
  uint64_t frontier_pairs; /* room for a level's pairs, 12 bytes each; default 2^16, up to 2^26 */
  uint64_t triangle_pairs; /* pairs of triangles told apart at a time, 20 to 36 bytes each; default
                              2^18, up to 2^26 */
  int64_t contact_points; /* at most so many are made; default 32, up to 4096; -1: none, which saves
                             some 4 MB and 5.4 bytes a leaf */
  const char* target;     /* instruction set, such as "avx2"; default the best. Same answers */
} ist_query_options;

/* `options` may be NULL. All memory is reserved here, and the first query is made. `fixed` and
 * `moving` may be the same tree, and may be freed then.
 * Errors: IST_POLICY_MISSING, IST_TARGET_MISSING, IST_MEMORY_LIMIT, IST_OUT_OF_MEMORY,
 * IST_ARGUMENT_INVALID. Cost: some ms. */
IST_C_API ist_status ist_query_create(const ist_tree* fixed, const ist_tree* moving,
                                      const ist_query_options* options,
                                      ist_query** query) IST_NOEXCEPT;

typedef struct ist_query_info {
  size_t struct_size;
  uint64_t bytes;          /* that it reserved */
  uint64_t contact_points; /* at most; 0 where it was made without */
  int32_t spheres;         /* IST_SPHERES_... that are tested */
  int32_t workers;
  int32_t exact;    /* 1: both trees have triangles */
  int32_t reserved; /* zero */
  char target[16];  /* instruction set */
} ist_query_info;

/* [real time] */
IST_C_API ist_status ist_query_get_info(ist_query* query, ist_query_info* info) IST_NOEXCEPT;

/* Two leaves whose spheres touch, by their indices in the two trees. */
typedef struct IST_MAY_ALIAS ist_contact {
  uint32_t fixed, moving;
} ist_contact;

typedef struct ist_query_result {
  size_t struct_size;
  uint64_t contacts; /* pairs of leaves that touch, in the array or not */
  uint64_t points;   /* contact points that were made of them, in the array or not */
  uint64_t written;  /* elements of the array that count: what is behind may be overwritten */
  uint64_t sphere_tests;
  int32_t complete;  /* 1: searched to the end. With a budget it may be 0: then an answer without
                        contacts does not say that nothing touches, and no force should come of
                        the points */
  int32_t truncated; /* 1: the array was too short, and holds the first ones */
  int32_t level;     /* how far above the leaves it ended; 0 at the leaves */
  int32_t gap_known; /* 1: the distance between the surfaces is in [gap_lower, gap_upper] */
  double gap_lower, gap_upper;
  double resolution; /* surfaces in a contact are no farther apart */
} ist_query_result;

/* What a query may spend. With sphere tests alone, the same answer every time. */
typedef struct ist_budget {
  size_t struct_size;
  uint64_t sphere_tests; /* 0: without limit */
  uint64_t nanoseconds;  /* from the call on; 0: without limit */
} ist_budget;

/* All pairs of leaves that touch, sorted by fixed and then by moving leaf. `contacts` may be NULL
 * where `capacity` is 0: then they are counted.
 * Errors: IST_POSE_INVALID. Cost: 1 to 3 ns a sphere test. [real time] */
IST_C_API ist_status ist_query_collide(ist_query* query, const double pose[16],
                                       ist_contact* contacts, size_t capacity,
                                       ist_query_result* result) IST_NOEXCEPT;
/* Likewise, until the budget is spent; the gap is always given. [real time] */
IST_C_API ist_status ist_query_collide_within(ist_query* query, const double pose[16],
                                              const ist_budget* budget, ist_contact* contacts,
                                              size_t capacity,
                                              ist_query_result* result) IST_NOEXCEPT;

/* A place where the bodies touch, fixed mesh coordinates. */
typedef struct ist_contact_point {
  double position[3]; /* half way between the surfaces */
  double normal[3];   /* of unit length, from the fixed body to the moving one */
  double depth;       /* overlap along the normal, negative where apart; at most a voxel */
  double weight;      /* an area; falls to 0 where a contact ends */
} ist_contact_point;

/* Over all pairs of leaves, none left out, of what acts on the moving body: what forces are made
 * of, for these do not jump. With w, n, d, p a pair's weight, normal, depth and position, and s the
 * mean voxel size. */
typedef struct ist_contact_sums {
  size_t struct_size;
  uint64_t pairs;            /* with a weight above 0 */
  double weight;             /* sum of w */
  double pressure_force[3];  /* sum of w n */
  double pressure_torque[3]; /* sum of p x w n */
  double spring_force[3];    /* sum of w (d + 2 s) n */
  double spring_torque[3];   /* sum of p x w (d + 2 s) n */
  double about[3];           /* torques are about this point, fixed mesh coordinates */
} ist_contact_sums;

/* Reduces all contacts to a few points and to sums. `points` may be NULL where `capacity` is 0, and
 * `sums` may be NULL.
 * Errors: IST_POSE_INVALID; IST_NOT_PREPARED where the query was made with contact_points -1. Cost:
 * that of ist_query_collide, and 50 to 120 ns a contact. [real time] */
IST_C_API ist_status ist_query_contact_points(ist_query* query, const double pose[16],
                                              ist_contact_point* points, size_t capacity,
                                              ist_contact_sums* sums,
                                              ist_query_result* result) IST_NOEXCEPT;
/* Likewise, until the budget is spent. [real time] */
IST_C_API ist_status ist_query_contact_points_within(ist_query* query, const double pose[16],
                                                     const ist_budget* budget,
                                                     ist_contact_point* points, size_t capacity,
                                                     ist_contact_sums* sums,
                                                     ist_query_result* result) IST_NOEXCEPT;

typedef struct ist_gap_result {
  size_t struct_size;
  double lower, upper; /* the distance between the surfaces is in between */
  uint64_t sphere_tests;
} ist_gap_result;

/* The distance between the surfaces, until the interval is no wider than `tolerance`, which is at
 * least 0, or without triangles until the leaves are reached.
 * Errors: IST_POSE_INVALID, IST_ARGUMENT_INVALID. Cost: 0.02 to 0.7 ms for jaws. [real time] */
IST_C_API ist_status ist_query_gap(ist_query* query, const double pose[16], double tolerance,
                                   ist_gap_result* result) IST_NOEXCEPT;

/* Whether bodies touch. */
enum {
  IST_TOUCH_UNKNOWN = 0, /* after an error */
  IST_TOUCH_NO = 1,
  IST_TOUCH_POSSIBLE = 2, /* leaves touch, and there are no triangles to ask */
  IST_TOUCH_YES = 3
};

/* Whether the bodies touch: ends at the first certain answer. Exact where both trees have
 * triangles. `touch` takes IST_TOUCH_... Errors: IST_POSE_INVALID. Cost: at
 * most that of ist_query_collide, or with triangles of ist_query_exact. [real time] */
IST_C_API ist_status ist_query_touches(ist_query* query, const double pose[16],
                                       int32_t* touch) IST_NOEXCEPT;

/* Two triangles that have a point in common, by their indices in the two meshes. */
typedef struct IST_MAY_ALIAS ist_triangle_pair {
  uint32_t fixed, moving;
} ist_triangle_pair;

typedef struct ist_exact_result {
  size_t struct_size;
  uint64_t pairs;   /* all that there are, in the array or not */
  uint64_t written; /* elements of the array that count */
  uint64_t sphere_tests;
  int32_t truncated; /* 1: the array was too short, and holds the first ones */
  int32_t reserved;  /* zero */
} ist_exact_result;

/* All pairs of triangles that have a point in common, exactly, sorted by fixed and then by moving
 * triangle. `pairs` may be NULL where `capacity` is 0.
 * Errors: IST_POSE_INVALID; IST_TRIANGLES_MISSING where a tree has none. Cost: some 1.2 us a pair.
 * [real time] */
IST_C_API ist_status ist_query_exact(ist_query* query, const double pose[16],
                                     ist_triangle_pair* pairs, size_t capacity,
                                     ist_exact_result* result) IST_NOEXCEPT;

/* The trees go with it where nothing else uses them. */
IST_C_API ist_status ist_query_free(ist_query* query) IST_NOEXCEPT;

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* IST_CAPI_IST_H */
