#include "peers/ist_peer.h"

#include "ist/query/collision_query.h"
#include "ist/tree/tree_builder.h"

namespace ist::bench {
namespace {

constexpr std::size_t kPairs = 1 << 16;

class IstPeer final : public Peer {
 public:
  IstPeer(const TriangleMesh& fixed, const TriangleMesh& moving)
      : Peer("ist", Promise::kExact), fixed_(tree(fixed)), moving_(tree(moving)) {}

  [[nodiscard]] bool answers(Question) const override { return true; }
  bool meets(const Eigen::Isometry3d& pose) override { return query_.touches(pose) == Touch::kYes; }
  std::uint64_t pairs(const Eigen::Isometry3d& pose) override {
    return query_.collide_exact(pose, pairs_).triangle_pairs;
  }
  std::uint64_t candidates(const Eigen::Isometry3d& pose) override { return pairs(pose); }
  GapInterval distance(const Eigen::Isometry3d& pose) override {
    return query_.gap(pose, kTolerance).gap;
  }

 private:
  static SphereTree tree(const TriangleMesh& mesh) {
    BuildOptions options;
    options.voxel_size = voxel_size();
    options.spheres = SpherePolicy::kSlab;
    options.keep_triangles = true;
    return build_tree(mesh, options);
  }
  static CollisionOptions options() {
    CollisionOptions options;
    options.policy = SpherePolicy::kSlab;
    return options;
  }

  const SphereTree fixed_, moving_;
  CollisionQuery query_{fixed_, moving_, options()};
  std::vector<TrianglePair> pairs_ = std::vector<TrianglePair>(kPairs);
};

Peers make_peers(const TriangleMesh& fixed, const TriangleMesh& moving) {
  Peers peers;
  peers.push_back(std::make_unique<IstPeer>(fixed, moving));
  return peers;
}

}  // namespace

Library ist_library() { return {"ist", IST_VERSION, make_peers}; }

}  // namespace ist::bench
