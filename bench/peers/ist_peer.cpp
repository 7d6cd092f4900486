#include <algorithm>

#include "ist/measure/signed_distance.h"
#include "ist/query/query.h"
#include "ist/tree/sphere_tree.h"
#include "peers/libraries.h"
#include "simd/dispatch.h"

namespace ist::bench {
namespace {

constexpr std::size_t kPairs = 1 << 16;

class IstPeer final : public Peer {
 public:
  IstPeer(const TriangleMesh& fixed, const TriangleMesh& moving)
      : Peer("ist", Guarantee::kExact),
        fixed_(tree(fixed)),
        moving_(tree(moving)),
        query_(fixed_, moving_, options("")) {}
  IstPeer(const IstPeer& other, const std::string& target)
      : Peer("ist_" + target, Guarantee::kExact),
        fixed_(other.fixed_),
        moving_(other.moving_),
        query_(fixed_, moving_, options(target)) {}

  [[nodiscard]] const char* target() const { return query_.target(); }

  [[nodiscard]] bool answers(Question) const override { return true; }
  bool meets(const Eigen::Isometry3d& pose) override {
    query_.forget();  // as every peer begins afresh
    return query_.intersects(pose).answer == ist::Answer::kYes;
  }
  std::uint64_t pairs(const Eigen::Isometry3d& pose) override {
    return query_.triangle_pairs(pose, pairs_).triangle_pairs;
  }
  std::uint64_t candidates(const Eigen::Isometry3d& pose) override { return pairs(pose); }
  DistanceInterval distance(const Eigen::Isometry3d& pose) override {
    query_.forget();
    return query_.distance(pose, kTolerance).distance;
  }

 private:
  static SphereTree tree(const TriangleMesh& mesh) {
    BuildOptions options;
    options.voxel_size = voxel_size();
    options.spheres = SpherePolicy::kSlab;
    options.keep_triangles = true;
    return build_tree(mesh, options);
  }
  static QueryOptions options(const std::string& target) {
    QueryOptions options;
    options.policy = SpherePolicy::kSlab;
    options.target = target;
    return options;
  }

  const SphereTree fixed_, moving_;
  Query query_;
  std::vector<TrianglePair> pairs_ = std::vector<TrianglePair>(kPairs);
};

Peers make_peers(const TriangleMesh& fixed, const TriangleMesh& moving) {
  Peers peers;
  peers.push_back(std::make_unique<IstPeer>(fixed, moving));
  return peers;
}

// With signs and triangles, which nobody else is asked for; no farther than a little over 2 mm.
Library::MeasurePoints measure_points(const TriangleMesh& mesh) {
  const SphereTree tree = build_tree(mesh, {.voxel_size = voxel_size()});
  return [tree](std::span<const Eigen::Vector3d> points, std::span<double> distances) {
    const std::vector<SurfaceDistance> found = signed_distance(tree, points, 2.001);
    for (std::size_t i = 0; i < points.size(); ++i) distances[i] = std::abs(found[i].distance);
  };
}

}  // namespace

std::unique_ptr<Peer> ist_on(const Peer& ist, const std::string& target) {
  const auto& same = static_cast<const IstPeer&>(ist);
  const auto has = [&](const Kernels& kernels) { return target == kernels.target; };
  if (target == same.target() || std::ranges::none_of(all_kernels(), has)) return nullptr;
  return std::make_unique<IstPeer>(same, target);
}

Library ist_library() { return {"ist", IST_VERSION, make_peers, measure_points}; }

}  // namespace ist::bench
