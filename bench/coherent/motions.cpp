#include "coherent/motions.h"

#include <algorithm>
#include <cstdlib>
#include <random>
#include <string>

#include "loop/haptics/bodies/tool_contact_query.h"
#include "support/bodies.h"
#include "support/effort.h"

namespace ist::bench {
namespace {

std::size_t ticks(std::size_t most) { return quick() ? most / 10 : most; }

// The poses at which a scene's ticks ask, from `first` on.
Poses recorded(const Scene& scene, std::size_t first, std::size_t end) {
  BuiltScene built = build_scene(scene);
  const BodyFrames frames{
      scene.unit,
      {scene.fixed.front().rotation, scene.unit * scene.fixed.front().translation},
      built.origin};
  Poses poses;
  for (std::size_t i = 0; i < end; ++i) {
    if (i >= first) poses.push_back(frames.query_pose(built.simulation->tool_pose()));
    const Tick tick = built.simulation->tick(built.device->read(), {});
    built.device->write(tick.wrench, built.simulation->dt());
  }
  return poses;
}

// Closed in the first half, and held closed from then on.
Poses held_closed(Scene scene) {
  std::vector<Waypoint>& plan = std::get<HandSettings>(scene.device).plan;
  plan.resize(2);
  plan.push_back({1e6, plan[1].pose});
  return recorded(scene, ticks(4000), ticks(5000));
}

// By 1 µm and 10 µrad.
Poses trembling(double dz) {
  Poses poses;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < ticks(1000); ++i) {
    const Eigen::Vector3d shift(normal(random), normal(random), normal(random));
    const Eigen::Vector3d turn(normal(random), normal(random), normal(random));
    Eigen::Isometry3d pose = closing(dz);
    pose.translate(1e-3 * shift);
    pose.rotate(Eigen::AngleAxisd(1e-5 * turn.norm(), turn.normalized()));
    poses.push_back(pose);
  }
  return poses;
}

// Between two displacements, at a speed in mm/s; it turns round within a tick.
Poses to_and_fro(double from, double to, double speed) {
  Poses poses;
  double at = from, step = 1e-3 * speed;
  for (std::size_t i = 0; i < ticks(1500); ++i) {
    if (at + step > to || at + step < from) step = -step;
    at += step;
    poses.push_back(closing(at));
  }
  return poses;
}

constexpr Motion kMotions[] = {
    {"closing", [](const Scene& jaws) { return recorded(jaws, 0, ticks(6000)); }, true},
    {"held_closed", [](const Scene& jaws) { return held_closed(jaws); }},
    {"trembling/apart", [](const Scene&) { return trembling(-2); }},
    {"trembling/touching", [](const Scene&) { return trembling(-1.2); }},
    {"trembling/occlusion", [](const Scene&) { return trembling(0); }},
    {"1mm_s/touching", [](const Scene&) { return to_and_fro(-1.3, -1, 1); }},
    {"3mm_s/touching", [](const Scene&) { return to_and_fro(-1.3, -1, 3); }},
    {"10mm_s/apart", [](const Scene&) { return to_and_fro(-1.9, -1.6, 10); }},
    {"10mm_s/touching", [](const Scene&) { return to_and_fro(-1.3, -1, 10); }, true},
    {"10mm_s/occlusion", [](const Scene&) { return to_and_fro(-0.3, 0, 10); }},
    {"20mm_s/touching", [](const Scene&) { return to_and_fro(-1.3, -1, 20); }},
    {"30mm_s/apart", [](const Scene&) { return to_and_fro(-1.9, -1.6, 30); }},
    {"30mm_s/touching", [](const Scene&) { return to_and_fro(-1.3, -1, 30); }, true},
    {"30mm_s/occlusion", [](const Scene&) { return to_and_fro(-0.3, 0, 30); }},
    {"100mm_s/apart", [](const Scene&) { return to_and_fro(-1.9, -1.6, 100); }},
    {"100mm_s/touching", [](const Scene&) { return to_and_fro(-1.3, -1, 100); }, true},
};

}  // namespace

std::span<const Motion> motions() { return kMotions; }

std::vector<double> steps(const Poses& poses) {
  // A motion is affine, so no point of a box moves farther than one of its corners.
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : lower_jaw().vertices) box.extend(vertex);
  std::vector<double> all;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    double most = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d at = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
      most = std::max(most, (poses[i] * at - poses[i - 1] * at).norm());
    }
    all.push_back(most);
  }
  return all;
}

// The shipped scene with springs in place of contact, since springs have leaf pairs.
Scene scene_of_jaws(double voxel_size) {
  const bool real = std::string(pair_name()) == "human";
  if (real) setenv("IST_DATA_DIR", data_file("").parent_path().c_str(), 0);
  Scene scene = read_scene(scene_file(real ? "human_pair.toml" : "jaws.toml"));
  scene.workers = 1;
  scene.contact.reset();
  scene.friction.reset();
  scene.springs = SpringsSettings{.allow_breaking = true};
  scene.fixed.front().voxel_size = scene.held.front().voxel_size = voxel_size;
  return scene;
}

}  // namespace ist::bench
