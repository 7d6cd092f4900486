#include <algorithm>
#include <memory>
#include <mutex>
#include <utility>

#include "ist/base/direction.h"
#include "ist/base/float_environment.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/parallel.h"
#include "ist/base/rigid_move.h"
#include "ist/measure/settle.h"

namespace ist {
namespace {

using Vector = Eigen::Vector3d;

// mm
constexpr double kSameHeight = 0.01, kSamePlace = 0.5;
// A contact with less force, as a part of the load, may be missing in a rest of the same group.
constexpr double kCounts = 0.02;

// A thread's own query. The first is the caller's.
struct OwnSettler {
  std::unique_ptr<Query> query;
  std::unique_ptr<Settler> settler;
};

bool has_contacts_of(const Settlement& a, const Settlement& b, double reach) {
  const RigidMove to_moving_a(inverse_of(a.pose())), to_moving_b(inverse_of(b.pose()));
  return std::all_of(a.contacts.begin(), a.contacts.end(), [&](const SettleContact& contact) {
    if (!(contact.force >= kCounts)) return true;
    const Vector place = to_moving_a(contact.point);
    return std::any_of(b.contacts.begin(), b.contacts.end(), [&](const SettleContact& other) {
      return square_in_order(difference(to_moving_b(other.point), place)) <= reach * reach;
    });
  });
}

}  // namespace

std::vector<Settlement> settle_all(Query& query, std::span<const Eigen::Isometry3d> poses,
                                   const SettleOptions& options, const Proceed& proceed) {
  const ScopedFloatEnvironment environment;
  SettleOptions each = options;
  each.proceed = {};
  const Settler first(query);
  std::mutex mutex;
  std::vector<OwnSettler> idle;
  const auto take = [&]() -> OwnSettler {
    {
      const std::lock_guard lock(mutex);
      if (!idle.empty()) {
        OwnSettler own = std::move(idle.back());
        idle.pop_back();
        return own;
      }
    }
    OwnSettler own;
    own.query = std::make_unique<Query>(query.fixed(), query.moving(),
                                        QueryOptions{.target = query.target()});
    own.settler = std::make_unique<Settler>(*own.query, first);
    return own;
  };
  std::vector<Settlement> settled(poses.size());
  const std::size_t slice = 2 * thread_count();
  for (std::size_t done = 0; done < poses.size(); done += slice) {
    if (proceed && !proceed(static_cast<double>(done) / static_cast<double>(poses.size()))) break;
    parallel_for(std::min(slice, poses.size() - done), 1, [&](std::size_t begin, std::size_t end) {
      OwnSettler own = take();
      for (std::size_t i = done + begin; i < done + end; ++i) {
        settled[i] = own.settler->settle(poses[i], each);
      }
      const std::lock_guard lock(mutex);
      idle.push_back(std::move(own));
    });
  }
  return settled;
}

std::vector<SettleGroup> group_settled(std::span<const Settlement> settled, const Vector& closing,
                                       double millimetre) {
  const ScopedFloatEnvironment environment;
  const auto direction = direction_of(closing);
  if (!direction) return {};
  std::vector<SettleGroup> groups;
  for (std::size_t i = 0; i < settled.size(); ++i) {
    const Settlement& one = settled[i];
    if (one.status != Settlement::Status::kRests && one.status != Settlement::Status::kRestsLevel) {
      continue;
    }
    const double height = dot_in_order(direction->unit, RigidMove(one.pose())(one.load_point));
    const auto is_same = [&](const SettleGroup& group) {
      const Settlement& other = settled[group.best];
      const double away = height - group.height, reach = kSamePlace * millimetre;
      return away * away <= kSameHeight * kSameHeight * millimetre * millimetre &&
             has_contacts_of(one, other, reach) && has_contacts_of(other, one, reach);
    };
    const auto group = std::find_if(groups.begin(), groups.end(), is_same);
    if (group == groups.end()) {
      groups.push_back({i, {i}, height});
      continue;
    }
    group->members.push_back(i);
    if (one.remaining < settled[group->best].remaining) {
      group->best = i;
      group->height = height;
    }
  }
  std::stable_sort(groups.begin(), groups.end(),
                   [](const SettleGroup& a, const SettleGroup& b) { return a.height > b.height; });
  return groups;
}

}  // namespace ist
