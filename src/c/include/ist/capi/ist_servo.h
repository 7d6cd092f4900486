#ifndef IST_CAPI_IST_SERVO_H
#define IST_CAPI_IST_SERVO_H

/**
 * @file
 * Force feedback in a device's own loop: each tick passes the handle's pose and receives the force
 * and torque for the hand. The conventions of ist_c.h apply. Link libist_loop.
 *
 * The caller chooses metres or millimetres for poses. Forces are in N and torques in N m about the
 * tool's origin, both along the scene's axes. The tool's frame has the axes of the first held mesh;
 * its origin is the middle of that mesh's box, or the point that the scene names. Poses map the
 * tool's frame to the scene.
 */

#include "ist/capi/ist_c.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The unit of the poses' translations. */
enum {
  IST_UNIT_M = 1, /**< metres */
  IST_UNIT_MM = 2 /**< millimetres */
};

/** A simulated scene. It belongs to one thread at a time, but any thread may call
 * ist_servo_get_state. */
typedef struct ist_servo ist_servo;

/** How a scene is built and its ticks are limited. */
typedef struct ist_servo_options {
  size_t struct_size;         /**< the size of this struct, bytes */
  int32_t unit;               /**< IST_UNIT_M or IST_UNIT_MM; required */
  int32_t reserved;           /**< zero */
  double query_time_fraction; /**< fraction of a tick for queries, from 0 to 1; default 0.7 */
  uint64_t sphere_tests; /**< tests per query of a tick, instead of a time limit: the same forces in
                            every run; 0: the time limit applies */
  uint64_t max_memory;   /**< memory limit of each tree, and of all queries, bytes; default 4 GiB */
  const ist_progress* progress; /**< follows the construction; may be NULL */
} ist_servo_options;

/** Reads a scene (TOML), reads or creates its bodies, builds the trees of its effects and moves the
 * tool to a free place. The caller is the scene's device: the damping and the delay in the scene's
 * table `device` limit the stable coupling; the caller's poses replace its motion.
 * Errors: IST_INPUT_INVALID, with the scene's file and line in the message; the errors of
 * ist_mesh_read and ist_tree_load; IST_ARGUMENT_INVALID; IST_CANCELLED. Cost: a few
 * seconds. */
IST_C_API ist_status ist_servo_open_scene(const char* path, const ist_servo_options* options,
                                          ist_servo** servo) IST_NOEXCEPT;

/** Returns the warning number `index`, from 0, of the scene's construction; NULL after the last
 * warning, for an invalid handle, and while another thread uses the servo. The text lives as long
 * as the servo. */
IST_C_API const char* ist_servo_warning(ist_servo* servo, size_t index) IST_NOEXCEPT;

/** The tool of a servo, and counts since it was opened. */
typedef struct ist_servo_info {
  size_t struct_size;  /**< the size of this struct, bytes */
  double tick_seconds; /**< nominal duration of a tick, s */
  double tool[16]; /**< pose of the tool. Before the first tick it is the start pose for the device;
                      afterwards it is the pose to draw, which stays outside the fixed body */
  uint64_t ticks;  /**< ticks, those with an error included */
  uint64_t held;   /**< ticks with too little time for all contacts: the tool did not move */
  uint64_t faults; /**< ticks with an error: the force was zero */
  uint64_t late;   /**< ticks that took longer than tick_seconds */
  size_t bodies;   /**< bodies of the scene: the fixed ones, then the held ones */
} ist_servo_info;

/** Gives the tool of a servo, and its counts. [real time] */
IST_C_API ist_status ist_servo_get_info(ist_servo* servo, ist_servo_info* info) IST_NOEXCEPT;

/** Computes one tick: `pose` is the pose of the device; `force` and `torque` receive the output for
 * the hand.
 *
 * Both outputs are zero after any error; the caller must command them to the device in every tick.
 * After an error the forces return gradually. IST_HANDLE_BUSY is different: another thread is using
 * the servo, and the call computes no tick. Too little time for all contacts is not an error;
 * ist_servo_info counts it as `held`.
 * Errors: IST_POSE_INVALID, IST_SERVO_FAULT, IST_NULL_ARGUMENT. Cost: the queries, plus 5 to 15 us.
 * [real time] */
IST_C_API ist_status ist_servo_on_tick(ist_servo* servo, const double pose[16], double force[3],
                                       double torque[3]) IST_NOEXCEPT;

