// A program of someone who ports the lookup table: it needs the model alone.
#include <ist/hardware/pair_test.h>
#include <ist/hardware/quantized_pose.h>
#include <ist/hardware/table_rom.h>
#include <ist/ist.h>
#include <ist/models/models.h>

#include <cstdio>

int main() {
  const ist::SphereTree tree = ist::build_tree(
      ist::make_icosphere(1, 1.0), {.voxel_size = 0.25, .spheres = ist::SpherePolicy::kTable});
  const ist::QuantizedPose pose = ist::quantize_pose(Eigen::Isometry3d::Identity(), tree, tree);
  const bool holds =
      ist::table_rom()[255] == 4U << 9 && ist::table_checksum() != 0 && pose.rotation[0] != 0;
  std::printf("%s\n", holds ? "the table is there" : "the table is wrong");
  return holds ? 0 : 1;
}
