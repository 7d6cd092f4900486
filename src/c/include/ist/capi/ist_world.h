#ifndef IST_CAPI_IST_WORLD_H
#define IST_CAPI_IST_WORLD_H

/**
 * @file
 * Worlds: many bodies at poses, and the answers of all pairs that are near each other. The
 * conventions of ist_c.h apply. A pose of a body maps its mesh coordinates to the world's; all
 * bodies share a unit. A world serves one call at a time, as a query does.
 */

#include "ist/capi/ist_c.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Bodies at poses. */
typedef struct ist_world ist_world;

/** The most bodies of a world. */
#define IST_MOST_BODIES 4096u
/** The most threads of a world. */
#define IST_MOST_THREADS 16
/** A number of near pairs: all pairs of the world. */
#define IST_ALL_PAIRS UINT64_MAX

/** What a world asks, and the memory that it may reserve. */
typedef struct ist_world_options {
  size_t struct_size;             /**< the size of this struct, bytes */
  const ist_query_options* query; /**< of the query of all pairs; may be NULL; workers: 1. With
                                     contacts -1 a pair has the sums alone */
  double reach;                   /**< pairs whose root bounds are no farther apart are near too */
  uint64_t pair_caches; /**< most pairs that have a pair cache at a time, if query->front_pairs is
                           over 0; default 16 */
  uint64_t max_memory;  /**< memory limit, bytes; default 4 GiB */
  int32_t threads;      /**< threads that ask pairs, 1 to IST_MOST_THREADS; default 1. The answer
                           does not depend on it */
  int32_t reserved;     /**< zero */
} ist_world_options;

/** Creates a world without bodies. `options` may be NULL. Errors: IST_ARGUMENT_INVALID,
 * IST_TARGET_MISSING. */
IST_C_API ist_status ist_world_create(const ist_world_options* options,
                                      ist_world** world) IST_NOEXCEPT;

/** Adds a body; `body` takes its number, from 0 in the order of adding. `pose` and `name` may be
 * NULL: the body is then at its mesh's place, and messages name it by its number. The tree may be
 * freed afterwards. Questions then give IST_NOT_PREPARED until the next ist_world_reserve. Errors:
 * IST_POLICY_MISSING, IST_POSE_INVALID, IST_MEMORY_LIMIT; IST_ARGUMENT_INVALID beyond
 * IST_MOST_BODIES, and for a tree of another unit or frame than an earlier one. */
IST_C_API ist_status ist_world_add(ist_world* world, const ist_tree* tree, const double pose[16],
                                   const char* name, uint32_t* body) IST_NOEXCEPT;

/** Never looks at a pair of bodies again. Errors: IST_ARGUMENT_INVALID for a
 * body that is not there. */
IST_C_API ist_status ist_world_ignore(ist_world* world, uint32_t a, uint32_t b) IST_NOEXCEPT;

/** Gives the bytes that ist_world_reserve takes for so many near pairs. */
IST_C_API ist_status ist_world_bytes_needed(ist_world* world, uint64_t near_pairs,
                                            uint64_t* bytes) IST_NOEXCEPT;

/** Reserves memory for all bodies, and for `near_pairs` pairs that are near at a time, or
 * IST_ALL_PAIRS: at least for one. If more are near, an answer lists the first of them. Frees what
 * was reserved before, and forgets earlier questions. Errors: IST_MEMORY_LIMIT, IST_OUT_OF_MEMORY,
 * IST_ARGUMENT_INVALID; the world is then as it was. Cost: some milliseconds, and 1 us per pair. */
IST_C_API ist_status ist_world_reserve(ist_world* world, uint64_t near_pairs) IST_NOEXCEPT;

/** The size of a world. */
typedef struct ist_world_info {
  size_t struct_size; /**< the size of this struct, bytes */
  uint64_t bytes;     /**< memory that ist_world_reserve took */
  uint64_t bodies;    /**< bodies added */
} ist_world_info;

/** Gives the size of a world. [real time] */
IST_C_API ist_status ist_world_get_info(ist_world* world, ist_world_info* info) IST_NOEXCEPT;

