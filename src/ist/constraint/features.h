#pragma once

#include <Eigen/Geometry>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ist/base/api.h"
#include "ist/constraint/surface.h"
#include "ist/query/results.h"

namespace ist {

/// Two parts of two surfaces that are near each other, with their closest points. Fixed mesh
/// coordinates.
struct Feature {
  SurfacePart fixed, moving;
  TrianglePair triangles;       ///< that have these parts
  Eigen::Vector3d fixed_point,  ///< on the fixed surface
      moving_point,             ///< on the moving one
      normal;                   ///< of unit length, from the fixed point to the moving one
  double gap;                   ///< between the points
};

/// The features of two surfaces at a pose: each pair of parts once, in the order of the near pairs.
///
/// A motion that keeps every feature's gap open keeps the surfaces apart, to first order. Only
/// local minima of the distance are needed for that: features whose normal leaves both surfaces.
/// Edges and vertices inside plane regions are left out, because the corners of these regions say
/// the same. They stay if a corner is right above them. All other features would catch at seams.
class IST_LOOP_API FeatureList {
 public:
  /// The normal of a local minimum may ascend by so much, a sine. Surfaces that are nearly parallel
  /// have several minima that nearly tie.
  static constexpr double kTolerance = 0.02;

  /// Reserves room for `room` features. Refers to both surfaces.
  FeatureList(const Surface& fixed, const Surface& moving, std::size_t room);

  /// Which features are listed.
  enum class Which : std::uint8_t {
    kMinima,  ///< local minima of the distance
    kAll,
  };
  /// Lists the features of near pairs.
  /// @param near   in the order of their distance
  /// @param pose   maps moving mesh coordinates to fixed mesh coordinates; rigid
  /// @param margin features with a wider gap are left out
  /// @param tolerance the normal of a local minimum may ascend by so much, a sine
  /// Cost: 0.1 µs a pair without a minimum, 1 µs a pair with one.
  void find(std::span<const NearPair> near, const Eigen::Isometry3d& pose, double margin,
            Which which, double tolerance = kTolerance) noexcept;

  [[nodiscard]] std::span<const Feature> features() const noexcept { return features_; }
  /// Whether there was no room for all features. The list then has the nearest of each cell of
  /// space and octant of normals, as far as there is room.
  [[nodiscard]] bool is_thinned() const noexcept { return thinned_; }
  void clear() noexcept;
  [[nodiscard]] std::size_t bytes() const noexcept;
  /// Returns the bytes that a list with so much room reserves.
  [[nodiscard]] static std::size_t bytes_for(std::size_t room) noexcept;

 private:
  struct Key {
    std::uint64_t first, second;
    friend bool operator==(const Key&, const Key&) = default;
  };
  // Keys that were added since clear().
  class KeySet {
   public:
    explicit KeySet(std::size_t room) : slots_(slots_for(room)) {}
    /// Adds a key. Returns false if it is there already.
    bool add(const Key& key) noexcept;
    [[nodiscard]] bool is_full() const noexcept { return 2 * count_ >= slots_.size(); }
    void clear() noexcept;
    [[nodiscard]] std::size_t bytes() const noexcept { return slots_.capacity() * sizeof(Slot); }
    [[nodiscard]] static std::size_t bytes_for(std::size_t room) noexcept {
      return slots_for(room) * sizeof(Slot);
    }

   private:
    [[nodiscard]] static std::size_t slots_for(std::size_t room) noexcept {
      return std::bit_ceil(4 * room + 4);
    }
    struct Slot {
      Key key;
      std::uint32_t stamp = 0;
    };
    std::vector<Slot> slots_;  // a power of two, linear probing
    std::size_t count_ = 0;
    std::uint32_t stamp_ = 1;
  };

  // Returns whether the list is full.
  bool add(const NearPair& near, const SurfacePart& fixed, const SurfacePart& moving,
           const Eigen::Isometry3d& pose, bool minima, double cell) noexcept;
  bool list(std::span<const NearPair> near, const Eigen::Isometry3d& pose, double margin,
            bool minima, double cell) noexcept;

  const Surface &fixed_, &moving_;
  double tolerance_ = kTolerance;
  double cell_;  // edge of a cell of a list that is thinned, mesh units
  std::vector<Feature> features_;
  KeySet seen_, cells_;
  bool thinned_ = false;
};

}  // namespace ist
