#include <algorithm>

#include "ist/measure/signed_distance.h"
#include "ist/query/query.h"
#include "ist/query/world/world.h"
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
  // Distances as narrow as rounding allows, and nothing else.
  struct Narrowest {};
  IstPeer(const IstPeer& other, Narrowest)
      : Peer("ist_narrowest", Guarantee::kExact),
        fixed_(other.fixed_),
        moving_(other.moving_),
        query_(fixed_, moving_, options("")),
        tolerance_(0) {}

  [[nodiscard]] const char* target() const { return query_.target(); }

  [[nodiscard]] bool answers(Question question) const override {
    return tolerance_ > 0 || question == Question::kDistance;
  }
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
    const DistanceResult found = query_.distance(pose, tolerance_);
    nearest_ = found.nearest;
    return found.distance;
  }
  [[nodiscard]] std::optional<std::array<Eigen::Vector3d, 2>> nearest() const override {
    if (!nearest_) return {};
    return {{nearest_->fixed_point, nearest_->moving_point}};
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
  double tolerance_ = kTolerance;
  std::optional<NearPair> nearest_;
  std::vector<TrianglePair> pairs_ = std::vector<TrianglePair>(kPairs);
};

Peers make_peers(const TriangleMesh& fixed, const TriangleMesh& moving) {
  Peers peers;
  auto ist = std::make_unique<IstPeer>(fixed, moving);
  auto narrowest = std::make_unique<IstPeer>(*ist, IstPeer::Narrowest{});
  peers.push_back(std::move(ist));
  peers.push_back(std::move(narrowest));
  return peers;
}

// A World over one tree without voxels.
class IstCrowd final : public Crowd {
 public:
  explicit IstCrowd(const TriangleMesh& mesh) : tree_(build_tree(mesh)) {}

  void set_up(std::span<const Eigen::Vector3d> places) override {
    world_.emplace();
    for (const Eigen::Vector3d& place : places) world_->add(tree_, at(place));
    world_->reserve(kNearOfEach * places.size());
  }
  void move(std::span<const Eigen::Vector3d> places) override {
    for (std::size_t k = 0; k < places.size(); ++k) {
      static_cast<void>(world_->set_pose(static_cast<BodyIndex>(k), at(places[k])));
    }
  }
  std::uint64_t touching() override {
    const WorldAnswer answer = world_->ask({WorldQuestion::kIntersects});
    if (!answer.complete) return kNotKnown;
    std::uint64_t count = 0;
    for (const WorldPair& pair : answer.pairs) count += pair.answer == ist::Answer::kYes ? 1U : 0U;
    return count;
  }

 private:
  static constexpr std::size_t kNearOfEach = 8;
  static constexpr std::uint64_t kNotKnown = ~std::uint64_t{0};
  static Eigen::Isometry3d at(const Eigen::Vector3d& place) {
    return Eigen::Isometry3d(Eigen::Translation3d(place));
  }

  const SphereTree tree_;
  std::optional<World> world_;
};

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

Library ist_library() {
  return {"ist", IST_VERSION, make_peers, measure_points,
          [](const TriangleMesh& mesh) { return std::make_unique<IstCrowd>(mesh); }};
}

}  // namespace ist::bench
