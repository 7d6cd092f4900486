#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>

#include <limits>
#include <utility>

#include "ist/base/pose.h"
#include "peers/exact_parts.h"
#include "peers/libraries.h"

namespace ist::bench {
namespace {

// A mesh in Bullet's numbers, which its shape refers to.
class Body {
 public:
  explicit Body(const TriangleMesh& mesh) {
    vertices_.reserve(mesh.vertices.size());
    for (const Eigen::Vector3d& v : mesh.vertices) vertices_.push_back(v.cast<float>());
    indices_.reserve(mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles) {
      indices_.push_back({static_cast<int>(a), static_cast<int>(b), static_cast<int>(c)});
    }
    btIndexedMesh part;
    part.m_numTriangles = static_cast<int>(indices_.size());
    part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(indices_.data());
    part.m_triangleIndexStride = sizeof(indices_[0]);
    part.m_numVertices = static_cast<int>(vertices_.size());
    part.m_vertexBase = reinterpret_cast<const unsigned char*>(vertices_.data());
    part.m_vertexStride = sizeof(vertices_[0]);
    mesh_.addIndexedMesh(part, PHY_INTEGER);
    shape_ = std::make_unique<btGImpactMeshShape>(&mesh_);
    shape_->getMeshPart(0)->setMargin(0);
    shape_->updateBound();
    object_.setCollisionShape(shape_.get());
    object_.setWorldTransform(btTransform::getIdentity());
  }

  void move(const Eigen::Isometry3d& pose) {
    const Eigen::Matrix3f r = pose.linear().cast<float>();
    const Eigen::Vector3f t = pose.translation().cast<float>();
    const btMatrix3x3 rotation(r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0),
                               r(2, 1), r(2, 2));
    object_.setWorldTransform(btTransform(rotation, {t.x(), t.y(), t.z()}));
  }

  [[nodiscard]] btCollisionObjectWrapper wrapper() const {
    return {nullptr, shape_.get(), &object_, object_.getWorldTransform(), -1, -1};
  }
  [[nodiscard]] const btGImpactBoxSet* boxes() const { return shape_->getMeshPart(0)->getBoxSet(); }
  [[nodiscard]] const btTransform& transform() const { return object_.getWorldTransform(); }

 private:
  std::vector<Eigen::Vector3f> vertices_;
  std::vector<std::array<int, 3>> indices_;
  btTriangleIndexVertexArray mesh_;
  std::unique_ptr<btGImpactMeshShape> shape_;
  btCollisionObject object_;
};

struct Bodies {
  Bodies(const TriangleMesh& a, const TriangleMesh& b) : fixed(a), moving(b) {}
  Body fixed, moving;
};

// Receives contact points, those of a pair one after the other.
class PairList final : public btManifoldResult {
 public:
  PairList(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
           std::vector<std::pair<int, int>>& pairs)
      : btManifoldResult(a, b), pairs_(pairs) {}

  void setShapeIdentifiersA(int, int triangle) override { now_.first = triangle; }
  void setShapeIdentifiersB(int, int triangle) override { now_.second = triangle; }
  void addContactPoint(const btVector3&, const btVector3&, btScalar) override {
    if (pairs_.empty() || pairs_.back() != now_) pairs_.push_back(now_);
  }

 private:
  std::vector<std::pair<int, int>>& pairs_;
  std::pair<int, int> now_;
};

class BulletPeer final : public Peer {
 public:
  explicit BulletPeer(std::shared_ptr<Bodies> bodies)
      : Peer("bullet", Guarantee::kRounded), bodies_(std::move(bodies)) {
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
  }

  [[nodiscard]] bool answers(Question question) const override {
    return question == Question::kMeets || question == Question::kPairs;
  }
  bool meets(const Eigen::Isometry3d& pose) override { return pairs(pose) > 0; }
  std::uint64_t pairs(const Eigen::Isometry3d& pose) override {
    pairs_.clear();
    bodies_->moving.move(pose);
    const btCollisionObjectWrapper fixed = bodies_->fixed.wrapper();
    const btCollisionObjectWrapper moving = bodies_->moving.wrapper();
    PairList result(&fixed, &moving, pairs_);
    btGImpactCollisionAlgorithm algorithm({&dispatcher_, 0}, &fixed, &moving);
    algorithm.processCollision(&fixed, &moving, {}, &result);
    return pairs_.size();
  }

 private:
  const std::shared_ptr<Bodies> bodies_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  std::vector<std::pair<int, int>> pairs_;
};

class BulletBoxesPeer final : public Peer {
 public:
  BulletBoxesPeer(std::shared_ptr<Bodies> bodies, const TriangleMesh& fixed,
                  const TriangleMesh& moving)
      : Peer("bullet_boxes", Guarantee::kRounded),
        bodies_(std::move(bodies)),
        fixed_(fixed),
        moving_(moving) {}

  [[nodiscard]] bool answers(Question question) const override {
    return question != Question::kDistance;
  }
  bool meets(const Eigen::Isometry3d& pose) override { return list(pose, 1) > 0; }
  std::uint64_t pairs(const Eigen::Isometry3d& pose) override {
    return list(pose, std::numeric_limits<std::size_t>::max());
  }
  std::uint64_t candidates(const Eigen::Isometry3d& pose) override {
    boxes_.resizeNoInitialize(0);  // keeps its memory
    bodies_->moving.move(pose);
    btGImpactBoxSet::find_collision(bodies_->fixed.boxes(), bodies_->fixed.transform(),
                                    bodies_->moving.boxes(), bodies_->moving.transform(), boxes_);
    return static_cast<std::uint64_t>(boxes_.size());
  }

 private:
  std::size_t list(const Eigen::Isometry3d& pose, std::size_t most) {
    pairs_.clear();
    candidates(pose);
    const Eigen::Isometry3d rigid = *project_to_rigid(pose);
    for (int i = 0; i < boxes_.size() && pairs_.size() < most; ++i) {
      const auto a = static_cast<std::uint32_t>(boxes_[i].m_index1);
      const auto b = static_cast<std::uint32_t>(boxes_[i].m_index2);
      if (meet(corners(fixed_, a), moved(rigid, corners(moving_, b)))) pairs_.push_back({a, b});
    }
    return pairs_.size();
  }
  static TriangleCorners corners(const TriangleMesh& mesh, std::uint32_t triangle) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
  }

  const std::shared_ptr<Bodies> bodies_;
  const TriangleMesh &fixed_, &moving_;
  btPairSet boxes_;
  std::vector<TrianglePair> pairs_;
};

Peers make_peers(const TriangleMesh& fixed, const TriangleMesh& moving) {
  const auto bodies = std::make_shared<Bodies>(fixed, moving);
  Peers peers;
  peers.push_back(std::make_unique<BulletPeer>(bodies));
  peers.push_back(std::make_unique<BulletBoxesPeer>(bodies, fixed, moving));
  return peers;
}

}  // namespace

Library bullet_library() {
  const int version = btGetVersion();  // 324 is 3.24
  return {"bullet", std::to_string(version / 100) + "." + std::to_string(version % 100),
          make_peers};
}

}  // namespace ist::bench
