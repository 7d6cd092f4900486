#ifndef IST_CAPI_IST_SWEEP_H
#define IST_CAPI_IST_SWEEP_H

/**
 * @file
 * Sweeps: the same questions about two bodies at up to 10^12 poses, in parts that any process, on
 * any machine, may make. A sweep file names the bodies, the poses and the questions; a folder
 * holds the parts, which merge into one table. The conventions of ist_c.h apply. Every function may
 * be called from any number of threads on one sweep. Link libist_loop.
 */

#include "ist/capi/ist_c.h"

#ifdef __cplusplus
extern "C" {
#endif

/** A sweep as its file describes it. */
typedef struct ist_sweep ist_sweep;

/** Reads a sweep file, and computes the hashes of the meshes, trees and poses that it names.
 * `sweep` takes NULL after an error. Errors: IST_FILE_UNREADABLE, IST_INPUT_INVALID with
 * file, line and remedy, the errors of trees, IST_CANCELLED. Cost: reads the files. */
IST_C_API ist_status ist_sweep_open(const char* path, const ist_progress* progress,
                                    ist_sweep** sweep) IST_NOEXCEPT;

/** Frees a sweep; NULL is ignored. Its folders stay. */
IST_C_API ist_status ist_sweep_free(ist_sweep* sweep) IST_NOEXCEPT;

/** A sweep's sizes. */
typedef struct ist_sweep_info {
  size_t struct_size;     /**< the size of this struct, bytes */
  uint64_t rows;          /**< poses, one row each */
  uint64_t rows_per_part; /**< of each part but the last, which may have fewer */
  uint64_t parts;         /**< 0 where there is no pose */
  uint64_t row_bytes;     /**< of a row: its columns side by side */
  uint64_t columns;       /**< of a row */
  char hash[40];          /**< 32 hexadecimal digits, which name the rows of the sweep */
} ist_sweep_info;

/** Describes a sweep. */
IST_C_API ist_status ist_sweep_get_info(const ist_sweep* sweep, ist_sweep_info* info) IST_NOEXCEPT;

/** The type of a column's values, which are little-endian in files. */
enum {
  IST_COLUMN_UINT64 = 1, /**< 8 bytes */
  IST_COLUMN_INT32 = 2,  /**< 4 bytes */
  IST_COLUMN_FLOAT64 = 3 /**< 8 bytes, IEEE 754 */
};

/** A column of a sweep's rows. */
typedef struct ist_sweep_column {
  size_t struct_size; /**< the size of this struct, bytes */
  char name[24];      /**< such as "distance_lower", with a terminating zero */
  int32_t type;       /**< IST_COLUMN_... */
  int32_t reserved;   /**< zero */
  uint64_t offset;    /**< of a value from its row's first byte, bytes */
} ist_sweep_column;

/** Describes column `column`, from 0. Errors: IST_ARGUMENT_INVALID beyond the last. */
IST_C_API ist_status ist_sweep_get_column(const ist_sweep* sweep, uint64_t column,
                                          ist_sweep_column* info) IST_NOEXCEPT;

/** Computes `count` poses from number `first` on, 16 numbers each. Errors: IST_ARGUMENT_INVALID
 * beyond the last; IST_INPUT_INVALID if the file of poses changed. Cost: below 1 us a pose. */
IST_C_API ist_status ist_sweep_get_poses(const ist_sweep* sweep, uint64_t first, size_t count,
                                         double* poses) IST_NOEXCEPT;

/** Whether a part is there. */
enum {
  IST_PART_MISSING = 1,  /**< nobody has made it yet */
  IST_PART_DONE = 2,     /**< its file is there */
  IST_PART_GIVEN_UP = 3, /**< begun and lost three times: it is not tried again */
  IST_PART_DAMAGED = 4   /**< its file is not the one that was written */
};

/** How a part stands in its folder. */
typedef struct ist_sweep_part {
  size_t struct_size; /**< the size of this struct, bytes */
  int32_t state;      /**< IST_PART_... */
  int32_t starts;     /**< begun and not ended, by processes that died or still run */
  uint64_t rows;      /**< of the part */
  double seconds;     /**< that making it took; NaN where unknown */
  int32_t made;       /**< 1: by this call of ist_sweep_run_part */
  int32_t reserved;   /**< zero */
} ist_sweep_part;

/** Makes part `part`, from 0, in `folder`, which is made where it is missing. A part that is there,
 * or was given up, stays as it is; `result` says which. `threads`: the most, of the whole process
 * meanwhile; 0: all cores. The same bytes come of every process and number of threads. Errors:
 * IST_ARGUMENT_INVALID beyond the last part; IST_PART_BUSY if somebody else is making the part
 * now; IST_INPUT_INVALID for a folder of another sweep, for one that the user may not write to, for
 * a damaged part, and for a body that changed since; the errors of meshes and trees;
 * IST_FILE_UNREADABLE, IST_FILE_UNWRITABLE, IST_TRIANGLES_MISSING, IST_POLICY_MISSING,
 * IST_MEMORY_LIMIT, IST_CANCELLED. Nothing half-made stays. Cost: as ist_query_rows. The first part
 * of a sweep loads the trees, and builds the trees of meshes. */
IST_C_API ist_status ist_sweep_run_part(const ist_sweep* sweep, const char* folder, uint64_t part,
                                        int32_t threads, const ist_progress* progress,
                                        ist_sweep_part* result) IST_NOEXCEPT;

/** Looks how a part stands. With `verify` other than 0 its file is read and its checksum compared.
 * Errors: IST_ARGUMENT_INVALID beyond the last part; IST_INPUT_INVALID for a folder or a part of
 * another sweep; IST_FILE_UNREADABLE if nobody has begun in the folder. */
IST_C_API ist_status ist_sweep_get_part(const ist_sweep* sweep, const char* folder, uint64_t part,
                                        int32_t verify, ist_sweep_part* result) IST_NOEXCEPT;

/** How a merge ended. */
typedef struct ist_sweep_merge_result {
  size_t struct_size; /**< the size of this struct, bytes */
  uint64_t rows;      /**< of the table; 0: nothing was merged */
  uint64_t missing;   /**< parts that nobody has made yet */
  uint64_t given_up;  /**< parts that are not tried again */
  uint64_t reserved;  /**< zero */
} ist_sweep_merge_result;

/** Merges the parts into rows.npy of the folder, and writes all checksums to manifest.json. If a
 * part is missing or given up, the call writes nothing and returns IST_OK with the number of such
 * parts; ist_sweep_get_part finds them. If the table is there and has its checksum, the call writes
 * nothing either. Errors: IST_PART_BUSY if another process is merging; IST_FILE_UNREADABLE if
 * nobody has begun in the folder; IST_INPUT_INVALID if the folder or a part belongs to another
 * sweep, if a part is damaged, and if the user may not write to the folder; IST_FILE_UNWRITABLE,
 * IST_CANCELLED. Cost: the time to read and write all rows; memory of 10 MB, and 400 bytes a part.
 */
IST_C_API ist_status ist_sweep_merge(const ist_sweep* sweep, const char* folder,
                                     const ist_progress* progress,
                                     ist_sweep_merge_result* result) IST_NOEXCEPT;

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* IST_CAPI_IST_SWEEP_H */
