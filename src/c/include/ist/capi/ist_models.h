#ifndef IST_CAPI_IST_MODELS_H
#define IST_CAPI_IST_MODELS_H

/**
 * @file
 * Built-in models. The conventions of ist_c.h apply. Link libist_loop.
 */

#include "ist/capi/ist_c.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The jaws of ist_jaw_create. */
enum { IST_JAW_LOWER = 0 /**< the mandible */, IST_JAW_UPPER = 1 /**< the maxilla */ };

/** Creates a human jaw from nothing, in millimetres; `seed` varies its teeth. Both jaws share a
 * frame, in which they are closed on each other. One seed gives the same bytes on every machine.
 * Errors: IST_ARGUMENT_INVALID for another jaw. Cost: 5 ms. */
IST_C_API ist_status ist_jaw_create(int32_t jaw, uint64_t seed, ist_mesh** mesh) IST_NOEXCEPT;

#ifdef __cplusplus
}
#endif

#endif
