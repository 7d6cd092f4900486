#pragma once

namespace ist::bench {

/// Registers points/distances/LIBRARY/POSE: each library that can measures the distances of the
/// vertices of both bodies that are within 2 mm of the other one, in turn, for `seconds` a
/// pose, at closing_poses(). Who differs from IST fails.
void add_points(double seconds);

}  // namespace ist::bench