/** The most contacts that push the tool at once. */
#define IST_MOST_SERVO_CONTACTS 6

/** A contact of the tool with a fixed body, along the scene's axes. */
typedef struct ist_servo_contact {
  double position[3];      /**< on the fixed body, in the poses' unit */
  double normal[3];        /**< of unit length, from the fixed body to the held one */
  double force[3];         /**< on the tool, N */
  double gap;              /**< between the bodies there, in the poses' unit */
  uint32_t fixed_triangle; /**< of the fixed mesh, by its index */
  uint32_t held_triangle;  /**< of the held mesh, by its index */
  uint32_t fixed;          /**< the fixed body, by its number in ist_servo_get_body */
  uint32_t held;           /**< the held body, by its number */
} ist_servo_contact;

/** A tick as other threads see it. Translations are in the poses' unit. */
typedef struct ist_servo_state {
  size_t struct_size;   /**< the size of this struct, bytes */
  int32_t known;        /**< 1; 0: there is no state, and all members below are zero */
  int32_t device_known; /**< 0: the device had no valid pose */
  uint64_t tick;        /**< the number of the tick, from 0 */
  double device[16];    /**< pose of the device, or the last valid one */
  double tool[16];      /**< pose of the tool after the tick, which is the pose to draw */
  double force[3];      /**< on the hand, N */
  double torque[3];     /**< on the hand, N m */
  int32_t fault;        /**< 1: the tick had an error, and the force was zero */
  int32_t held;         /**< 1: the tool stayed where it was: the time did not suffice, or no motion
                           was free */
  int32_t halved;       /**< 1: the tool met a body on its way, and stopped before it */
  int32_t steps;        /**< that the tool made; 0 with springs */
  int64_t begin_ns;     /**< the tick's start, ns of std::chrono::steady_clock, which is
                           CLOCK_MONOTONIC on Linux */
  int64_t execution_ns; /**< from the tick's start to its end, ns */
  uint64_t contact_count;                              /**< of `contacts` */
  ist_servo_contact contacts[IST_MOST_SERVO_CONTACTS]; /**< that push the tool; the rest is zero */
} ist_servo_state;

/** Gives the last tick.
 *
 * Any thread may call it at any time, also while another thread is in ist_servo_on_tick: the loop
 * never waits for it, and it never gives IST_HANDLE_BUSY because of the loop. The loop's own thread
 * gets the tick that it has just made. `known` is 0 before the first tick, and if the loop was
 * writing during every attempt to read: ask again later. Cost: 1 us. [real time] */
IST_C_API ist_status ist_servo_get_state(ist_servo* servo, ist_servo_state* state) IST_NOEXCEPT;

/** A body of a servo's scene. */
typedef struct ist_servo_body {
  size_t struct_size; /**< the size of this struct, bytes */
  const char* name;   /**< lives as long as the servo */
  int32_t held;       /**< 1: in the hand; 0: fixed */
  int32_t reserved;   /**< zero */
  double pose[16];    /**< maps the mesh, in the poses' unit, to the scene, after the last tick */
} ist_servo_body;

/** Gives the body number `index`, from 0.
 * Errors: IST_ARGUMENT_INVALID for an index beyond the last body. [real time] */
IST_C_API ist_status ist_servo_get_body(ist_servo* servo, size_t index,
                                        ist_servo_body* body) IST_NOEXCEPT;

/** Takes a fixed body into the hand, where it is: from the next tick on it moves with the tool. The
 * body is `attachable` in the scene. Call it between two ticks. Its queries have the time or the
 * tests of a tick's queries.
 * Errors: IST_CHANGE_REFUSED while anything touches the body or one in the hand, if it is held
 * already, is not attachable or follows a script, or if the time did not suffice; the message says
 * which. IST_ARGUMENT_INVALID for a name of no body. [real time] */
IST_C_API ist_status ist_servo_attach(ist_servo* servo, const char* body) IST_NOEXCEPT;

/** Leaves a held body where it is, as a fixed one, whatever touches it.
 * Errors: as ist_servo_attach, but for what touches. [real time] */
IST_C_API ist_status ist_servo_release(ist_servo* servo, const char* body) IST_NOEXCEPT;

/** Frees a servo. The caller must then command zero force to the device. */
IST_C_API ist_status ist_servo_free(ist_servo* servo) IST_NOEXCEPT;

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* IST_CAPI_IST_SERVO_H */
