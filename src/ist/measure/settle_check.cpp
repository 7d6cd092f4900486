#include "ist/measure/settle_check.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "ist/base/ordered_vector.h"
#include "ist/base/rigid_move.h"
#include "ist/measure/balance.h"
#include "ist/measure/support_hull.h"
#include "ist/mesh/mesh.h"
#include "ist/tree/tree_parts.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;

// Lengths in millimetres: the widest gap of a contact, the reach of a group of contacts, the
// tolerance of the distance, and the most that may remain.
constexpr double kContact = 0.01, kGroup = 0.5, kDistance = 1e-5, kMostRemaining = 1e-3;
constexpr double kMostResidual = 1e-3;
// The weight of the cost beside the balance, and of a bend beside a gap.
constexpr double kCost = 0.01, kBend = 0.05;
// A smaller force, as a part of the load, holds nothing; and a smaller part of a contact across the
// others.
constexpr double kLeastForce = 1e-4, kLeastHold = 1e-2;
// Normals of one group differ by no more, a cosine; contacts that carry go against the load by
// more, a cosine.
constexpr double kAlike = 0.85, kCarries = 0.1;
constexpr std::size_t kMostIdle = 256;  // contacts without a force that are looked at
constexpr std::size_t kNearPairs = 1 << 14, kMostNearPairs = 1 << 18;

// Parts of both surfaces that are within a contact's gap of each other.
struct Row {
  NearPair parts;
  Vector normal;
  BalanceVector wrench;  // turns divided by the radius; then the cost
  double bend;
};

struct Surroundings {
  std::span<const NearPair> near;                 // all that is near
  std::vector<TrianglePair> by_fixed, by_moving;  // moving neighbours of a fixed one, and back
};

using Corners = std::array<Vector, 3>;

