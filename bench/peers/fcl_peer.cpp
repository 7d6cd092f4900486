#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/config.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>
#include <fcl/narrowphase/detail/traversal/distance/mesh_distance_traversal_node.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <limits>

#include "peers/libraries.h"

namespace ist::bench {
namespace {

constexpr bool kWithPoints = true;  // the nearest points are a part of the answer

using Model = fcl::BVHModel<fcl::OBBRSS<double>>;

std::shared_ptr<const Model> model_of(const TriangleMesh& mesh) {
  std::vector<fcl::Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) triangles.emplace_back(a, b, c);
  const auto model = std::make_shared<Model>();
  model->beginModel();
  model->addSubModel(mesh.vertices, triangles);
  model->endModel();
  return model;
}

class FclPeer : public Peer {
 public:
  FclPeer(std::shared_ptr<const Model> fixed, std::shared_ptr<const Model> moving)
      : Peer("fcl", Guarantee::kRounded), fixed_(std::move(fixed)), moving_(std::move(moving)) {}

  [[nodiscard]] bool answers(Question question) const override {
    return question != Question::kCandidates;
  }
  bool meets(const Eigen::Isometry3d& pose) override { return collide(pose, 1) > 0; }
  std::uint64_t pairs(const Eigen::Isometry3d& pose) override {
    return collide(pose, std::numeric_limits<std::size_t>::max());
  }
  DistanceInterval distance(const Eigen::Isometry3d& pose) override {
    fcl::DistanceResult<double> result;
    fcl::distance<double>(fixed_.get(), fcl::Transform3d::Identity(), moving_.get(), pose,
                          fcl::DistanceRequest<double>(kWithPoints), result);
    points_ = {result.nearest_points[0], result.nearest_points[1]};
    const double found = std::max(result.min_distance, 0.0);
    return {found, found};
  }
  [[nodiscard]] std::optional<std::array<Eigen::Vector3d, 2>> nearest() const override {
    return points_;
  }

 private:
  std::size_t collide(const Eigen::Isometry3d& pose, std::size_t most) {
    found_.clear();  // keeps its memory
    return fcl::collide<double>(fixed_.get(), fcl::Transform3d::Identity(), moving_.get(), pose,
                                fcl::CollisionRequest<double>(most, false), found_);
  }

  std::shared_ptr<const Model> fixed_, moving_;
  fcl::CollisionResult<double> found_;
  std::array<Eigen::Vector3d, 2> points_{};
};

// FCL's own rule ends where a bound is within the absolute error and within the relative one, which
// is 0 and so undoes the other. A great relative error would not mend it: where bounds overlap,
// their distance is 0, and so is its product, or not a number.
struct WithinTolerance final : fcl::detail::MeshDistanceTraversalNodeOBBRSS<double> {
  [[nodiscard]] bool canStop(double bound) const override {
    return bound >= result->min_distance - kTolerance;
  }
};

class FclWithinPeer final : public Peer {
 public:
  FclWithinPeer(std::shared_ptr<const Model> fixed, std::shared_ptr<const Model> moving)
      : Peer("fcl_within", Guarantee::kRounded),
        fixed_(std::move(fixed)),
        moving_(std::move(moving)) {}

  [[nodiscard]] bool answers(Question question) const override {
    return question == Question::kDistance;
  }
  DistanceInterval distance(const Eigen::Isometry3d& pose) override {
    fcl::DistanceResult<double> result;
    WithinTolerance node;
    fcl::detail::initialize<double>(node, *fixed_, fcl::Transform3d::Identity(), *moving_, pose,
                                    fcl::DistanceRequest<double>(kWithPoints), result);
    fcl::detail::distance<double>(&node);
    points_ = {result.nearest_points[0], result.nearest_points[1]};
    const double found = std::max(result.min_distance, 0.0);
    return {std::max(found - kTolerance, 0.0), found};
  }
  [[nodiscard]] std::optional<std::array<Eigen::Vector3d, 2>> nearest() const override {
    return points_;  // in the frame of the fixed mesh
  }

 private:
  std::shared_ptr<const Model> fixed_, moving_;
  std::array<Eigen::Vector3d, 2> points_{};
};

// DynamicAABBTreeCollisionManager over objects that share one model.
class FclCrowd final : public Crowd {
 public:
  explicit FclCrowd(const TriangleMesh& mesh)
      : model_(std::const_pointer_cast<Model>(model_of(mesh))) {}

  void set_up(std::span<const Eigen::Vector3d> places) override {
    manager_.reset();
    objects_.clear();
    manager_.emplace();
    std::vector<fcl::CollisionObject<double>*> all;
    for (const Eigen::Vector3d& place : places) {
      objects_.push_back(std::make_unique<fcl::CollisionObject<double>>(
          model_, fcl::Transform3d(Eigen::Translation3d(place))));
      all.push_back(objects_.back().get());
    }
    manager_->registerObjects(all);
    manager_->setup();
  }
  void move(std::span<const Eigen::Vector3d> places) override {
    for (std::size_t k = 0; k < objects_.size(); ++k) {
      objects_[k]->setTranslation(places[k]);
      objects_[k]->computeAABB();
    }
    manager_->update();
  }
  std::uint64_t touching() override {
    std::uint64_t count = 0;
    manager_->collide(&count, &count_touching);
    return count;
  }

 private:
  // Returns false to go on.
  static bool count_touching(fcl::CollisionObject<double>* a, fcl::CollisionObject<double>* b,
                             void* count) {
    fcl::CollisionResult<double> found;
    if (fcl::collide<double>(a, b, fcl::CollisionRequest<double>(1, false), found) > 0) {
      ++*static_cast<std::uint64_t*>(count);
    }
    return false;
  }

  std::shared_ptr<Model> model_;
  std::vector<std::unique_ptr<fcl::CollisionObject<double>>> objects_;
  std::optional<fcl::DynamicAABBTreeCollisionManager<double>> manager_;
};

Peers make_peers(const TriangleMesh& fixed, const TriangleMesh& moving) {
  const auto a = model_of(fixed), b = model_of(moving);
  Peers peers;
  peers.push_back(std::make_unique<FclPeer>(a, b));
  peers.push_back(std::make_unique<FclWithinPeer>(a, b));
  return peers;
}

}  // namespace

Library fcl_library() {
  return {"fcl", FCL_VERSION, make_peers, {}, [](const TriangleMesh& mesh) {
            return std::make_unique<FclCrowd>(mesh);
          }};
}

}  // namespace ist::bench
