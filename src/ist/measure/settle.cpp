#include "ist/measure/settle.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "ist/base/direction.h"
#include "ist/base/float_environment.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/rigid_move.h"
#include "ist/base/throw_error.h"
#include "ist/measure/first_contact.h"
#include "ist/measure/settle_check.h"
#include "ist/measure/settle_frame.h"
#include "ist/measure/settle_search.h"
#include "ist/mesh/mesh.h"
#include "ist/tree/tree_parts.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;
using Status = Settlement::Status;

// Defaults, mm and rad.
constexpr double kLargestWay = 2, kLargestTurn = std::numbers::pi / 60, kReach = 0.05;
// The load point is the middle of the triangles that meet so far beyond first contact, mm.
constexpr double kBeyond = 1, kFirstContact = 0.01;
// The radius of gyration is at least this part of the body's size.
constexpr double kLeastRadius = 0.01;
// Poses that are tried if the given one is not free.
constexpr int kOpenings = 32;
constexpr std::size_t kMostMeeting = 1 << 20;

const TriangleMesh& mesh_of(const SphereTree& tree) { return parts_of(tree).triangles->mesh; }

// Returns a length of the options, or its default.
double length_or(double length, double otherwise, std::string_view name) {
  if (length == 0) return otherwise;
  if (length > 0 && std::isfinite(length)) return length;
  throw_error(ErrorCode::kArgumentInvalid, "{}: {} is not a length: give one above 0, or 0 for {}",
              name, length, otherwise);
}

// The length of 1 mm. Trees of known units have the same one.
double millimetre(const Query& query) {
  for (const SphereTree* tree : {&query.fixed(), &query.moving()}) {
    const double metres = metres_per_unit(tree->source().unit);
    if (metres > 0) return 1e-3 / metres;
  }
  return 1;
}

struct Expected {
  Vector load;    // moving coordinates
  double radius;  // of gyration about it
};

// The parts of the moving body that will touch: the triangles that meet 1 mm beyond the first
// contact. Without a contact, its box.
Expected expected_contacts(Query& query, const Eigen::Isometry3d& from, const Vector& closing,
                           double millimetre, const std::optional<Vector>& load) {
  const TriangleMesh& mesh = mesh_of(query.moving());
  Eigen::AlignedBox3d box;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t corner : t) box.extend(mesh.vertices[corner]);
  }
  const double size = 0.5 * length_in_order(box.sizes());
  Expected expected{load.value_or(box.center()), size / std::sqrt(3.0)};
  // As far as one body can be behind the other.
  const Vector middle = RigidMove(from)(query.moving().origin());
  const double far = length_in_order(difference(middle, query.fixed().origin())) +
                     query.fixed().bounding_radius() + query.moving().bounding_radius();
  const auto moved_by = [&](double way) {
    Eigen::Isometry3d pose = from;
    pose.translation() = sum(from.translation(), scaled(way, closing));
    return pose;
  };
  const FirstContact contact =
      first_contact(query, from, moved_by(far), kFirstContact * millimetre);
  if (contact.status != FirstContact::Status::kContact &&
      contact.status != FirstContact::Status::kGrazing) {
    return expected;
  }
  std::vector<TrianglePair> pairs(1 << 12);
  const Eigen::Isometry3d beyond = moved_by(contact.lower * far + kBeyond * millimetre);
  TrianglePairsResult found = query.triangle_pairs(beyond, pairs);
  if (found.truncated) {
    pairs.resize(
        static_cast<std::size_t>(std::min<std::uint64_t>(found.triangle_pairs, kMostMeeting)));
    found = query.triangle_pairs(beyond, pairs);
  }
  pairs.resize(
      static_cast<std::size_t>(std::min<std::uint64_t>(found.triangle_pairs, pairs.size())));
  std::vector<std::uint32_t> meeting;
  for (const TrianglePair& pair : pairs) meeting.push_back(pair.moving);
  std::sort(meeting.begin(), meeting.end());
  meeting.erase(std::unique(meeting.begin(), meeting.end()), meeting.end());
  struct Patch {
    Vector middle;
    double area;
  };
  std::vector<Patch> patches;
  double area = 0;
  Vector middles(0, 0, 0);
  for (const std::uint32_t index : meeting) {
    const Triangle& t = mesh.triangles[index];
    const Vector &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vector across = cross_in_order(difference(b, a), difference(c, a));
    patches.push_back({scaled(1.0 / 3, sum(sum(a, b), c)), length_in_order(across)});
    area += patches.back().area;
    add_to(middles, scaled(patches.back().area, patches.back().middle));
  }
  if (!(area > 0)) return expected;
  expected.load = load.value_or(scaled(1 / area, middles));
  double square = 0;
  for (const Patch& patch : patches) {
    square += patch.area / area * square_in_order(difference(patch.middle, expected.load));
  }
  expected.radius = std::max(std::sqrt(square), kLeastRadius * size);
  return expected;
}

}  // namespace