/** Moves a body. IST_POSE_INVALID: the pairs of this body have that status until its next pose.
 * Errors: IST_ARGUMENT_INVALID for a body that is not there. [real time] */
IST_C_API ist_status ist_world_set_pose(ist_world* world, uint32_t body,
                                        const double pose[16]) IST_NOEXCEPT;

/** Gives the pose at which a pair is asked, from coordinates of `b` to coordinates of `a`. A query
 * of the two trees at this pose has the pair's answers. Errors: IST_POSE_INVALID if the pose of a
 * body is invalid. [real time] */
IST_C_API ist_status ist_world_get_pose(ist_world* world, uint32_t a, uint32_t b,
                                        double pose[16]) IST_NOEXCEPT;

/** A question to all pairs of bodies that are near each other. */
typedef struct ist_world_question {
  size_t struct_size; /**< the size of this struct, bytes */
  int32_t ask;        /**< one IST_ASK_... but IST_ASK_PENETRATION; 0, IST_ASK_NEAR, asks no pair */
  int32_t reserved;   /**< zero */
  double tolerance;   /**< of IST_ASK_DISTANCE: the interval is to be no wider */
  ist_leaf_pair* leaf_pairs; /**< of IST_ASK_LEAF_PAIRS: takes those of one pair of bodies after the
                                other; may be NULL if `leaf_capacity` is 0 */
  size_t leaf_capacity;      /**< its elements */
  ist_triangle_pair* triangles; /**< of IST_ASK_TRIANGLE_PAIRS: takes the pairs of triangles in the
                                   same way */
  size_t triangle_capacity;     /**< its elements */
} ist_world_question;

/** The answer of a pair of bodies that are near each other; lengths in mesh units. A member that
 * names questions is zero after the others. */
typedef struct ist_world_pair {
  uint32_t a,            /**< the body added first, which is the fixed one */
      b;                 /**< the other body, the moving one */
  ist_status status;     /**< IST_OK; IST_POSE_INVALID, IST_TRIANGLES_MISSING, IST_VOXELS_MISSING;
                            IST_NOT_PREPARED if no double holds the way between the bodies */
  int32_t answer;        /**< IST_ASK_INTERSECTS: IST_ANSWER_... */
  int32_t complete;      /**< 1: no budget ended the search; of a distance: it is narrow enough. Of
                            IST_ASK_NEAR 0 */
  int32_t truncated;     /**< 1: the array of leaf pairs or triangles was too short for all */
  double distance_lower, /**< the surfaces are no nearer, as far as this call tells */
      distance_upper;    /**< and no farther apart */
  uint64_t found;        /**< leaf pairs; of IST_ASK_TRIANGLE_PAIRS pairs of triangles */
  uint64_t first;        /**< the place of the pair's first element in that array */
  uint64_t written;      /**< valid elements there */
  uint64_t contacts;     /**< IST_ASK_CONTACTS: for ist_world_get_contacts */
  double resolution;     /**< greatest distance between the surfaces in a leaf pair; 0 unknown */
  double narrowest;      /**< IST_ASK_DISTANCE: as in ist_distance_result */
  uint64_t sphere_tests; /**< tests made, as ist_budget counts them */
  double rotation_error; /**< of the given poses, the larger one: as in ist_query_result */
  int32_t nearest_known; /**< IST_ASK_DISTANCE: 1: the members below hold the nearest triangles that
                            were found, as in ist_distance_result but in world coordinates */
  int32_t reserved;      /**< zero */
  double nearest_fixed[3], /**< the closest point on the triangle of `a` */
      nearest_moving[3];   /**< and on the triangle of `b` */
  double direction[3]; /**< of unit length, from the first point to the second; 0 if the points are
                          the same */
  uint32_t nearest_triangles[2]; /**< of the meshes of `a` and of `b` */
} ist_world_pair;

/** The answer of a world: one element for each pair that is near, sorted by `a` and then by `b`.
 * Any other pair is farther apart than the reach. */
