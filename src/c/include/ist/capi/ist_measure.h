#ifndef IST_CAPI_IST_MEASURE_H
#define IST_CAPI_IST_MEASURE_H

/**
 * @file
 * Measures of two bodies that take milliseconds: signed distances of points, penetration depth,
 * motions that free bodies, first contact along a motion, occlusion; and answers at many poses. The
 * conventions of ist_c.h apply. Measures need trees with triangles (IST_TRIANGLES_MISSING),
 * allocate memory, and use all cores for many points. The first call for a tree takes 1.2 us per
 * triangle more.
 */

#include "ist/capi/ist_c.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The triangle of a point beyond the reach. */
#define IST_NO_TRIANGLE 0xFFFFFFFFu

/** A point and the surface of a body. */
typedef struct ist_surface_distance {
  double distance;   /**< negative inside; NaN beyond the reach */
  double closest[3]; /**< the surface's nearest point; NaN beyond the reach */
  uint32_t triangle; /**< the triangle that holds it, or IST_NO_TRIANGLE */
  int16_t is_signed; /**< 0: the nearest point is at an open border; the distance is positive */
  int16_t self_intersecting; /**< 1: the surface intersects itself (ist_tree_self_intersections) */
} ist_surface_distance;

/** Measures the distances of `count` points, 3 mesh coordinates each, from the surface of a tree.
 * Farther ones than `reach`, which may be INFINITY, are not looked for. Errors:
 * IST_ARGUMENT_INVALID for a point that is not finite or a reach that is not positive;
 * IST_CANCELLED. Cost: 0.9 us per point within reach and core. */
IST_C_API ist_status ist_tree_signed_distance(const ist_tree* tree, const double* points,
                                              size_t count, double reach,
                                              const ist_progress* progress,
                                              ist_surface_distance* distances) IST_NOEXCEPT;

/** Measures the distances of the vertices of `body` from the surface of `other`. `pose` maps
 * coordinates of `body` to those of `other`. Writes the first `capacity`; `vertices` takes the
 * number of all. Errors: IST_POSE_INVALID too, and IST_ARGUMENT_INVALID if the trees have different
 * units or different frames. */
IST_C_API ist_status ist_tree_distance_map(const ist_tree* body, const ist_tree* other,
                                           const double pose[16], double reach,
                                           const ist_progress* progress,
                                           ist_surface_distance* distances, size_t capacity,
                                           uint64_t* vertices) IST_NOEXCEPT;

/** Which body has no certain inside, being open or inconsistent. */
enum {
  IST_CLOSED = 0,           /**< both have one */
  IST_FIXED_NOT_CLOSED = 1, /**< the fixed body */
  IST_MOVING_NOT_CLOSED = 2 /**< the moving body */
};

/** The bodies whose surfaces intersect themselves, to be added up. */
enum {
  IST_FIXED_SELF_INTERSECTING = 1, /**< the fixed body's */
  IST_MOVING_SELF_INTERSECTING = 2 /**< the moving body's */
};

/** How deep two bodies are in each other; lengths in mesh units. */
typedef struct ist_penetration {
  size_t struct_size;        /**< the size of this struct, bytes */
  double lower,              /**< the depth is no less; 0: the bodies may be apart */
      upper;                 /**< and no more; 0: the bodies do not intersect */
  double point[3];           /**< of a surface, `lower` deep; fixed mesh coordinates */
  double direction[3];       /**< from there to the other surface's nearest point, of unit length */
  int32_t of_moving;         /**< 1: the point lies on the moving surface */
  uint32_t triangle;         /**< of that surface, the one that holds the point */
  int32_t complete;          /**< 1: the interval is no wider than the tolerance, or `narrowest` */
  int32_t not_closed;        /**< IST_CLOSED, or why the interval is NaN */
  double narrowest;          /**< no tolerance below this width can be reached at this pose */
  uint64_t points;           /**< points of which the distance was measured */
  int32_t self_intersecting; /**< the sum of IST_..._SELF_INTERSECTING */
  int32_t capped; /**< 1: the search ended after 4 million pieces of triangles; `complete` is 0 */
  double rotation_error; /**< of the given pose: the largest entry of |R^T R - I| */
} ist_penetration;

