#pragma once

/// @file
/// The haptic layer: devices, effects, the simulation, the servo loop and its records. Link
/// libist_loop (CMake ist::loop).
#include "ist/base/api.h"

#if __cplusplus >= 202002L  // else ist/base/api.h has said what is needed
#include "ist/base/error.h"
#include "ist/haptics/devices/device.h"
#include "ist/haptics/effects/effect.h"
#include "ist/haptics/latency_histogram.h"
#include "ist/haptics/placement.h"
#include "ist/haptics/recording.h"
#include "ist/haptics/servo_callback.h"
#include "ist/haptics/servo_loop.h"
#include "ist/haptics/simulation.h"
#endif
