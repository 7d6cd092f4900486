#pragma once

#include <ist/haptics/devices/null_device.h>
#include <ist/haptics/devices/script_device.h>
#include <ist/haptics/effects/gravity_effect.h>
#include <ist/haptics/servo_loop.h>
#include <ist/query/reference.h>
#include <ist/scene/scene_builder.h>
#include <ist/tree/tree_builder.h>

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
[[gnu::used, gnu::section("ist_layout")]] constexpr auto kNumbers = numbers_of<
    ist::TriangleMesh, ist::SphereTree, ist::SphereTree::Parts, ist::BuildOptions, ist::BuildReport,
    ist::CollisionOptions, ist::CollisionQuery, ist::ReferenceQuery, ist::ContactPoints,
    ist::ContactPoint, ist::ContactSums, ist::QueryResult, ist::ExactResult, ist::GapResult,
    ist::Budget, ist::Placement, ist::Vector6, ist::Response, ist::TouchSet, ist::BodyFrames,
    ist::TouchQuery, ist::Simulation, ist::Simulation::Parts, ist::Tick, ist::TickRecord, ist::Tool,
    ist::HandDevice, ist::ScriptDevice, ist::NullDevice, ist::FrictionEffect, ist::SnapEffect,
    ist::GravityEffect, ist::ServoOptions, ist::ServoOutputs, ist::ServoReport,
    ist::Snapshot<ist::TickRecord>, ist::TickRing<ist::TickRecord>, ist::Scene, ist::BuiltScene>(
    offsetof(ist::TriangleMesh, triangles), offsetof(ist::ContactPoint, weight),
    offsetof(ist::ContactSums, spring), offsetof(ist::QueryResult, pad),
    offsetof(ist::Placement, translation), offsetof(ist::Response, stiffness),
    offsetof(ist::BodyFrames, tool_origin), offsetof(ist::Simulation::Parts, dt),
    offsetof(ist::Tick, wrench), offsetof(ist::Tick, leaf_pairs), offsetof(ist::TickRecord, cpu_ns),
    offsetof(ist::BuiltScene, warnings), offsetof(ist::ServoReport, notes));

}  // namespace layout
