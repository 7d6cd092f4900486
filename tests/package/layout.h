#pragma once

#include <ist/haptics.h>
#include <ist/ist.h>
#include <ist/measure.h>
#include <ist/query/reference/reference_query.h>
#include <ist/scene.h>

#include <array>
#include <cstddef>

namespace layout {

template <class... Types>
consteval auto numbers_of(auto... places) {
  return std::array{sizeof(Types)..., alignof(Types)..., places...};
}

/// Sizes and alignments of what consumers make, and places of members that come after vectors and
/// matrices, as the code that includes this sees them. In a section of its own: who compares reads
/// it from the object, also of code for another processor.
[[gnu::used, gnu::section("ist_layout")]] constexpr auto kNumbers =
    numbers_of<ist::TriangleMesh, ist::MeshSource, ist::SphereTree, ist::BuildOptions,
               ist::BuildReport, ist::QueryOptions, ist::Query, ist::ReferenceQuery,
               ist::ContactManifold, ist::Contact, ist::ContactSums, ist::QueryResult,
               ist::TrianglePairsResult, ist::NearPair, ist::NearPairsResult, ist::DistanceResult,
               ist::World, ist::WorldOptions, ist::WorldQuestion, ist::WorldPair, ist::WorldAnswer,
               ist::WorldDistance, ist::Budget, ist::Placement, ist::Vector6, ist::Response,
               ist::ToolContacts, ist::Simulation, ist::Tick, ist::TickRecord, ist::HandSettings,
               ist::ContactSettings, ist::SpringsSettings, ist::GravitySettings, ist::SnapSettings,
               ist::ServoCallback, ist::LatencyHistogram, ist::ServoOptions, ist::ServoOutputs,
               ist::ServoReport, ist::Snapshot<ist::TickRecord>, ist::TickRing<ist::TickRecord>,
               ist::Scene, ist::BuiltScene, ist::SurfaceDistance, ist::Penetration,
               ist::PenetrationOptions, ist::DepthTracker, ist::Motion, ist::FirstContact,
               ist::FirstContactOptions, ist::ContactRegion, ist::SurfaceOcclusion, ist::Occlusion,
               ist::OcclusionOptions>(
        offsetof(ist::TriangleMesh, triangles), offsetof(ist::Contact, weight),
        offsetof(ist::ContactSums, spring), offsetof(ist::QueryResult, pad),
        offsetof(ist::Placement, translation), offsetof(ist::Response, stiffness),
        offsetof(ist::HandSettings, plan), offsetof(ist::GravitySettings, acceleration),
        offsetof(ist::Tick, wrench), offsetof(ist::Tick, leaf_pairs),
        offsetof(ist::TickRecord, cpu_ns), offsetof(ist::BuiltScene, warnings),
        offsetof(ist::ServoReport, notes), offsetof(ist::SurfaceDistance, triangle),
        offsetof(ist::Penetration, narrowest), offsetof(ist::FirstContact, narrowest),
        offsetof(ist::NearPair, moving_part), offsetof(ist::DistanceResult, rotation_error),
        offsetof(ist::ContactRegion, share));

}  // namespace layout