/** Bounds the depth of the deepest point of either surface inside the other body by an interval no
 * wider than `tolerance`. `last` may be NULL, or an earlier answer: from there the search goes on
 * in less time. Of `budget` the tests are points; if it ends the search, `complete` is 0 and the
 * interval wider. Without a budget, only `capped` ends it early. Errors: IST_POSE_INVALID,
 * IST_ARGUMENT_INVALID, IST_CANCELLED. Cost: 5 to 10 ms for jaws in occlusion. */
IST_C_API ist_status ist_query_penetration(ist_query* query, const double pose[16],
                                           double tolerance, const ist_penetration* last,
                                           const ist_budget* budget, const ist_progress* progress,
                                           ist_penetration* result) IST_NOEXCEPT;

/** Whether there is a motion that frees two bodies. */
enum {
  IST_ESCAPE_UNKNOWN = 0,    /**< after an error */
  IST_ESCAPE_FOUND = 1,      /**< the bodies are free after the motion */
  IST_ESCAPE_NOT_NEEDED = 2, /**< they are free at the given pose; the motion is the identity */
  IST_ESCAPE_NOT_FOUND = 3   /**< no motion was found that is no longer than `longest` */
};

/** The shortest motion found that frees two bodies; lengths in mesh units. The length of a motion
 * is the distance from a point's first to its last place, of the point that goes farthest. */
typedef struct ist_escape {
  size_t struct_size;    /**< the size of this struct, bytes */
  double motion[16];     /**< from places at the given pose to places at `pose`, fixed coordinates,
                            column by column; the identity without a motion */
  double pose[16];       /**< moving to fixed coordinates after the motion */
  double lower,          /**< no motion that frees the bodies is shorter; 0: a body is not closed */
      upper;             /**< the motion is no longer; infinity without a motion */
  double rotation_error; /**< of the given pose: as in ist_query_result */
  uint64_t verdicts;     /**< poses at which exact triangles were asked */
  int32_t status;        /**< IST_ESCAPE_... */
  int32_t reserved;      /**< zero */
} ist_escape;

/** Finds a short motion that frees two bodies: no triangles meet, and if a body is closed, the
 * other one is not inside it. A translation ends within `tolerance` of its last contact; 0 means a
 * 10,000th of the moving body's bounding radius. Motions longer than `longest`, which may be
 * INFINITY, are not looked for. The query forgets what earlier poses left. Errors:
 * IST_TRIANGLES_MISSING, IST_POSE_INVALID, IST_ARGUMENT_INVALID for a length that is negative or
 * NaN, IST_CANCELLED. Cost: 0.03 to 1 s for jaws. */
IST_C_API ist_status ist_query_escape(ist_query* query, const double pose[16], double tolerance,
                                      double longest, const ist_progress* progress,
                                      ist_escape* result) IST_NOEXCEPT;

/** A motion from the pose `from`: to the pose `to` by the screw that turns least; or, where `to` is
 * NULL, about the axis through `point` along `direction`, fixed mesh coordinates, by `angle`
 * radians and `along` mesh units. */
typedef struct ist_motion {
  size_t struct_size; /**< the size of this struct, bytes */
  const double* from; /**< 16 numbers */
  const double* to;   /**< 16 numbers, or NULL */
  double point[3],    /**< of the axis, fixed mesh coordinates */
      direction[3],   /**< of the axis, of any length but 0 */
      angle,          /**< of the turn, radians, counterclockwise seen against the direction */
      along;          /**< the way along the axis, mesh units */
} ist_motion;

/** How a motion goes. */
enum {
  IST_FIRST_UNKNOWN = 0, /**< after an error */
  IST_FIRST_CONTACT =
      1,              /**< at `upper` triangles intersect, before `lower` none do; see `passes` */
  IST_FIRST_NONE = 2, /**< none intersect on the whole motion */
  IST_FIRST_GRAZING = 3, /**< surfaces come within the tolerance, and were not found to meet */
  IST_FIRST_TOUCHES_AT_START = 4, /**< triangles intersect at the first pose */
  IST_FIRST_INSIDE_AT_START = 5,  /**< a body, or a part of it, lies inside the other */
  IST_FIRST_STOPPED = 6           /**< ended early: before `lower` none intersect */
};

