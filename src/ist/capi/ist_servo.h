#ifndef IST_CAPI_IST_SERVO_H
#define IST_CAPI_IST_SERVO_H

/*
 * Force feedback in a device's own loop: once a tick it brings where the handle is, and takes along
 * what the hand is to feel. For conventions see ist.h.
 *
 * Metres or millimetres is the caller's choice; forces are in N, torques in N m about the tool's
 * origin, both in the scene's axes. The tool's frame has the held mesh's axes, and its origin is
 * the centre of the held body's grid. Poses map it to the scene.
 */

#include "ist/capi/ist.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The unit of the poses' translations. */
enum { IST_UNIT_M = 1, IST_UNIT_MM = 2 };

/* A scene that is simulated. It belongs to one thread at a time. */
typedef struct ist_servo ist_servo;

typedef struct ist_servo_options {
  size_t struct_size;
  int32_t unit;       /* to be given: IST_UNIT_M or IST_UNIT_MM */
  int32_t reserved;   /* zero */
  double query_share; /* part of a tick in which queries may begin anything; default 0.7, up to 1 */
  uint64_t sphere_tests; /* what each of a tick's queries may spend instead, by no clock: the same
                            forces in every run; 0: the clock decides */
  uint64_t max_memory;   /* bytes, for each tree; default 4 GiB */
} ist_servo_options;

/* Reads a scene (TOML), reads or makes its bodies, builds what its effects need, and puts the tool
 * where it is free. The caller is the scene's device: of its table `device`, damping and delay
 * count, for they limit what coupling is stable; who moves it does not.
 * Errors: IST_INPUT_INVALID, by the scene's file and line, and those of ist_mesh_read and
 * ist_tree_load; IST_ARGUMENT_INVALID. Cost: some seconds. */
IST_C_API ist_status ist_servo_open_scene(const char* path, const ist_servo_options* options,
                                          ist_servo** servo) IST_NOEXCEPT;

/* What the scene's building warned of, sentence by sentence from `index` 0 on; NULL after the last,
 * and where `servo` is no handle of one, or another thread is in a call with it. The text lives as
 * long as the servo. */
IST_C_API const char* ist_servo_warning(ist_servo* servo, size_t index) IST_NOEXCEPT;

typedef struct ist_servo_info {
  size_t struct_size;
  double tick_seconds; /* what a tick counts as, however late it comes */
  double tool[16]; /* where the tool is: before the first tick where a device should be, and then
                      what is to be drawn, for it stays outside where the device goes in */
  uint64_t ticks;
  uint64_t held;   /* ticks with too little time for all contacts: the tool stayed */
  uint64_t faults; /* ticks in which nothing was felt, for what was wrong */
  uint64_t late;   /* ticks that took longer than a tick has */
} ist_servo_info;

/* [real time] */
IST_C_API ist_status ist_servo_get_info(ist_servo* servo, ist_servo_info* info) IST_NOEXCEPT;

/* One tick. `pose` is where the device is, `force` and `torque` are what the hand is to feel.
 *
 * Whatever is returned but IST_OK, both are zero: what the device is told must be set every tick.
 * After an error forces come back softly, but after IST_HANDLE_BUSY, which says that another thread
 * is in a call with this servo: then no tick was made. Too little time for all contacts is no
 * error, see ist_servo_info.
 * Errors: IST_POSE_INVALID, IST_SERVO_FAULT, IST_NULL_ARGUMENT. Cost: the queries', and 5 to 15 us.
 * [real time] */
IST_C_API ist_status ist_servo_on_tick(ist_servo* servo, const double pose[16], double force[3],
                                       double torque[3]) IST_NOEXCEPT;

/* The hand feels nothing from it any more: tell the device so. */
IST_C_API ist_status ist_servo_free(ist_servo* servo) IST_NOEXCEPT;

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* IST_CAPI_IST_SERVO_H */
