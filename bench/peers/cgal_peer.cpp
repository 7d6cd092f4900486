#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Rigid_triangle_mesh_collision_detection.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/version.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <iterator>
#include <limits>

#include "ist/base/pose.h"
#include "peers/exact_parts.h"
#include "peers/libraries.h"

namespace ist::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Primitive =
    CGAL::AABB_face_graph_triangle_primitive<Mesh, CGAL::Default, CGAL::Tag_true, CGAL::Tag_true>;
using Traits = CGAL::AABB_traits<Kernel, Primitive>;
using Tree = CGAL::AABB_tree<Traits>;
using Transform = CGAL::Aff_transformation_3<Kernel>;

Mesh mesh_of(const TriangleMesh& mesh) {
  Mesh made;
  for (const Eigen::Vector3d& v : mesh.vertices) made.add_vertex({v.x(), v.y(), v.z()});
  for (const auto& [a, b, c] : mesh.triangles) {
    if (made.add_face(Mesh::Vertex_index(a), Mesh::Vertex_index(b), Mesh::Vertex_index(c)) !=
        Mesh::null_face()) {
      continue;
    }
    std::cerr << "cgal: these meshes are none to it: faces do not meet in twos along their edges\n";
    std::exit(1);
  }
  return made;
}

struct Body {
  explicit Body(const TriangleMesh& of)
      : mesh(mesh_of(of)), tree(faces(mesh).begin(), faces(mesh).end(), mesh) {
    tree.build();
  }
  const Mesh mesh;
  Tree tree;
};

Transform transform_of(const Eigen::Isometry3d& rigid) {
  const auto& m = rigid.matrix();
  return {m(0, 0), m(0, 1), m(0, 2), m(0, 3), m(1, 0), m(1, 1),
          m(1, 2), m(1, 3), m(2, 0), m(2, 1), m(2, 2), m(2, 3)};
}

Kernel::Triangle_3 moved(const Eigen::Isometry3d& rigid, const Kernel::Triangle_3& triangle) {
  const auto vector = [](const Kernel::Point_3& p) { return Eigen::Vector3d(p.x(), p.y(), p.z()); };
  const auto point = [](const Eigen::Vector3d& v) { return Kernel::Point_3(v.x(), v.y(), v.z()); };
  const TriangleCorners at =
      bench::moved(rigid, {vector(triangle[0]), vector(triangle[1]), vector(triangle[2])});
  return {point(at[0]), point(at[1]), point(at[2])};
}

using FacePair = std::pair<Mesh::Face_index, Mesh::Face_index>;

// Told of the moving tree's nodes and primitives, of which it enters those that meet the fixed one,
// until it has `most` pairs or a few more.
class ListPairs {
 public:
  ListPairs(const Tree& moving, const Eigen::Isometry3d& rigid, std::size_t most,
            std::vector<FacePair>& pairs)
      : traits_(moving.traits()),
        rigid_(rigid),
        transform_(transform_of(rigid)),
        most_(most),
        pairs_(pairs) {}

  [[nodiscard]] bool go_further() const { return pairs_.size() < most_; }
  [[nodiscard]] bool do_intersect(const Tree& fixed, const CGAL::AABB_node<Traits>& node) const {
    return fixed.do_intersect(boxes_.compute_transformed_bbox(transform_, node.bbox(), true));
  }
  void intersection(const Tree& fixed, const Primitive& primitive) {
    const auto datum = CGAL::internal::Primitive_helper<Traits>::get_datum(primitive, traits_);
    found_.clear();
    fixed.all_intersected_primitives(moved(rigid_, datum), std::back_inserter(found_));
    for (const Mesh::Face_index face : found_) pairs_.emplace_back(face, primitive.id());
  }

 private:
  const Traits& traits_;
  const Eigen::Isometry3d& rigid_;
  const Transform transform_;
  const std::size_t most_;
  std::vector<FacePair>& pairs_;
  std::vector<Mesh::Face_index> found_;
  CGAL::Traversal_traits_with_transformation_helper<Traits, Kernel, CGAL::Tag_true> boxes_;
};

struct Bodies {
  Bodies(const TriangleMesh& a, const TriangleMesh& b) : fixed(a), moving(b) {}
  Body fixed, moving;
};

class CgalPeer final : public Peer {
 public:
  explicit CgalPeer(std::shared_ptr<const Bodies> bodies)
      : Peer("cgal", Guarantee::kExact), bodies_(std::move(bodies)) {}

  [[nodiscard]] bool answers(Question question) const override {
    return question == Question::kMeets || question == Question::kPairs;
  }
  bool meets(const Eigen::Isometry3d& pose) override { return list(pose, 1) > 0; }
  std::uint64_t pairs(const Eigen::Isometry3d& pose) override {
    return list(pose, std::numeric_limits<std::size_t>::max());
  }

 private:
  std::size_t list(const Eigen::Isometry3d& pose, std::size_t most) {
    pairs_.clear();
    const Eigen::Isometry3d rigid = *project_to_rigid(pose);
    ListPairs found(bodies_->moving.tree, rigid, most, pairs_);
    const CGAL::Interval_nt_advanced::Protector upward;  // as the boxes are turned in intervals
    bodies_->moving.tree.traversal(bodies_->fixed.tree, found);
    return pairs_.size();
  }

  const std::shared_ptr<const Bodies> bodies_;
  std::vector<FacePair> pairs_;
};

class CgalRigidPeer final : public Peer {
 public:
  explicit CgalRigidPeer(std::shared_ptr<const Bodies> bodies)
      : Peer("cgal_rigid", Guarantee::kExact), bodies_(std::move(bodies)) {
    fixed_ = detection_.add_mesh(bodies_->fixed.tree, bodies_->fixed.mesh);
    moving_ = detection_.add_mesh(bodies_->moving.tree, bodies_->moving.mesh);
  }

  [[nodiscard]] bool answers(Question question) const override {
    return question == Question::kMeets;
  }
  bool meets(const Eigen::Isometry3d& pose) override {
    detection_.set_transformation(moving_, transform_of(*project_to_rigid(pose)));
    return !detection_.get_all_intersections(fixed_, std::array{moving_}).empty();
  }

 private:
  const std::shared_ptr<const Bodies> bodies_;
  CGAL::Rigid_triangle_mesh_collision_detection<Mesh, CGAL::Default, CGAL::Default, Tree>
      detection_;
  std::size_t fixed_ = 0, moving_ = 0;
};

Peers make_peers(const TriangleMesh& fixed, const TriangleMesh& moving) {
  const auto bodies = std::make_shared<const Bodies>(fixed, moving);
  Peers peers;
  peers.push_back(std::make_unique<CgalPeer>(bodies));
  peers.push_back(std::make_unique<CgalRigidPeer>(bodies));
  return peers;
}

// Unsigned, by the tree's own search, which a tree of points speeds up.
Library::MeasurePoints measure_points(const TriangleMesh& mesh) {
  const auto body = std::make_shared<Body>(mesh);
  body->tree.accelerate_distance_queries();
  return [body](std::span<const Eigen::Vector3d> points, std::span<double> distances) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d& p = points[i];
      distances[i] = std::sqrt(body->tree.squared_distance({p.x(), p.y(), p.z()}));
    }
  };
}

}  // namespace

Library cgal_library() { return {"cgal", CGAL_VERSION_STR, make_peers, measure_points}; }

}  // namespace ist::bench