/** The first contact along a motion; lengths in mesh units. */
typedef struct ist_first_contact {
  size_t struct_size;      /**< the size of this struct, bytes */
  double lower,            /**< the motion's parameter, 0 to 1, before which none intersect */
      upper;               /**< where the contact is at the latest; 1: none is known */
  double distance_lower,   /**< the surfaces at `lower` are no nearer: 0 */
      distance_upper;      /**< and no farther apart */
  int32_t outcome;         /**< IST_FIRST_... */
  int32_t grazed;          /**< 1: surfaces grazed before: the interval may be wider */
  int32_t triangles_known; /**< 1: the triangles intersect at `upper`, or pass through each other */
  uint32_t fixed,          /**< the fixed mesh's triangle, where known */
      moving;              /**< the moving mesh's */
  int32_t self_intersecting; /**< the sum of IST_..._SELF_INTERSECTING */
  double narrowest;          /**< the least tolerance that is reached here */
  uint64_t distances;        /**< lists of near pairs, and pairs that were measured */
  double rotation_error;     /**< of the given poses, the larger one: as in ist_query_result */
  double place_fixed[3],     /**< closest points before the contact, fixed mesh coordinates: of the
                                fixed surface */
      place_moving[3]; /**< of the moving surface; a common point if they touch at the start */
  double normal[3];    /**< of unit length, from the fixed to the moving body; 0 if they touch
                          at the start, or if rounding hides each distance */
  uint32_t place_triangles[2]; /**< of the fixed and of the moving mesh, that hold the points */
  int32_t place_known;         /**< 1: the place is known; 0: there was no contact */
  int32_t passes; /**< 1: triangles pass through each other between `lower` and `upper`,
                     and intersect at no pose that was tried */
} ist_first_contact;

/** Finds the first contact along a motion, and its place. From `lower` to `upper` no point of the
 * moving body goes farther than `tolerance`, mesh units. Of `budget` the tests are `distances`. The
 * query forgets what earlier poses left. Errors: IST_TRIANGLES_MISSING, IST_POSE_INVALID,
 * IST_ARGUMENT_INVALID, IST_CANCELLED. Cost: 0.4 to 4 ms for jaws. */
IST_C_API ist_status ist_query_first_contact(ist_query* query, const ist_motion* motion,
                                             double tolerance, const ist_budget* budget,
                                             const ist_progress* progress,
                                             ist_first_contact* result) IST_NOEXCEPT;

/** Freedoms of a body that settles, to be added up: ways of the load point along fixed axes, and
 * turns about it. */
enum {
  IST_HOLD_X = 1,      /**< the way along x */
  IST_HOLD_Y = 2,      /**< the way along y */
  IST_HOLD_Z = 4,      /**< the way along z */
  IST_HOLD_ROLL = 8,   /**< the turn about x */
  IST_HOLD_PITCH = 16, /**< the turn about y */
  IST_HOLD_YAW = 32    /**< the turn about z */
};

/** How a body settles. Zero means the default. Defaults in millimetres follow the unit of the
 * meshes. */
typedef struct ist_settle_options {
  size_t struct_size;   /**< the size of this struct, bytes */
  double closing[3];    /**< direction of the load, fixed axes; by default 0, 0, 1 */
  double load_point[3]; /**< on which the load acts, moving mesh coordinates, if `has_load_point` */
  int32_t has_load_point; /**< 1: the load point is given; 0: the middle of what touches first */
  int32_t held;           /**< the sum of IST_HOLD_..., freedoms that the body does not have */
  double largest_way,     /**< of the load point along each fixed axis, mesh units; 2 mm */
      largest_turn,       /**< each part of the rotation vector, radians; 3 degrees */
      reach;              /**< length of the motions that the proof speaks of; 50 um */
  uint64_t steps;         /**< the most steps; 600 */
} ist_settle_options;

