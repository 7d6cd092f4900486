#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ist/constraint/features.h"
#include "ist/constraint/surface.h"
#include "ist/query/query.h"
#include "ist/query/relative_pose.h"

namespace ist {

/// A body's tree with the parts of its surface.
struct WallBody {
  /// Throws kTrianglesMissing.
  explicit WallBody(const SphereTree& of);

  SphereTree tree;
  Surface surface;  // of the tree's mesh
};

/// The features between a fixed and a held body, and the proof that a motion keeps the bodies
/// apart. Lengths are in mesh units; poses map held mesh coordinates to fixed mesh coordinates.
class WallPair {
 public:
  struct Options {
    int workers = 1;             ///< as QueryOptions
    double period = 1e-3;        ///< from one tick to the next, s
    std::size_t features = 512;  ///< the most that are listed
    std::string target = {};     ///< as QueryOptions
  };
  /// Reserves all memory. Throws the errors of Query.
  WallPair(std::shared_ptr<const WallBody> fixed, std::shared_ptr<const WallBody> held,
           const Options& options);

  /// Returns a length that the distance of the surfaces is not below, as far as it is known from
  /// earlier poses: 0 or less if nothing is known. Cost: 0.1 µs.
  [[nodiscard]] double clearance(const Eigen::Isometry3d& pose) const noexcept;

  struct Search {
    bool complete;        ///< the budget did not end it
    std::uint64_t tests;  ///< as Budget::tests counts them
    Found found;
  };
  /// Finds all pairs of triangles no farther apart than `margin`. If there are none, finds the
  /// distance, to within a half of `wanted`, if `wanted` is longer than the margin. A search that
  /// comes to its end does not depend on earlier ones. At the pose of the last search it costs
  /// nothing.
  /// Cost: Query::near_pairs and Query::distance.
  Search find(const Eigen::Isometry3d& pose, double margin, double wanted,
              const Budget& budget) noexcept;
  /// Forgets the clearance.
  void forget() noexcept {
    clear_ = 0;
    is_searched_ = false;
  }
  /// Whether find() found near pairs.
  [[nodiscard]] bool is_near() const noexcept { return near_count_ > 0; }
  /// The least distance of these pairs; the clearance without any.
  [[nodiscard]] double least_gap() const noexcept {
    return is_near() ? near_.front().distance : clear_;
  }
  /// Lists the features of these pairs.
  void list(FeatureList::Which which) noexcept;
  [[nodiscard]] std::span<const Feature> features() const noexcept { return list_.features(); }

  /// Decides whether the surfaces meet at a pose to which no point of the held body
  /// moves farther than `way` from the pose of find(). Precondition: the way is shorter than the
  /// margin, or than the clearance. kUnknown if the budget ended it, and if the last find() did not
  /// come to its end.
  [[nodiscard]] Answer meets(const Eigen::Isometry3d& pose, double way,
                             const Budget& budget) noexcept;

  [[nodiscard]] std::size_t bytes() const noexcept;
  /// Returns the bytes that a pair of these trees reserves.
  [[nodiscard]] static std::size_t bytes_for(const SphereTree& fixed, const SphereTree& held,
                                             const Options& options);

 private:
  std::shared_ptr<const WallBody> fixed_, held_;
  Eigen::AlignedBox3d box_;  // of the held mesh
  Query query_;
  std::vector<NearPair> near_;
  std::size_t near_count_ = 0;
  bool is_searched_ = false;  // the last find() came to its end, for asked_ and margin_
  RelativePose asked_{Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()};
  std::optional<FeatureList::Which> listed_;
  bool has_all_ = true;  // `near_` has all pairs within the margin
  double pad_ = 0, margin_ = 0;
  double wanted_ = 0;  // the clearance is known as well as this length asks
  RelativePose pose_{Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()};  // of find(), rigid
  double clear_ = 0;  // clearance at clear_pose_
  RelativePose clear_pose_{Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()};
  FeatureList list_;
};

}  // namespace ist
