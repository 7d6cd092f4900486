#pragma once

namespace ist::bench {

/// Registers worlds/ARRANGEMENT/LIBRARY: a thousand balls of 1,280 triangles share one structure,
/// which is made before. Each library that has worlds sets one up, asks how many pairs intersect,
/// moves all balls and asks again, in turn with the others, for some part of `seconds`. Who finds
/// other pairs than IST fails.
void add_worlds(double seconds);

}  // namespace ist::bench