/** What a settled pose is. */
enum {
  IST_SETTLE_UNKNOWN = 0,      /**< no proof that it rests, or an error */
  IST_SETTLE_RESTS = 1,        /**< free, balanced, and closing no farther than `remaining` */
  IST_SETTLE_RESTS_LEVEL = 2,  /**< the same, but nothing holds it in the directions of `level` */
  IST_SETTLE_LEFT_THE_BOX = 3, /**< it still closes at a border of the box */
  IST_SETTLE_STOPPED = 4,      /**< the steps ended the search; the pose is free */
  IST_SETTLE_NO_FREE_POSE = 5  /**< the bodies intersect, and no free pose was found nearby */
};

/** A place at which a settled body is held; fixed coordinates, mesh units. */
typedef struct ist_settle_contact {
  double point[3];  /**< on the fixed surface */
  double normal[3]; /**< of unit length, to the moving body */
  double force;     /**< as a part of the load */
  double gap;       /**< least distance of its triangles */
  uint32_t fixed,   /**< the fixed mesh's triangle of the nearest pair */
      moving;       /**< the moving mesh's */
  uint64_t pairs;   /**< pairs of triangles */
} ist_settle_contact;

/** Where a body settled, and the proof; lengths in mesh units. docs/settle.md explains the
 * numbers. */
typedef struct ist_settlement {
  size_t struct_size;    /**< the size of this struct, bytes */
  double pose[16];       /**< moving to fixed coordinates, column by column */
  double moved[6];       /**< way of the load point, and rotation vector, from the given pose */
  double closed;         /**< way of the load point along the load */
  double distance_lower, /**< the surfaces are no nearer */
      distance_upper;    /**< and no farther apart */
  double residual;       /**< what the forces leave of the load, as a part of it */
  double remaining,      /**< a motion of a size of `reach` closes no farther, to first order */
      second_order;      /**< and what curves may add */
  double margin;         /**< the load is so far inside the contacts' hull; negative outside */
  double level[36];      /**< `levels` directions of 6 numbers that nothing holds */
  double load_point[3];  /**< moving mesh coordinates */
  double radius,         /**< of gyration of the expected contacts about the load point */
      reach;             /**< length of motions of the proof */
  double rotation_error; /**< of the given pose: as in ist_query_result */
  uint64_t contacts;     /**< all places at which it is held */
  int32_t status;        /**< IST_SETTLE_... */
  int32_t is_free;       /**< 1: the pose was proven free */
  int32_t rocks;         /**< 1: the margin is negative, or the contacts lie on a line */
  int32_t levels;        /**< directions in `level` */
  int32_t load_guessed;  /**< 1: the load point is the default */
  int32_t unit_guessed;  /**< 1: no mesh tells its unit */
  int32_t opened;        /**< 1: the given pose was not free, and the body opened first */
  int32_t steps;         /**< of the search */
} ist_settlement;

/** Moves the moving body along a load until it rests on the fixed one, and proves that it rests.
 * Writes the first `capacity` contacts, the strongest first. `options` may be NULL. The query
 * forgets what earlier poses left. Errors: IST_TRIANGLES_MISSING, IST_POSE_INVALID,
 * IST_ARGUMENT_INVALID, IST_CANCELLED. Cost: some 0.3 s for jaws that close by 1 mm. */
IST_C_API ist_status ist_query_settle(ist_query* query, const double pose[16],
                                      const ist_settle_options* options,
                                      const ist_progress* progress, ist_settle_contact* contacts,
                                      size_t capacity, ist_settlement* result) IST_NOEXCEPT;

/** The questions about two jaws in a bite, mesh units; the defaults are made for millimetres. */
typedef struct ist_occlusion_options {
  size_t struct_size;   /**< the size of this struct, bytes */
  double reach;         /**< of the distance maps, NaN beyond; default 2 */
  double contact;       /**< surfaces no farther apart touch; default 0.1; -1: 0 */
  double least_area;    /**< of a region; default 0.01; -1: 0, all regions */
  double longest_edge;  /**< longer ones are split; default 0.2 */
  double foundation;    /**< of the shares; default 0.1; -1: 0 */
  double change;        /**< of the foundation; default 0.05; -1: 0 */
  const double* limits; /**< distances whose areas are measured; may be NULL */
  size_t limit_count;   /**< of `limits` */
} ist_occlusion_options;

