#pragma once

/// @file
/// All of IST that answers questions about bodies: meshes, trees, queries of two bodies, worlds of
/// many. ist/models/models.h makes built-in models. ist/query/reference/reference_query.h has the
/// published query, for tests. ist/haptics.h and ist/scene.h stand apart.
#include "ist/base/api.h"

#if __cplusplus >= 202002L  // else ist/base/api.h has said what is needed
#include "ist/base/error.h"
#include "ist/base/pose.h"
#include "ist/base/progress.h"
#include "ist/mesh/mesh.h"
#include "ist/query/manifold.h"
#include "ist/query/query.h"
#include "ist/query/results.h"
#include "ist/query/world/world.h"
#include "ist/tree/sphere_tree.h"
#endif
