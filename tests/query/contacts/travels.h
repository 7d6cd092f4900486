#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "query/contacts/pair_sums.h"
#include "query/scenes.h"

namespace ist::test {

inline constexpr double kStep = 1e-4;  // mm, of a way

/// A way of the moving body: steps of kStep, or turns about the origin of its tree's frame by as
/// much at the lever.
struct Way {
  const char* name;
  Eigen::Isometry3d from;
  Eigen::Vector3d along = Eigen::Vector3d::Zero();  // of unit length, or nothing
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();   // of unit length, or nothing
  int steps;

  [[nodiscard]] Eigen::Isometry3d at(int step, double lever, const Eigen::Vector3d& centre) const {
    Eigen::Isometry3d pose = from;
    pose.translation() += kStep * step * along;
    if (axis.norm() > 0) {
      pose = pose * Eigen::Translation3d(centre) * Eigen::AngleAxisd(kStep * step / lever, axis) *
             Eigen::Translation3d(-centre);
    }
    return pose;
  }
  [[nodiscard]] double motion() const { return kStep * ((along.norm() + axis.norm()) * 1.000001); }
};

/// Two bodies, and ways of the moving one.
struct TravelBodies {
  const char* name;
  SphereTree fixed, moving;
  std::vector<Way> ways;
};

/// Some of all kinds, in millimetres; voxels of 0.4 mm and coarser, so that a step is little.
[[nodiscard]] std::vector<TravelBodies> all_bodies();

/// Two bodies on one way: what they have in common at each step, and how far a step goes.
class Travel {
 public:
  Travel(const TravelBodies& bodies, const Way& way, SpherePolicy policy, double margin)
      : bodies_(bodies),
        way_(way),
        query_(bodies.fixed, bodies.moving, options_of(policy)),
        manifold_(bodies.fixed, bodies.moving, policy, {.points = 0, .margin = margin}) {}

  [[nodiscard]] const ContactRates& rates() const { return manifold_.rates(); }
  [[nodiscard]] int steps() const { return way_.steps; }
  /// Of a step, mm, with the rounding of both its ends.
  [[nodiscard]] double motion() const {
    return way_.motion() + 2 * rounding_of(bodies_.fixed, manifold_);
  }
  [[nodiscard]] std::vector<LeafPair> leaf_pairs(int step) {
    return ask(query_, at(step)).leaf_pairs;
  }
  [[nodiscard]] ContactSums sums(int step) {
    static_cast<void>(query_.contacts(at(step), manifold_));
    return manifold_.sums();
  }
  /// Of each pair that has a weight.
  [[nodiscard]] std::map<LeafPair, ContactSums> sums_of_pairs(int step) {
    std::map<LeafPair, ContactSums> sums;
    for (const PairSums& pair :
         sums_by_pair(query_, manifold_, bodies_.fixed, bodies_.moving, at(step))) {
      sums[pair.leaves] = pair.sums;
    }
    return sums;
  }

 private:
  [[nodiscard]] Eigen::Isometry3d at(int step) const {
    return way_.at(step, rates().lever, bodies_.moving.origin());
  }
  const TravelBodies& bodies_;
  const Way& way_;
  Query query_;
  ContactManifold manifold_;
};

/// `check` of all bodies on all their ways.
template <class Check>
void for_each_travel(SpherePolicy policy, double margin, const Check& check) {
  for (const TravelBodies& bodies : all_bodies()) {
    for (const Way& way : bodies.ways) {
      SCOPED_TRACE(std::string(bodies.name) + ", " + way.name);
      Travel travel(bodies, way, policy, margin);
      check(travel);
    }
  }
}

}  // namespace ist::test
