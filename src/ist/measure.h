#pragma once

/// @file
/// Measures of two bodies that take milliseconds and allocate: signed distances of points, how deep
/// the bodies are in each other and how they are freed, when they first meet, where and on what
/// area they touch, and where one rests on the other. ist/ist.h has the questions of a loop.
#include "ist/base/api.h"

#if __cplusplus >= 202002L  // else ist/base/api.h has said what is needed
#include "ist/measure/comparison.h"
#include "ist/measure/escape.h"
#include "ist/measure/first_contact.h"
#include "ist/measure/occlusion.h"
#include "ist/measure/penetration.h"
#include "ist/measure/settle.h"
#include "ist/measure/signed_distance.h"
#endif