Corners corners(const TriangleMesh& mesh, std::uint32_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

// Returns a length by which no point of a triangle within `reach` of a point is lower than that
// point, along a unit vector `up`.
double drop_of(const Corners& triangle, const Vector& point, const Vector& up, double reach) {
  double lowest = HUGE_VAL;
  for (const Vector& corner : triangle) {
    lowest = std::min(lowest, dot_in_order(up, difference(corner, point)));
  }
  const Vector across =
      cross_in_order(difference(triangle[1], triangle[0]), difference(triangle[2], triangle[0]));
  const double square = square_in_order(across);
  double in_ball = -reach;
  if (square > 0) {
    const Vector normal = scaled(1 / std::sqrt(square), across);
    const double height = dot_in_order(normal, difference(triangle[0], point));
    const double spare = std::max(0.0, reach * reach - height * height);
    const double along = dot_in_order(up, normal);
    const double slope = std::sqrt(std::max(0.0, 1 - along * along));
    in_ball = height * along - slope * std::sqrt(spare);
  }
  return std::max(0.0, -std::max(lowest, in_ball));
}

bool is_edge(TrianglePart part) {
  return part == TrianglePart::kEdge0 || part == TrianglePart::kEdge1 ||
         part == TrianglePart::kEdge2;
}

// The ends of an edge of a triangle.
std::pair<Vector, Vector> ends_of(const Corners& triangle, TrianglePart edge) {
  const auto first =
      static_cast<std::size_t>(edge) - static_cast<std::size_t>(TrianglePart::kEdge0);
  return {triangle[first], triangle[(first + 1) % 3]};
}

class Proof {
 public:
  Proof(Query& query, const SettleClaim& claim, Settlement& settled)
      : query_(query),
        claim_(claim),
        settled_(settled),
        fixed_(parts_of(query.fixed()).triangles->mesh),
        moving_(parts_of(query.moving()).triangles->mesh),
        pose_(claim.frame.pose_at(claim.at)),
        move_(pose_),
        load_(claim.frame.load_at(claim.at)),
        contact_(kContact * claim.millimetre) {}

  SettleProof make() {
    const Answer free = is_free(query_, pose_);
    if (free == Answer::kUnknown || !find_rows()) return SettleProof::kBusy;
    settled_.free = free == Answer::kYes;
    const DistanceResult distance = query_.distance(pose_, kDistance * claim_.millimetre);
    if (distance.status != QueryStatus::kDone) return SettleProof::kBusy;
    settled_.distance = distance.distance;
    const auto forces = balance_load();
    find_level(forces);
    group(forces);
    find_margin(forces);
    if (!settled_.free || !(distance.distance.upper <= contact_)) return leaves();
    const bool rests = settled_.residual <= kMostResidual &&
                       settled_.remaining <= kMostRemaining * claim_.millimetre;
    return rests ? SettleProof::kRests : leaves();
  }

 private:
  [[nodiscard]] double way_at(double arm) const {
    const double turns = arm / claim_.radius;
    return claim_.reach * std::sqrt(1 + turns * turns);
  }

  bool find_rows() {
    double arm = 0;
    std::vector<NearPair> near(kNearPairs);
    const auto list = [&](double margin) {
      for (;;) {
        const NearPairsResult found = query_.near_pairs(pose_, margin, near);
        if (found.status != QueryStatus::kDone) return std::size_t{0};
        if (!found.truncated || near.size() >= kMostNearPairs) {
          return static_cast<std::size_t>(std::min<std::uint64_t>(found.near_pairs, near.size()));
        }
        near.resize(2 * near.size());
      }
    };
    const std::size_t touching = list(contact_);
    for (std::size_t i = 0; i < touching; ++i) {
      arm = std::max(arm, length_in_order(difference(near[i].moving_point, load_)));
    }
    const std::size_t count = touching > 0 ? list(contact_ + way_at(arm)) : 0;
    if (count < touching) return false;
    Surroundings around{std::span(near).first(count), {}, {}};
    for (const NearPair& pair : around.near) {
      around.by_fixed.push_back(pair.triangles);
      around.by_moving.push_back({pair.triangles.moving, pair.triangles.fixed});
    }
    std::sort(around.by_fixed.begin(), around.by_fixed.end());
    std::sort(around.by_moving.begin(), around.by_moving.end());
    for (std::size_t i = 0; i < count && !(near[i].distance > contact_); ++i) {
      std::array<NearPair, Query::kMostNearParts> parts;
      const NearPairsResult found =
          query_.near_parts(pose_, near[i].triangles, contact_, std::span(parts));
      if (found.status != QueryStatus::kDone) return false;
      const auto kinds = std::min<std::size_t>(found.near_pairs, parts.size());
      for (const NearPair& part : std::span(parts).first(kinds)) add(part, around);
    }
    return true;
  }

  void add(const NearPair& parts, const Surroundings& around) {
    const Vector normal = parts.direction();
    if (!(square_in_order(normal) > 0)) return;
    const Vector arm = difference(parts.moving_point, load_);
    const Vector6 wrench = claim_.frame.bound_at(claim_.at, normal, arm);
    Row row{parts, normal, {}, 0};
    for (std::size_t i = 0; i < 6; ++i) {
      const double number = wrench[static_cast<Eigen::Index>(i)];
      row.wrench[i] = claim_.held[i] ? 0 : number / (i < 3 ? 1 : claim_.radius);
    }
    const double length = length_in_order(arm), way = way_at(length);
    const double angle = claim_.reach / claim_.radius;
    row.bend = bend_of(parts, normal, way, around) + angle * (angle * length + way);
    row.wrench[6] = kCost * (parts.distance + kBend * row.bend) / claim_.reach;
    rows_.push_back(row);
  }

  // How far a point goes through the plane of a contact if it goes round a curved surface, within
  // `way`. One flat side is enough.
  double bend_of(const NearPair& parts, const Vector& normal, double way,
                 const Surroundings& around) const {
    const auto [fixed, moving] = parts.triangles;
    if (is_edge(parts.fixed_part) && is_edge(parts.moving_part)) {
      // Two edges cross until the crossing comes to an end of one.
      const auto first = ends_of(corners(fixed_, fixed), parts.fixed_part);
      auto second = ends_of(corners(moving_, moving), parts.moving_part);
      second = {move_(second.first), move_(second.second)};
      const Vector u = difference(first.second, first.first);
      const Vector v = difference(second.second, second.first);
      const double sine =
          length_in_order(cross_in_order(u, v)) / (length_in_order(u) * length_in_order(v));
      const auto left = [](const auto& ends, const Vector& point) {
        return std::min(length_in_order(difference(ends.first, point)),
                        length_in_order(difference(ends.second, point)));
      };
      const double shift = way / sine;
      if (left(first, parts.fixed_point) > shift && left(second, parts.moving_point) > shift) {
        return 0;
      }
    }
    double of_fixed = 0, of_moving = 0;
    const auto neighbours = [](const std::vector<TrianglePair>& all, std::uint32_t of) {
      const auto begin = std::lower_bound(all.begin(), all.end(), TrianglePair{of, 0});
      const auto end = std::upper_bound(begin, all.end(), TrianglePair{of, 0xFFFFFFFF});
      return std::span<const TrianglePair>(all).subspan(
          static_cast<std::size_t>(begin - all.begin()), static_cast<std::size_t>(end - begin));
    };
    for (const TrianglePair& pair : neighbours(around.by_moving, moving)) {
      of_fixed =
          std::max(of_fixed, drop_of(corners(fixed_, pair.moving), parts.fixed_point, normal, way));
    }
    const Vector down = scaled(-1, normal);
    for (const TrianglePair& pair : neighbours(around.by_fixed, fixed)) {
      Corners other = corners(moving_, pair.moving);
      for (Vector& corner : other) corner = move_(corner);
      of_moving = std::max(of_moving, drop_of(other, parts.moving_point, down, way));
    }
    return std::min(of_fixed, of_moving);
  }

  [[nodiscard]] BalanceVector load_vector() const {
    BalanceVector load = {};
    for (std::size_t i = 0; i < 3; ++i) {
      load[i] = claim_.held[i] ? 0 : claim_.closing[static_cast<Eigen::Index>(i)];
    }
    return load;
  }

  [[nodiscard]] static Vector6 wrench_of(const Row& row) { return Vector6::Map(row.wrench.data()); }

  [[nodiscard]] static double rest_of(std::span<const BalanceVector> columns,
                                      const BalanceVector& load,
                                      const std::vector<BalanceForce>& forces) {
    BalanceVector rest = load;
    for (const auto& [column, force] : forces) {
      for (std::size_t i = 0; i < 6; ++i) rest[i] += force * columns[column][i];
    }
    double square = 0;
    for (std::size_t i = 0; i < 6; ++i) square += rest[i] * rest[i];
    return std::sqrt(square);
  }

  std::vector<BalanceForce> balance_load() {
    for (const Row& row : rows_) columns_.push_back(row.wrench);
    const std::vector<BalanceForce> forces = balance(columns_, load_vector());
    settled_.residual = rest_of(columns_, load_vector(), forces);
    settled_.remaining = claim_.reach * settled_.residual;
    settled_.second_order = 0;
    for (const auto& [row, force] : forces) {
      settled_.remaining += force * rows_[row].parts.distance;
      settled_.second_order += force * rows_[row].bend;
    }
    return forces;
  }

  // Whether contacts and borders of the box balance the load.
  SettleProof leaves() const {
    std::vector<BalanceVector> columns = columns_;
    for (std::size_t i = 0; i < 6; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      if (claim_.held[i] || !(std::abs(claim_.at[at]) >= (1 - 1e-9) * claim_.limits[at])) continue;
      BalanceVector border = {};
      border[i] = claim_.at[at] > 0 ? -1 : 1;
      columns.push_back(border);
    }
    if (columns.size() == columns_.size()) return SettleProof::kNone;
    const std::vector<BalanceForce> forces = balance(columns, load_vector());
    return rest_of(columns, load_vector(), forces) <= kMostResidual ? SettleProof::kLeaves
                                                                    : SettleProof::kNone;
  }

  // The directions across all wrenches that have a force.
  void find_level(const std::vector<BalanceForce>& forces) {
    std::vector<Vector6> basis;
    const auto across = [&](Vector6 v) {
      for (int pass = 0; pass < 2; ++pass) {
        for (const Vector6& axis : basis) {
          double part = 0;
          for (Eigen::Index i = 0; i < 6; ++i) part += axis[i] * v[i];
          for (Eigen::Index i = 0; i < 6; ++i) v[i] -= part * axis[i];
        }
      }
      return v;
    };
    const auto length = [](const Vector6& v) {
      double square = 0;
      for (Eigen::Index i = 0; i < 6; ++i) square += v[i] * v[i];
      return std::sqrt(square);
    };
    std::vector<Vector6> wrenches;
    for (const auto& [row, force] : forces) {
      if (!(force > kLeastForce)) continue;
      const Vector6 wrench = wrench_of(rows_[row]);
      wrenches.push_back(wrench / length(wrench));
    }
    // The one that is most across comes next.
    const auto take = [&](std::vector<Vector6>& from, double least) {
      for (;;) {
        double most = least;
        Vector6 best = Vector6::Zero();
        for (const Vector6& v : from) {
          const Vector6 rest = across(v);
          if (length(rest) > most) {
            most = length(rest);
            best = rest;
          }
        }
        if (!(most > least)) return;
        basis.push_back(best / most);
      }
    };
    take(wrenches, kLeastHold);
    // Contacts without a force hold as well if they do so together, from both sides.
    std::vector<BalanceVector> idle;
    for (const Row& row : rows_) {
      if (row.bend > contact_ || idle.size() == kMostIdle) continue;
      const Vector6 wrench = wrench_of(row);
      const Vector6 rest = across(wrench / length(wrench));
      if (!(length(rest) > kLeastHold)) continue;
      idle.emplace_back();
      for (std::size_t i = 0; i < 6; ++i) idle.back()[i] = rest[static_cast<Eigen::Index>(i)];
    }
    wrenches.clear();
    for (const BalanceVector& one : idle) {
      const Vector6 wrench(Vector6::Map(one.data()));
      if (length(across(wrench)) > kLeastHold &&
          rest_of(idle, one, balance(idle, one)) <= kMostResidual) {
        wrenches.push_back(wrench);
        take(wrenches, kLeastHold);
      }
    }
    const std::size_t rank = basis.size();
    std::vector<Vector6> axes;
    for (std::size_t i = 0; i < 6; ++i) {
      if (!claim_.held[i]) axes.push_back(Vector6::Unit(static_cast<Eigen::Index>(i)));
    }
    take(axes, 0.1);
    for (std::size_t i = rank; i < basis.size(); ++i) {
      Vector6 level = basis[i];
      for (Eigen::Index k = 3; k < 6; ++k) level[k] /= claim_.radius;
      const Vector turn = claim_.frame.turn_at(claim_.at, {level[3], level[4], level[5]});
      for (Eigen::Index k = 0; k < 3; ++k) level[3 + k] = turn[k];
      settled_.level.push_back(level);
    }
  }

  void group(const std::vector<BalanceForce>& forces) {
    std::vector<double> force_of(rows_.size());
    for (const auto& [row, force] : forces) force_of[row] = force;
    const double reach = kGroup * claim_.millimetre;
    std::vector<SettleContact> groups;
    std::vector<Vector> places, directions;  // of the first row
    std::vector<TrianglePair> last;          // counted
    std::vector<std::size_t> order(rows_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return force_of[a] != force_of[b] ? force_of[a] > force_of[b] : a < b;
    });
    for (const std::size_t i : order) {
      const Row& row = rows_[i];
      const auto belongs = [&](std::size_t g) {
        return square_in_order(difference(places[g], row.parts.fixed_point)) <= reach * reach &&
               dot_in_order(directions[g], row.normal) > kAlike;
      };
      std::size_t g = 0;
      while (g < groups.size() && !belongs(g)) ++g;
      if (g == groups.size()) {
        if (!(force_of[i] > 0) && row.bend > contact_)
          continue;  // it goes round, and holds nothing
        groups.push_back({Vector(0, 0, 0), Vector(0, 0, 0), 0, HUGE_VAL, {}, 0});
        places.push_back(row.parts.fixed_point);
        directions.push_back(row.normal);
        last.push_back({0xFFFFFFFF, 0xFFFFFFFF});
      }
      SettleContact& contact = groups[g];
      add_to(contact.point, scaled(force_of[i], row.parts.fixed_point));
      add_to(contact.normal, scaled(force_of[i], row.normal));
      contact.force += force_of[i];
      if (row.parts.distance < contact.gap) {
        contact.gap = row.parts.distance;
        contact.triangles = row.parts.triangles;
      }
      if (row.parts.triangles != last[g]) ++contact.pairs;
      last[g] = row.parts.triangles;
    }
    for (std::size_t g = 0; g < groups.size(); ++g) {
      SettleContact& contact = groups[g];
      const double length = length_in_order(contact.normal);
      const bool pushes = contact.force > 0 && length > 0;
      contact.point = pushes ? scaled(1 / contact.force, contact.point) : places[g];
      contact.normal = pushes ? scaled(1 / length, contact.normal) : directions[g];
      contact.force = pushes ? length : 0;
    }
    std::stable_sort(groups.begin(), groups.end(),
                     [](const auto& a, const auto& b) { return a.force > b.force; });
    settled_.contacts = std::move(groups);
  }

  void find_margin(const std::vector<BalanceForce>& forces) {
    std::vector<Vector> carrying;
    const auto add = [&](const Row& row) {
      if (-dot_in_order(row.normal, claim_.closing) < kCarries) return;
      carrying.push_back(difference(row.parts.fixed_point, load_));
    };
    for (const auto& [row, force] : forces) add(rows_[row]);
    for (const Row& row : rows_) {
      if (row.bend <= contact_) add(row);
    }
    const SupportHull hull(carrying, claim_.closing);
    settled_.margin = hull.margin();
    const bool turns = !(claim_.held[3] && claim_.held[4] && claim_.held[5]);
    settled_.rocks = turns && !(settled_.margin > 0);
  }

  Query& query_;
  const SettleClaim& claim_;
  Settlement& settled_;
  const TriangleMesh &fixed_, &moving_;
  Eigen::Isometry3d pose_;
  RigidMove move_;
  Vector load_;
  double contact_;
  std::vector<Row> rows_;
  std::vector<BalanceVector> columns_;
};