const char* to_string(Status status) noexcept {
  constexpr std::array kNames = {"rests",   "rests-level",  "left-the-box", "stopped",
                                 "unknown", "invalid-pose", "no-free-pose", "busy"};
  const auto at = static_cast<std::size_t>(status);
  return at < kNames.size() ? kNames[at] : "unknown";
}

Eigen::Isometry3d Settlement::pose() const noexcept {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation;
  pose.translation() = translation;
  return pose;
}

Settler::Settler(Query& query)
    : query_(query), bodies_(std::make_shared<const detail::SettleBodies>(query)) {}
Settler::Settler(Query& query, const Settler& like) : query_(query), bodies_(like.bodies_) {}
Settler::~Settler() = default;

Settlement Settler::settle(const Eigen::Isometry3d& pose, const SettleOptions& options) {
  const ScopedFloatEnvironment environment;
  Settlement settled;
  const double mm = millimetre(query_);
  const std::optional<Direction> direction = direction_of(options.closing);
  if (!direction) {
    throw_error(ErrorCode::kArgumentInvalid, "closing: ({}, {}, {}) is no direction: give another",
                options.closing[0], options.closing[1], options.closing[2]);
  }
  Vector free = direction->unit;  // the part of the direction that is not held
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (options.held[static_cast<std::size_t>(i)]) free[i] = 0;
  }
  const double part = length_in_order(free);
  if (!(part > 1e-9)) {
    throw_error(ErrorCode::kArgumentInvalid,
                "held: the axes along `closing` are held: free one of them, or close another way");
  }
  if (options.load_point && !options.load_point->allFinite()) {
    throw_error(ErrorCode::kArgumentInvalid, "load_point: it is not finite: give a point");
  }
  const double way = length_or(options.largest_way, kLargestWay * mm, "largest_way");
  const double turn = length_or(options.largest_turn, kLargestTurn, "largest_turn");
  if (turn > std::numbers::pi / 2) {
    throw_error(ErrorCode::kArgumentInvalid,
                "largest_turn: {} is more than a quarter turn: give less", turn);
  }
  settled.reach = length_or(options.reach, kReach * mm, "reach");
  settled.unit_guessed = query_.fixed().source().unit == LengthUnit::kUnknown &&
                         query_.moving().source().unit == LengthUnit::kUnknown;
  settled.load_guessed = !options.load_point;
  settled.rotation_error = rotation_error(pose);
  const std::optional<Eigen::Isometry3d> given = project_to_rigid(pose);
  if (!given) {
    settled.status = Status::kInvalidPose;
    return settled;
  }
  query_.forget();

  // A free pose to begin at.
  double opening = 0;
  Eigen::Isometry3d begin = *given;
  Answer is_begin_free = is_free(query_, begin);
  for (int i = 1; i <= kOpenings && is_begin_free == Answer::kNo; ++i) {
    opening = way * i / kOpenings;
    begin.translation() = difference(given->translation(), scaled(opening / part, free));
    is_begin_free = is_free(query_, begin);
  }
  settled.opened = opening > 0;
  if (is_begin_free != Answer::kYes) {
    settled.status = is_begin_free == Answer::kNo ? Status::kNoFreePose : Status::kBusy;
    return settled;
  }

  const Expected expected =
      expected_contacts(query_, begin, scaled(1 / part, free), mm, options.load_point);
  settled.load_point = expected.load;
  settled.radius = expected.radius;
  const SettleFrame frame(*given, expected.load);
  SettleLoad load{direction->unit, options.held, Vector6::Zero(), expected.radius, mm};
  Vector6 at = Vector6::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    load.limits[i] = way;
    load.limits[3 + i] = turn;
    at[i] = -(opening / part) * free[i];
  }
  SettleSearch search(query_, *bodies_, frame, load);
  const SettleSearch::End end = search.run(at, options.steps, options.proceed);
  settled.steps = search.steps();
  SettleProof proof = SettleProof::kBusy;
  if (end != SettleSearch::End::kBusy) {
    const SettleClaim claim{frame,        at,          load.limits,   direction->unit,
                            options.held, load.radius, settled.reach, mm};
    proof = check_settled(query_, claim, settled);
  }
  const Eigen::Isometry3d rest = frame.pose_at(at);
  settled.rotation = rest.linear();
  settled.translation = rest.translation();
  settled.moved = at;
  settled.closed = dot_in_order(direction->unit, {at[0], at[1], at[2]});
  switch (proof) {
    case SettleProof::kRests:
      settled.status = settled.level.empty() ? Status::kRests : Status::kRestsLevel;
      break;
    case SettleProof::kLeaves:
      settled.status = Status::kLeftTheBox;
      break;
    case SettleProof::kBusy:
      settled.status = Status::kBusy;
      break;
    case SettleProof::kNone:
      settled.status = end == SettleSearch::End::kDone ? Status::kUnknown : Status::kStopped;
  }
  return settled;
}

Settlement settle(Query& query, const Eigen::Isometry3d& pose, const SettleOptions& options) {
  return Settler(query).settle(pose, options);
}

}  // namespace ist
