// Which of four bodies touch each other, before and after one of them moves?
#include <ist/ist.h>
#include <ist/models/models.h>

#include <cstdio>
#include <exception>

namespace {

Eigen::Isometry3d at(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

// The answer lists the pairs that are near each other. All other pairs are apart.
void print_pairs_that_touch(ist::World& world) {
  for (const ist::WorldPair& pair : world.ask({ist::WorldQuestion::kIntersects}).pairs) {
    if (pair.answer != ist::Answer::kYes) continue;
    std::printf("  %s and %s touch\n", world.name(pair.bodies.a).data(),
                world.name(pair.bodies.b).data());
  }
}

}  // namespace

int main() try {
  // A gate: a post stands on a plate, and a bar lies on the post. A ball lies on the plate.
  const ist::SphereTree plate = ist::build_tree(ist::make_box({-30, -30, -2}, {30, 30, 0}));
  const ist::SphereTree post = ist::build_tree(ist::make_cylinder(16, 3, 20));
  const ist::SphereTree bar = ist::build_tree(ist::make_box({-20, -1, -1}, {20, 1, 1}));
  const ist::SphereTree ball = ist::build_tree(ist::make_icosphere(4, 5));

  // The pose of a body maps its mesh to the world. Each body overlaps its support by 0.1.
  ist::World world;
  const ist::BodyIndex plate_body = world.add(plate, at(0, 0, 0), "plate");
  const ist::BodyIndex post_body = world.add(post, at(15, 0, -0.1), "post");
  world.add(bar, at(0, 0, 20.8), "bar");
  const ist::BodyIndex ball_body = world.add(ball, at(0, 0, 4.9), "ball");

  // The post is screwed to the plate, so nobody asks about this pair.
  world.ignore(plate_body, post_body);
  // This reserves the memory for all other pairs. The questions then allocate nothing.
  world.reserve();

  std::printf("the ball lies on the plate:\n");
  print_pairs_that_touch(world);
  world.set_pose(ball_body, at(0, 0, 14.9));
  std::printf("the ball is lifted by 10:\n");
  print_pairs_that_touch(world);
} catch (const std::exception& error) {
  // The text of an ist::Error names the place, the cause and the remedy.
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