/** A part of a surface that touches the other body; fixed mesh coordinates. */
typedef struct ist_contact_region {
  double area,             /**< mesh units^2 */
      centre[3];           /**< of the area */
  double least_distance,   /**< of its vertices, mesh units, negative inside */
      closest[3];          /**< the vertex that has it */
  double penetrating_area, /**< where the distance is at most 0, mesh units^2 */
      depth_integral;      /**< of the depth over that area, mesh units^3: no volume */
  double share,            /**< of all regions, 0 to 1: geometric, no force */
      share_thinner,       /**< with a foundation thinner by the change */
      share_thicker;       /**< and thicker */
  uint32_t triangle;       /**< of the surface, one that holds that vertex */
  int32_t partner;         /**< the region of the other surface that it faces, or -1 */
} ist_contact_region;

/** The arrays of one surface, which the caller owns, with room for so many; each may be NULL where
 * its room is 0. `areas` has room for `limit_count`, or is NULL. */
typedef struct ist_occlusion_arrays {
  size_t struct_size;              /**< the size of this struct, bytes */
  ist_surface_distance* distances; /**< of the vertices; `closest` in fixed mesh coordinates */
  size_t distance_capacity;        /**< room for so many distances */
  ist_contact_region* regions;     /**< the largest first */
  size_t region_capacity;          /**< room for so many regions */
  double* areas;                   /**< within each limit, mesh units^2 */
} ist_occlusion_arrays;

/** The sums of one surface against the other body. */
typedef struct ist_occlusion {
  size_t struct_size;    /**< the size of this struct, bytes */
  uint64_t vertices,     /**< all of the mesh, in the arrays or not */
      regions;           /**< all, in the arrays or not */
  double total_area,     /**< of the mesh, mesh units^2 */
      penetrating_area,  /**< where the distance is at most 0, mesh units^2 */
      depth_integral,    /**< of the depth over that area, mesh units^3 */
      depth_at_vertices; /**< the largest of a vertex, mesh units; 0 where all lie outside */
  double rotation_error; /**< of the given pose: as in ist_query_result */
} ist_occlusion;

/** Measures the occlusion of two bodies: distance maps, areas within limits, contact regions, for
 * each surface. `options`, `fixed_arrays` and `moving_arrays` may be NULL. Errors:
 * IST_POSE_INVALID, IST_ARGUMENT_INVALID, IST_MEMORY_LIMIT, IST_CANCELLED. Cost: 0.1 s for jaws. */
IST_C_API ist_status ist_query_occlusion(ist_query* query, const double pose[16],
                                         const ist_occlusion_options* options,
                                         const ist_progress* progress,
                                         const ist_occlusion_arrays* fixed_arrays,
                                         const ist_occlusion_arrays* moving_arrays,
                                         ist_occlusion* fixed, ist_occlusion* moving) IST_NOEXCEPT;

/** The motion of a body from one pose to another, fixed mesh coordinates: as six numbers about a
 * named point, and as a screw. */
typedef struct ist_pose_change {
  size_t struct_size;    /**< the size of this struct, bytes */
  double about[3],       /**< the named point, at the first pose */
      translation[3],    /**< the way of that point, mesh units */
      rotation[3];       /**< along the axis of the turn, as long as its angle, radians */
  double axis[3],        /**< of the screw, of unit length; 0 if nothing moves */
      axis_point[3];     /**< the axis' nearest point to `about`; 0 if nothing turns */
  double angle,          /**< of the turn, radians, 0 to pi */
      along;             /**< the way along the axis, mesh units */
  double rotation_error; /**< of the given poses, the larger one: as in ist_query_result */
  int32_t turns;         /**< 1: the body turns, and has an axis_point */
  int32_t reserved;      /**< zero */
} ist_pose_change;

/** Gives the motion that takes a body from the pose `before` to the pose `after`. `about` is a
 * point that the body carries from its first pose, fixed mesh coordinates. Errors:
 * IST_POSE_INVALID, IST_ARGUMENT_INVALID for a point that is not finite. */
