#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

#include "ist/base/progress.h"
#include "ist/measure/point_search.h"
#include "ist/query/results.h"
#include "simd/triangles/ball_step.h"

namespace ist {

/// Triangles of a body that were nearest to points of one triangle, at most six: they bound the
/// depths of its pieces.
struct FewTriangles {
  std::array<std::uint32_t, 6> triangle{};
  std::uint8_t count = 0, next = 0;

  void add(std::uint32_t one) noexcept {
    for (std::size_t k = 0; k < count; ++k) {
      if (triangle[k] == one) return;
    }
    triangle[next] = one;
    next = static_cast<std::uint8_t>((next + 1U) % triangle.size());
    if (count < triangle.size()) ++count;
  }
};

/// How a search for a depth begins and ends.
struct DepthQuestion {
  double tolerance;
  double rounding;  ///< of a distance that is measured, and of a point that is moved
  const Budget& budget;
  const Proceed& proceed;
};

/// Finds the point of one or more surfaces that lies deepest inside the other body: branch and
/// bound over clusters of triangles, triangles, and pieces of triangles. The one with the largest
/// bound comes first. Clusters are bounded by points here, or by outer balls (DepthFront), which
/// then hands over single triangles.
class DepthSearch {
 public:
  explicit DepthSearch(std::vector<SurfaceInBody> sides);

  /// A point of a surface, and where it is nearest to the other body's surface.
  struct Point {
    std::size_t side;
    std::uint32_t triangle;       ///< of the surface
    Eigen::Vector3d at, nearest;  ///< in the body's coordinates
    std::uint32_t near_triangle;  ///< of the body
    double depth;                 ///< no more than it is
  };
  /// A triangle that was handed over: no point of its finished pieces is deeper than `bound`.
  struct Handed {
    double bound;
    FewTriangles near;
  };

  /// Forgets all earlier questions. Keeps the memory. `question` must outlive the search.
  void begin(const DepthQuestion& question) noexcept;
  /// Moves the surface of a side.
  void set_move(std::size_t side, const RigidMove& to_body) noexcept {
    sides_[side].to_body = to_body;
  }
  /// Looks at the point of a triangle that is nearest to `near`, body coordinates: the better it
  /// is, the less is left to search.
  void begin_at(std::size_t side, std::uint32_t triangle, const Eigen::Vector3d& near);
  /// Looks at the deepest point of an earlier question, and at a corner of its triangle.
  void begin_at(const Point& last);
  /// Adds all triangles of all surfaces.
  void add_surfaces();
  /// Adds a triangle that is nowhere deeper than `bound`. `near` may bound it; `has_served` says
  /// that its first one did before. Returns the triangle's place in handed().
  std::size_t add_triangle(std::uint32_t side, std::uint32_t triangle, double bound,
                           const FewTriangles& near, bool has_served);
  /// Returns the least bound of a triangle by the balls near its middle.
  [[nodiscard]] double bound_by_balls(std::uint32_t side, std::uint32_t triangle) const {
    return depth_by_balls(side, corners(side, triangle));
  }
  /// Measures a point of a triangle that is probably deep, and the corner that is farthest from
  /// what is nearest there.
  void probe(std::uint32_t side, std::uint32_t triangle);
  /// Notes that something that is nowhere deeper than `bound` is not searched.
  void leave(double bound) noexcept { dropped_ = std::max(dropped_, bound); }
  /// Searches until the depth is known to within the tolerance. Returns whether it is.
  bool run();
  /// Returns whether the budget and the caller let the search go on.
  [[nodiscard]] bool goes_on();
  /// Returns whether what has this bound needs no look.
  [[nodiscard]] bool is_settled(double bound) const noexcept { return bound <= limit(); }
  [[nodiscard]] double limit() const noexcept { return least() + tolerance_; }
  /// Returns whether the search ended because it kept kMostPieces pieces.
  [[nodiscard]] bool capped() const noexcept { return capped_; }

  /// Returns the deepest point so far.
  [[nodiscard]] const std::optional<Point>& deepest() const noexcept { return deepest_; }
  /// Returns what no point is deeper than.
  [[nodiscard]] double bound() const noexcept;
  [[nodiscard]] std::uint64_t points() const noexcept { return points_; }
  /// Returns the triangles that were handed over. Their bounds are complete after run().
  [[nodiscard]] const std::vector<Handed>& handed() const noexcept { return handed_; }
  [[nodiscard]] const SurfaceInBody& side(std::size_t side) const noexcept { return sides_[side]; }
  [[nodiscard]] double rounding() const noexcept { return rounding_; }

