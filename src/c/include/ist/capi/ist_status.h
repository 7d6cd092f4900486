#ifndef IST_CAPI_IST_STATUS_H
#define IST_CAPI_IST_STATUS_H

/**
 * @file
 * The version of the interface, the results of its calls, and how a caller follows one that lasts.
 */

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define IST_C_API __attribute__((visibility("default"))) /**< a function of the library */
#define IST_MAY_ALIAS __attribute__((may_alias)) /**< it may share memory with another struct */
#else
#define IST_C_API
#define IST_MAY_ALIAS
#endif
#ifdef __cplusplus
#define IST_NOEXCEPT noexcept /**< no exception leaves a function */
extern "C" {
#else
#define IST_NOEXCEPT
#endif

/** The version of this interface. It increases with each added function or member; an incompatible
 * change also changes the library's SONAME. */
#define IST_ABI_VERSION 1

/** Returns the IST_ABI_VERSION of the library. [real time] */
IST_C_API uint32_t ist_abi_version(void) IST_NOEXCEPT;

/** Returns the version of the library, such as "1.2.3". [real time] */
IST_C_API const char* ist_version_string(void) IST_NOEXCEPT;

/** The result of a call. The numbers never change. */
typedef int32_t ist_status;

/** The codes of an ist_status: 1 to 15 of the C interface, from 101 those of the library. */
enum {
  IST_OK = 0,                     /**< the call did what it was asked */
  IST_NULL_ARGUMENT = 1,          /**< a required pointer is NULL */
  IST_STRUCT_SIZE = 2,            /**< struct_size is invalid, or an unknown member is not zero */
  IST_ARGUMENT_INVALID = 3,       /**< a number is out of range */
  IST_NOT_A_HANDLE = 4,           /**< the library never created this handle */
  IST_HANDLE_KIND = 5,            /**< a handle of another kind */
  IST_HANDLE_FREED = 6,           /**< the handle was freed before */
  IST_HANDLE_BUSY = 7,            /**< another thread is using the query, servo or world */
  IST_TOO_MANY_HANDLES = 8,       /**< 65,536 handles live */
  IST_OUT_OF_MEMORY = 9,          /**< the system has no memory left */
  IST_SYSTEM_ERROR = 10,          /**< the operating system refused a request */
  IST_INTERNAL_ERROR = 11,        /**< a bug in this library */
  IST_NOT_PREPARED = 12,          /**< the query has no contacts, or the world no memory yet */
  IST_SERVO_FAULT = 13,           /**< a force was not a number: the output is zero */
  IST_CANCELLED = 14,             /**< the caller ended the call */
  IST_CHANGE_REFUSED = 15,        /**< the hand may not take or release the body now */
  IST_FILE_UNREADABLE = 101,      /**< the file cannot be opened or read */
  IST_FILE_UNWRITABLE = 102,      /**< the file cannot be created, written or renamed */
  IST_NOT_A_MESH = 103,           /**< the content is no mesh format */
  IST_MESH_EMPTY = 104,           /**< no vertex and no triangle */
  IST_MESH_POINTS_ONLY = 105,     /**< vertices, but no triangle */
  IST_MESH_TRUNCATED = 106,       /**< the file ends before its content */
  IST_MESH_BAD_INDEX = 107,       /**< a triangle has an index beyond the last vertex */
  IST_MESH_NOT_FINITE = 108,      /**< a vertex is NaN or infinite */
  IST_MESH_EXTENT = 109,          /**< the largest extent is zero or outside [1e-12, 1e15] */
  IST_VOXEL_SIZE_INVALID = 110,   /**< not positive and finite, or too large for the mesh */
  IST_VOXEL_SIZE_TOO_SMALL = 111, /**< needs more than 2^16 voxels per axis */
  IST_MEMORY_LIMIT = 112,         /**< needs more memory than the limit allows */
  IST_NOT_A_TREE = 113,           /**< not a tree file */
  IST_TREE_VERSION = 114,         /**< a tree file of another version */
  IST_TREE_TRUNCATED = 115,       /**< the file is shorter or longer than its header says */
  IST_TREE_CORRUPT = 116,         /**< wrong checksum or content */
  IST_POLICY_MISSING = 117,       /**< a tree lacks the requested spheres */
  IST_TRIANGLES_MISSING = 118,    /**< a tree was built without triangles */
  IST_TARGET_MISSING = 119,       /**< the processor lacks the requested instruction set */
  IST_POSE_INVALID = 120,         /**< the pose is not a rigid motion */
  IST_INPUT_INVALID = 121,        /**< the content of a scene or another file is invalid */
  IST_FIXED_POINT_RANGE = 122,    /**< a number exceeds the hardware's fixed-point format */
  IST_MESH_TOO_LARGE = 123,       /**< the mesh file unpacks, or places, too much */
  IST_PART_BUSY = 124,            /**< another process is making this part of a sweep now */
  IST_VOXELS_MISSING = 125        /**< a tree was built without voxels */
};

/** The caller's function that follows a call which may last, on the caller's thread. NULL in place
 * of the struct: nobody follows. */
typedef struct ist_progress {
  size_t struct_size; /**< the size of this struct, bytes */
  /** Is called when the call begins, and at least every 0.05 s, with the part that is done, 0 to 1
   * as far as that is known. Returns 0 to go on; any other number ends the call with IST_CANCELLED,
   * and nothing is made. It must return: no longjmp, no exception. It may call the library, but not
   * with the query, servo or world of the call. */
  int32_t (*report)(void* user, double part);
  void* user; /**< handed to `report`; never read */
} ist_progress;

/** Returns the name of a code for logs, such as "mesh-truncated"; "unknown" for any other number.
 * [real time] */
IST_C_API const char* ist_status_name(ist_status status) IST_NOEXCEPT;

/** Returns the message of the calling thread's last error: function, cause, remedy. It is empty
 * before the first error and cut after 511 bytes. Calls that succeed do not change it. The thread
 * owns the text, which stays valid until its next error. [real time] */
IST_C_API const char* ist_last_error_message(void) IST_NOEXCEPT;

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* IST_CAPI_IST_STATUS_H */
