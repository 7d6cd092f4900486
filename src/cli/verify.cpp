#include "cli/verify.h"

#include <fmt/format.h>

#include <cstdio>
#include <optional>
#include <vector>

#include "cli/progress_bar.h"
#include "ist/query/promise/promise_check.h"

namespace ist::cli {
namespace {

// What is certain now, and what was not looked at.
std::string verdict(const PromiseCheck& check, SpherePolicy policy, std::size_t engines) {
  if (check.knows_geometry()) {
    return fmt::format(
        "the bounds of every contact meet, and every pair of voxels whose {} is there",
        is_implicit(policy) ? "cubes meet" : "triangles cross");
  }
  const char* agree = engines > 1 ? " and the engines agree," : "";
  return fmt::format(
      "the bounds of every contact meet,{} but no more is known: the trees hold no "
      "triangles: build them with --exact, or name meshes",
      agree);
}

}  // namespace

void verify(const Engines& engines, const Bodies& bodies,
            std::span<const Eigen::Isometry3d> poses) {
  const PromiseCheck check(bodies.fixed, bodies.moving, bodies.policy);
  {
    Progress progress;
    progress.begin_stage("verifying", poses.size());
    const ProgressBar bar(progress);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      std::vector<GivenAnswer> answers;
      for (const auto& engine : engines) {
        const QueryResult result = engine->ask(poses[i]).result;
        answers.push_back({result, engine->contacts()});
      }
      if (const std::optional<Breach> breach = check.check(poses[i], answers)) {
        throw PromiseBroken(fmt::format(
            "pose {}, engine {}: {}. This is a fault of ist: please report it with the bodies and "
            "the pose",
            i, engines[breach->answer]->name(), breach->what));
      }
      progress.add(1);
    }
  }
  std::fprintf(stderr, "verified: at each of %zu poses, %s\n", poses.size(),
               verdict(check, bodies.policy, engines.size()).c_str());
}

}  // namespace ist::cli