IST_C_API ist_status ist_motion_between(const double before[16], const double after[16],
                                        const double about[3],
                                        ist_pose_change* result) IST_NOEXCEPT;

/** A contact of a bite, by its place. */
typedef struct ist_placed_contact {
  double centre[3]; /**< fixed mesh coordinates, such as `centre` of ist_contact_region */
  int32_t tooth;    /**< its label; 0: it has none */
  int32_t reserved; /**< zero */
} ist_placed_contact;

/** Matches the contacts of two bites by their places on the fixed body: the two nearest centres
 * first, then the nearest of the rest, as far as `within` mesh units. Contacts with different teeth
 * are never matched. `matches` takes for each contact of the first bite the index of its contact in
 * the second one, or -1 if it is lost. A contact of the second bite that nobody names is new.
 * Errors: IST_ARGUMENT_INVALID for a centre that is not finite, and a `within` that is negative or
 * NaN. Cost: 2 ns for each pair of contacts. */
IST_C_API ist_status ist_match_contacts(const ist_placed_contact* before, size_t before_count,
                                        const ist_placed_contact* after, size_t after_count,
                                        double within, int32_t* matches) IST_NOEXCEPT;

/** What ist_query_rows asks at every pose. */
typedef struct ist_rows_options {
  size_t struct_size; /**< the size of this struct, bytes */
  int32_t questions;  /**< the sum of IST_ASK_...; required */
  int32_t threads;    /**< most threads, of the whole process meanwhile; 0: all cores */
  double tolerance;   /**< of distances and depths, mesh units; default 0 */
  double stiffness;   /**< of springs, N/mm^3; default 1 */
  uint64_t tests;     /**< most tests of each search of bounds or triangles; 0: no limit */
  const ist_progress* progress; /**< follows the call; may be NULL */
} ist_rows_options;

/** The answers at one pose; lengths in mesh units. If a number was not asked for, or the pose is
 * invalid, an integer is 0 and a double is NaN. */
typedef struct ist_row {
  ist_status status;     /**< IST_OK, or IST_POSE_INVALID: then there is no answer */
  int32_t intersects;    /**< IST_ANSWER_..., or IST_ANSWER_UNKNOWN */
  int32_t complete;      /**< 1: every search came to its end and every tolerance was reached */
  int32_t not_closed;    /**< IST_CLOSED, or why there is no depth */
  uint64_t leaf_pairs;   /**< leaf pairs found */
  uint64_t sphere_tests; /**< tests made by all searches together, those of a depth excepted */
  double distance_lower, /**< the distance between the surfaces is no less */
      distance_upper;    /**< and no more */
  double depth_lower,    /**< the penetration depth is no less */
      depth_upper;       /**< and no more */
  double area;           /**< sum of the weights of all leaf pairs, mesh units^2 */
  double force[3],       /**< of springs on the moving body, N for meshes in mm */
      torque[3];         /**< about the origin of the fixed tree (ist_tree_info), N mm */
  double rotation_error; /**< of the given pose, also of an invalid one: as in ist_query_result */
  int32_t self_intersecting; /**< of a depth: the sum of IST_..._SELF_INTERSECTING */
  int32_t capped;            /**< of a depth: as in ist_penetration */
} ist_row;

/** Answers the same questions at `count` poses, 16 numbers each: row i is what the calls for each
 * question say at pose i after ist_query_forget, bit by bit, whatever the number of threads. An
 * invalid pose is a row with its status, and no error. The query forgets what earlier poses left;
 * each further thread makes a query of its own. Errors: IST_ARGUMENT_INVALID; IST_TRIANGLES_MISSING
 * if a depth is asked for; IST_VOXELS_MISSING if leaf pairs or contacts are; IST_NOT_PREPARED if
 * contacts are, and the query was created without; IST_MEMORY_LIMIT, IST_CANCELLED. Cost: that of
 * the calls, shared by the threads. */
IST_C_API ist_status ist_query_rows(ist_query* query, const double* poses, size_t count,
                                    const ist_rows_options* options, ist_row* rows) IST_NOEXCEPT;

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* IST_CAPI_IST_MEASURE_H */
