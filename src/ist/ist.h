#pragma once

/// @file
/// All of IST that answers questions about bodies: meshes, built-in models, trees, queries of two
/// bodies, worlds of many.
/// ist/haptics.h and ist/scene.h stand apart.
#include "ist/base/api.h"

#if __cplusplus >= 202002L  // else ist/base/api.h has said what is needed
#include "ist/base/error.h"
#include "ist/base/pose.h"
#include "ist/base/progress.h"
#include "ist/mesh/mesh.h"
#include "ist/models/models.h"
#include "ist/query/manifold.h"
#include "ist/query/query.h"
#include "ist/query/reference/reference_query.h"
#include "ist/query/results.h"
#include "ist/query/world/world.h"
#include "ist/tree/sphere_tree.h"
#endif