  /// The outer balls of a side's body, for triangles that are handed over.
  struct Balls {
    BallGrid grid;
    Eigen::Vector3d middle;
    double unit;
    float pad;  ///< of a bound, units
    BoundAroundFunction bound_around;
  };
  void set_balls(std::size_t side, const Balls& balls) { balls_[side] = balls; }

  /// Pieces of triangles that a search keeps at most: 4 million.
  static constexpr std::size_t kMostPieces = 1 << 22;

 private:
  using Corners = std::array<Eigen::Vector3d, 3>;
  // Where a node or a piece has its middle, in the body's coordinates.
  struct Middle {
    Eigen::Vector3d at;
    double depth;            // there, at most
    std::uint32_t triangle;  // the body's nearest one
  };
  // A node of a surface's clusters, or a piece of one of its triangles.
  struct Item {
    double bound;
    Middle middle;
    std::uint32_t side, index;  // of a node, or of a piece
    int level;                  // kPiece

    // Of two items one comes first in any library's heap.
    friend bool operator<(const Item& a, const Item& b) {
      return std::tie(a.bound, b.level, b.side, b.index) <
             std::tie(b.bound, a.level, a.side, a.index);
    }
  };
  struct Piece {
    Corners corner;  // in the body's coordinates
    std::uint32_t triangle;
    std::uint32_t handed = kNotHanded;  // the place in handed_
    int depth = 0;                      // how often it was quartered
  };
  static constexpr int kPiece = -1;
  static constexpr std::uint32_t kNotHanded = 0xFFFFFFFF;

  struct Measured {
    double depth;   // negative outside
    bool is_known;  // else it may be outside
    NearestTriangle nearest;
  };
  struct Farthest {
    double distance;
    std::size_t corner;
  };
  Measured measure(std::uint32_t side, const Eigen::Vector3d& at,
                   std::optional<std::uint32_t> hint);
  void offer(std::uint32_t side, std::uint32_t triangle, const Eigen::Vector3d& at,
             const Measured& measured);
  [[nodiscard]] bool drops(double bound) noexcept;
  [[nodiscard]] bool drops(double bound, Handed& of) noexcept;
  [[nodiscard]] double distance_to(std::uint32_t side, std::uint32_t triangle,
                                   const Eigen::Vector3d& p) const;
  [[nodiscard]] Farthest farthest(std::uint32_t side, std::uint32_t triangle,
                                  const Corners& corners) const;
  [[nodiscard]] double depth_in_box(std::uint32_t side, const Eigen::Vector3d& at) const;
  [[nodiscard]] double depth_in_box(std::uint32_t side, const Corners& corners) const;
  [[nodiscard]] double depth_by_balls(std::uint32_t side, const Corners& corners) const;
  void push(const Item& item);
  [[nodiscard]] bool drops_below(const Middle& parent, std::uint32_t side,
                                 const Eigen::Vector3d& at, double radius);
  void add_node(std::uint32_t side, int level, std::uint32_t index, const Middle* parent);
  void add_piece(std::uint32_t side, const Piece& piece, const Middle& parent);
  [[nodiscard]] bool is_new(std::uint32_t handed, const Eigen::Vector3d& corner) noexcept;
  void add_handed(std::uint32_t side, const Piece& piece, double bound, bool balls_first);
  void open(const Item& item);
  void open_piece(const Item& item);
  [[nodiscard]] Corners corners(std::uint32_t side, std::uint32_t triangle) const;
  [[nodiscard]] double least() const noexcept { return deepest_ ? deepest_->depth : 0; }

  std::vector<SurfaceInBody> sides_;
  std::vector<Balls> balls_;
  double rounding_ = 0, tolerance_ = 0, dropped_ = 0, first_bound_ = 0;
  const DepthQuestion* question_ = nullptr;
  std::vector<Item> heap_;
  std::vector<Piece> pieces_;
  std::vector<Handed> handed_;
  // The corners of pieces that were measured last.
  struct Looked {
    std::uint32_t handed = kNotHanded;
    Eigen::Vector3d at;
  };
  std::array<Looked, 32> looks_;
  std::size_t look_count_ = 0;
  std::optional<Point> deepest_;
  std::uint64_t points_ = 0, looked_ = 0, asked_ = 0;
  bool capped_ = false, ended_ = false;
};

}  // namespace ist
