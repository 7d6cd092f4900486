#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ist/constraint/nearest_motion.h"
#include "ist/haptics/effects/effect.h"
#include "ist/haptics/simulation.h"
#include "loop/haptics/bodies/hand_bodies.h"
#include "loop/haptics/bodies/pair_queries.h"
#include "loop/haptics/wall/wall_pair.h"

namespace ist {

/// The numbers of a Wall, in metres.
struct WallSettings {
  double skin;          ///< gap that a contact keeps
  double trust;         ///< longest way of a held surface in a step near a fixed body
  int steps = 3;        ///< of a tick, at most
  double friction = 0;  ///< a contact slides at this ratio of tangential to normal force
};

/// Keeps the tool out of all fixed bodies. The tool is a proxy of the hand: it moves to the balance
/// of coupling and effects, as far as its contacts let it, and never intersects a fixed body.
///
/// A step lists the features near the tool, and bounds the tool's motion by
///
///     n · (v + w × r) >= skin - gap
///
/// for each of them. NearestMotion finds the motion; the bounds' multipliers are the contact
/// forces. The step is no longer than the trust, so triangles that were not listed cannot meet,
/// and its end is proven free by the exact triangles.
///
/// Source: M. Ortega, S. Redon and S. Coquillart, A six degree-of-freedom god-object method for
/// haptic display of rigid bodies with surface properties, IEEE Transactions on Visualization and
/// Computer Graphics 13(3), 2007. Friction: M. Anitescu, Optimization-based simulation of nonsmooth
/// rigid multibody dynamics, Mathematical Programming 105, 2006: its cone, of eight directions.
class Wall {
 public:
  explicit Wall(const WallSettings& settings);

  /// Adds a pair of bodies. Reserves memory.
  void add(const HandPair& bodies, std::unique_ptr<WallPair> pair);
  /// Adds a pair without a query. The tool goes no farther than the balls of its
  /// bodies let it.
  void add_far(const HandPair& bodies);

  [[nodiscard]] const WallSettings& settings() const noexcept { return settings_; }
  [[nodiscard]] std::size_t pairs() const noexcept { return pairs_.size(); }
  [[nodiscard]] std::size_t bytes() const noexcept;

  /// Makes steps near a fixed body shorter: this part of the trust. Less is near then.
  void shorten_steps(double part) noexcept { step_ = part * settings_.trust; }

  /// Returns whether a motion of the tool certainly leaves it free, without any search.
  /// @param way of any held point against any fixed body, at most, m
  [[nodiscard]] bool is_clear(const HandBodies& bodies, const Placement& tool,
                              double way) const noexcept;

  /// Finds all that is near the tool. Fills `contacts` with the features, for effects. Returns
  /// whether the budget let it come to its end.
  /// @param wanted the longest way that the next motion may take, m
  /// @param result counts the tests, and takes the least distance of all pairs, mesh units
  bool find(const HandBodies& bodies, const Placement& tool, double wanted, const Budget& budget,
            QueryResult& result, ToolContacts& contacts) noexcept;
  /// The longest way that find() allows, m.
  [[nodiscard]] double trust() const noexcept { return trust_; }
  /// Whether find() found anything near.
  [[nodiscard]] bool is_near() const noexcept;
  /// Whether the bodies of a pair meet, or are as near as in a contact.
  enum class Touch : std::uint8_t { kApart, kTouching, kMeeting, kUnknown };
  /// Returns the closest touch of all pairs with this body.
  [[nodiscard]] Touch touch(const HandBodies& bodies, const Placement& tool, std::size_t body,
                            const Budget& budget) noexcept;

  /// How the bounds of a motion are made.
  struct Bounding {
    FeatureList::Which features = FeatureList::Which::kMinima;
    bool asks_for_skin = true;  ///< a gap that is too narrow opens
  };
  /// Bounds the motion of the next step. Fixed bodies drift in it.
  NearestMotion& bound(const HandBodies& bodies, const Placement& tool,
                       const Bounding& how) noexcept;
  /// The bounds that were made last.
  [[nodiscard]] NearestMotion& bounds() noexcept { return motion_; }
  /// Returns how far a bound may be violated, m.
  [[nodiscard]] double tolerance() const noexcept { return 1e-6 * settings_.skin; }

  /// Decides whether the tool meets a fixed body at a pose. kUnknown if a budget ended it.
  /// @param bodies at their places at that time
  /// @param way    as for is_clear(), from the pose of find()
  [[nodiscard]] Answer meets(const HandBodies& bodies, const Placement& tool, double way,
                             const Budget& budget) noexcept;

  /// Notes the contacts that push at the motion that was solved last.
  void note_contacts(const HandBodies& bodies) noexcept;
  /// Makes the contacts that were noted last the tool's.
  void keep_contacts() noexcept { std::swap(contacts_, noted_); }
  void drop_contacts() noexcept { contacts_.clear(); }
  [[nodiscard]] std::span<const ContactPoint> contacts() const noexcept { return contacts_; }
  /// Forgets earlier poses.
  void forget() noexcept;

 private:
  struct Pair {
    HandPair bodies;
    std::unique_ptr<WallPair> pair;
    bool asked;  // by the last find()
  };
  // The feature of a bound, and the direction of its push.
  struct BoundOf {
    std::size_t pair, feature;
    Eigen::Vector3d along;
  };

  [[nodiscard]] double margin() const noexcept { return settings_.skin + step_; }
  [[nodiscard]] double clearance(const HandBodies& bodies, const Pair& pair,
                                 const Placement& tool) const noexcept;
  void add_to(ToolContacts& contacts, const Pair& pair, const BodyFrames& frames,
              const Placement& tool) const noexcept;
  void bound(const BoundOf& of, const Eigen::Vector3d& arm, double least,
             const Vector6& drift) noexcept;

  WallSettings settings_;
  double step_;  // the trust in use, m
  std::vector<Pair> pairs_;
  std::vector<HandPair> far_;
  NearestMotion motion_;
  std::vector<BoundOf> bounds_;
  std::vector<ContactPoint> contacts_, noted_;
  double trust_ = 0;
};

}  // namespace ist