typedef struct ist_world_result {
  size_t struct_size;    /**< the size of this struct, bytes */
  uint64_t near_pairs;   /**< all pairs that are near, in the array or not */
  uint64_t written;      /**< valid elements of the array */
  uint64_t sphere_tests; /**< of all pairs */
  int32_t complete;      /**< 1: every near pair was asked, and its answer is complete */
  int32_t truncated;     /**< 1: the array, or the room that was reserved, was too short for all
                            pairs. The answer of the others is unknown */
} ist_world_result;

/** Asks each pair of bodies that is near a question. IST_ASK_NEAR lists the pairs with the distance
 * of their root bounds; each other question is that function of a query. IST_ASK_CONTACTS keeps the
 * contacts in the world's memory: the sums of a pair make a force only if its `complete` is 1.
 * `pairs` may be NULL if `capacity` is 0. `budget` may be NULL; it is one for the whole call: pairs
 * are asked in their order until it is spent. The answer depends on the poses of now alone. Errors:
 * IST_NOT_PREPARED before ist_world_reserve; IST_ARGUMENT_INVALID. Cost: 20 ns per body, 0.5 us per
 * near pair, and what each pair's query costs. [real time] */
IST_C_API ist_status ist_world_ask(ist_world* world, const ist_world_question* question,
                                   const ist_budget* budget, ist_world_pair* pairs, size_t capacity,
                                   ist_world_result* result) IST_NOEXCEPT;

/** Copies the first `capacity` contacts of a pair, and its sums, from the last ist_world_ask for
 * IST_ASK_CONTACTS; `count` takes the number of all. Coordinates belong to the body added first.
 * Read the pair's ist_world_pair of that call first: it alone tells whether the answer is complete.
 * If its `complete` is 0, a budget ended the search. Contacts and sums are then of a part of the
 * leaf pairs: do not use them as a force. `contacts` may be NULL if `capacity` is 0; `sums` may be
 * NULL. Errors: IST_NOT_PREPARED if that call did not ask the pair. [real time] */
IST_C_API ist_status ist_world_get_contacts(ist_world* world, uint32_t a, uint32_t b,
                                            ist_contact* contacts, size_t capacity,
                                            ist_contact_sums* sums, uint64_t* count) IST_NOEXCEPT;

/** The least distance between any two bodies of a world; lengths in mesh units. */
typedef struct ist_least_distance {
  size_t struct_size;    /**< the size of this struct, bytes */
  double lower,          /**< no two bodies are nearer */
      upper;             /**< and two are no farther apart; both DBL_MAX where no pair counts */
  uint64_t sphere_tests; /**< of all pairs */
  int32_t complete;     /**< 1: the interval is no wider than the tolerance, and counts all pairs */
  int32_t pose_missing; /**< 1: a body's pose is invalid; the interval counts the others alone */
  int32_t nearest_known;   /**< 1: `a` and `b` have the least upper end */
  uint32_t a,              /**< the nearest pair's body that was added first */
      b;                   /**< and the other one */
  int32_t points_known;    /**< 1: the members below are those of ist_world_pair for `a` and `b` */
  double nearest_fixed[3], /**< the closest point on `a`, world coordinates */
      nearest_moving[3];   /**< and on `b` */
  double direction[3]; /**< of unit length, from the first point to the second; 0 if the points are
                          the same */
  uint32_t nearest_triangles[2]; /**< of the meshes of `a` and of `b` */
} ist_least_distance;

/** Bounds the least distance of all pairs that are not ignored, near or not, by an interval no
 * wider than `tolerance`, and gives the nearest points of the nearest pair if it was measured.
 * Pairs that were not reserved for count with their roots. Errors: IST_ARGUMENT_INVALID,
 * IST_NOT_PREPARED. [real time] */
IST_C_API ist_status ist_world_distance(ist_world* world, double tolerance,
                                        const ist_budget* budget,
                                        ist_least_distance* result) IST_NOEXCEPT;

/** Forgets what earlier poses left behind. [real time] */
IST_C_API ist_status ist_world_forget(ist_world* world) IST_NOEXCEPT;

/** Frees a world. */
IST_C_API ist_status ist_world_free(ist_world* world) IST_NOEXCEPT;

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* IST_CAPI_IST_WORLD_H */
