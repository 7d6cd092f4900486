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

namespace ist {

/// Finds the point of one or more surfaces that lies deepest inside the other body: branch and
/// bound over clusters of triangles, triangles, and pieces of triangles. The one with the largest
/// bound comes first.
class DepthSearch {
 public:
  /// @param rounding of a distance that is measured, and of a point that is moved
  DepthSearch(std::vector<SurfaceInBody> sides, double rounding, const Budget& budget,
              const Proceed& proceed);

  /// A point of a surface, and where it is nearest to the other body's surface.
  struct Point {
    std::size_t side;
    std::uint32_t triangle;       ///< of the surface
    Eigen::Vector3d at, nearest;  ///< in the body's coordinates
    double depth;                 ///< no more than it is
  };

  /// Looks at the point of a triangle that is nearest to `near`, body coordinates: the better it
  /// is, the less is left to search.
  void begin_at(std::size_t side, std::uint32_t triangle, const Eigen::Vector3d& near);
  /// Searches until the depth is known to within `tolerance`. Returns whether it is.
  bool run(double tolerance);
  /// Returns whether the search ended because it kept kMostPieces pieces.
  [[nodiscard]] bool capped() const noexcept { return capped_; }

  /// Returns the deepest point so far.
  [[nodiscard]] const std::optional<Point>& deepest() const noexcept { return deepest_; }
  /// Returns what no point is deeper than.
  [[nodiscard]] double bound() const noexcept;
  [[nodiscard]] std::uint64_t points() const noexcept { return points_; }

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
  };
  static constexpr int kPiece = -1;

  struct Measured {
    double depth;   // negative outside
    bool is_known;  // else it may be outside
    NearestTriangle nearest;
  };
  Measured measure(std::uint32_t side, const Eigen::Vector3d& at,
                   std::optional<std::uint32_t> hint);
  void offer(std::uint32_t side, std::uint32_t triangle, const Eigen::Vector3d& at,
             const Measured& measured);
  [[nodiscard]] bool drops(double bound) noexcept;
  [[nodiscard]] double distance_to(std::uint32_t side, std::uint32_t triangle,
                                   const Eigen::Vector3d& p) const;
  [[nodiscard]] double depth_in_box(std::uint32_t side, const Eigen::Vector3d& at) const;
  [[nodiscard]] double depth_in_box(std::uint32_t side, const Corners& corners) const;
  void push(const Item& item);
  [[nodiscard]] bool drops_below(const Middle& parent, std::uint32_t side,
                                 const Eigen::Vector3d& at, double radius);
  void add_node(std::uint32_t side, int level, std::uint32_t index, const Middle* parent);
  void add_piece(std::uint32_t side, const Piece& piece, const Middle& parent);
  [[nodiscard]] bool goes_on(double first_bound);
  void open(const Item& item);
  [[nodiscard]] Corners corners(std::uint32_t side, std::uint32_t triangle) const;
  [[nodiscard]] double least() const noexcept { return deepest_ ? deepest_->depth : 0; }

  std::vector<SurfaceInBody> sides_;
  double rounding_;
  Budget budget_;
  const Proceed& proceed_;
  double tolerance_ = 0, dropped_ = 0;
  std::vector<Item> heap_;
  std::vector<Piece> pieces_;
  std::optional<Point> deepest_;
  std::uint64_t points_ = 0, looked_ = 0, asked_ = 0;
  bool capped_ = false;
};

}  // namespace ist
