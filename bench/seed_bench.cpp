// What the article that the method comes from has measured, measured again: voxels, octree, nodes
// and spheres of the lower jaw by voxel size, and how often a second two jaws can be asked by their
// distance. What is compared by its time takes turns, but for the voxels of each size.
#include "seed/sections.h"

namespace {

const int kRegistered = [] {
  ist::bench::add_voxels();
  ist::bench::add_levels();
  ist::bench::add_rates();
  return 0;
}();

}  // namespace