// Whether all corners of a mesh lie in the box round another one.
bool fits(const TriangleMesh& inner, const TriangleMesh& outer, const RigidMove& to_outer) {
  Eigen::AlignedBox3d box;
  for (const Triangle& t : outer.triangles) {
    for (const std::uint32_t corner : t) box.extend(outer.vertices[corner]);
  }
  return std::all_of(inner.triangles.begin(), inner.triangles.end(), [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](std::uint32_t corner) {
      return box.contains(to_outer(inner.vertices[corner]));
    });
  });
}

}  // namespace

Answer is_free(Query& query, const Eigen::Isometry3d& pose) {
  const IntersectionResult surfaces = query.intersects(pose);
  if (surfaces.status != QueryStatus::kDone) return Answer::kUnknown;
  if (surfaces.answer != Answer::kNo) return Answer::kNo;
  const TriangleMesh& fixed = parts_of(query.fixed()).triangles->mesh;
  const TriangleMesh& moving = parts_of(query.moving()).triangles->mesh;
  const bool in_fixed =
      query.fixed().orientation() == Orientation::kOutward && fits(moving, fixed, RigidMove(pose));
  const bool in_moving = query.moving().orientation() == Orientation::kOutward &&
                         fits(fixed, moving, RigidMove(inverse_of(pose)));
  if (!in_fixed && !in_moving) return Answer::kYes;
  const InsideResult inside = query.inside(pose);
  if (inside.status != QueryStatus::kDone) return Answer::kUnknown;
  const bool is_inside = (in_fixed && inside.inside == Inside::kMoving) ||
                         (in_moving && inside.inside == Inside::kFixed);
  return is_inside ? Answer::kNo : Answer::kYes;
}

SettleProof check_settled(Query& query, const SettleClaim& claim, Settlement& settled) {
  return Proof(query, claim, settled).make();
}

}  // namespace ist
