#pragma once

#include <Eigen/Cholesky>

#include "ist/haptics/effects/effect.h"
#include "support/random.h"

namespace ist::test {

inline Vector6 six(const Eigen::Vector3d& translation, const Eigen::Vector3d& rotation) {
  Vector6 motion;
  motion << translation, rotation;
  return motion;
}

/// A question to an effect; owns all that its input refers to.
struct EffectCase {
  Placement tool;
  ToolContacts contacts, proximity;
  double dt = 1e-3;

  [[nodiscard]] EffectInput input() const { return {tool, contacts, proximity, dt}; }
  /// A contact of one point for each leaf pair.
  void add_contact(const ToolContact& point) {
    contacts.add(point);
    contacts.spring +=
        point.stiffness_fraction * point.depth * six(point.normal, point.arm.cross(point.normal));
    contacts.count += point.stiffness_fraction;
  }
};

/// A few points about the tool, pressed by up to 0.1 mm.
inline EffectCase random_case(Random& random, int points) {
  EffectCase c;
  c.tool = Placement{}.moved(six(random.point(-1, 1), random.point(-1, 1)));
  for (int i = 0; i < points; ++i) {
    const double depth = random.uniform(2e-5, 1e-4), fraction = random.uniform(0.1, 1);
    c.add_contact({random.point(-0.02, 0.02), random.direction(), depth, fraction});
    c.proximity.add({random.point(-0.02, 0.02), random.direction(), 0, fraction});
  }
  return c;
}

inline Response respond(const Effect& effect, const EffectCase& c,
                        const Vector6& motion = Vector6::Zero()) {
  Response response;
  effect.respond(c.input(), motion, response);
  return response;
}

/// -d wrench / d motion, by central differences.
inline Matrix6 measured_stiffness(const Effect& effect, const EffectCase& c, const Vector6& motion,
                                  double step) {
  Matrix6 stiffness;
  for (int i = 0; i < 6; ++i) {
    Vector6 less = motion, more = motion;
    less[i] -= step;
    more[i] += step;
    stiffness.col(i) =
        (respond(effect, c, less).wrench - respond(effect, c, more).wrench) / (more[i] - less[i]);
  }
  return stiffness;
}

/// The largest difference of two stiffnesses, as a part of the first.
inline double difference(const Matrix6& a, const Matrix6& b) {
  return (a - b).cwiseAbs().maxCoeff() / a.cwiseAbs().maxCoeff();
}

inline bool is_symmetric_and_semidefinite(const Matrix6& stiffness) {
  const double size = stiffness.cwiseAbs().maxCoeff();
  if ((stiffness - stiffness.transpose()).cwiseAbs().maxCoeff() > 1e-14 * size) return false;
  return Eigen::LDLT<Matrix6>(stiffness + 1e-14 * size * Matrix6::Identity()).isPositive();
}

/// The needs of an effect, in order: normals, depth, velocity, proximity, triangles.
inline std::array<bool, 5> asked(const EffectNeeds& needs) {
  return {needs.normals, needs.depth, needs.velocity, needs.proximity, needs.triangles};
}

}  // namespace ist::test
