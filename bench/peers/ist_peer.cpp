#include "peers/ist_peer.h"

#include "ist/query/collision_query.h"
#include "support/bodies.h"

namespace ist::bench {
namespace {

constexpr std::size_t kPairs = 1 << 16;

class IstPeer final : public Peer {
 public:
  IstPeer() : Peer("ist"), pairs_(kPairs) {}

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
  static CollisionOptions options() {
    CollisionOptions options;
    options.policy = SpherePolicy::kSlab;
    return options;
  }

  CollisionQuery query_{exact_trees(0.2).first, exact_trees(0.2).second, options()};
  std::vector<TrianglePair> pairs_;
};

}  // namespace

std::unique_ptr<Peer> make_ist_peer() { return std::make_unique<IstPeer>(); }

}  // namespace ist::bench
