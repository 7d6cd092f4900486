#include "ist/measure/pose_rows.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>
#include <vector>

#include "ist/base/float_environment.h"
#include "ist/base/parallel.h"
#include "ist/base/pose.h"
#include "ist/measure/require.h"
#include "ist/tree/tree_parts.h"

namespace ist {
namespace {

// Poses that a thread takes at a time.
constexpr std::size_t kPosesAtOnce = 4;
// Between two questions whether to go on.
constexpr std::chrono::milliseconds kSlice(20);

// A query, and the sums of its contacts. Points would cost time and are not part of a row.
struct Asker {
  Query* query;
  std::unique_ptr<Query> own;  // empty: the caller's
  std::unique_ptr<ContactManifold> manifold;
};

// The askers that no thread is using.
class Askers {
 public:
  Askers(const RowSearch& search, bool contacts) : search_(search), contacts_(contacts) {
    free_.push_back(with_sums({&search.query, nullptr, nullptr}));
  }

  Asker take() {
    {
      const std::lock_guard lock(mutex_);
      if (!free_.empty()) {
        Asker asker = std::move(free_.back());
        free_.pop_back();
        return asker;
      }
    }
    auto own = std::make_unique<Query>(search_.query.fixed(), search_.query.moving(),
                                       search_.query_options);
    Query* query = own.get();
    return with_sums({query, std::move(own), nullptr});
  }

  void give_back(Asker asker) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(asker));
  }

 private:
  Asker with_sums(Asker asker) const {
    if (contacts_) {
      ManifoldOptions options = search_.manifold_options;
      options.points = 0;
      asker.manifold = std::make_unique<ContactManifold>(
          asker.query->fixed(), asker.query->moving(), asker.query->policy(), options);
    }
    return asker;
  }

  const RowSearch& search_;
  bool contacts_;
  std::mutex mutex_;
  std::vector<Asker> free_;
};

PoseRow row_of(const Asker& asker, const Eigen::Isometry3d& pose, const RowQuestions& questions) {
  PoseRow row;
  row.rotation_error = rotation_error(pose);
  if (!project_to_rigid(pose)) {
    row.status = QueryStatus::kInvalidPose;
    return row;
  }
  Query& query = *asker.query;
  const auto ask = [&](const auto& verb) {
    query.forget();
    return verb();
  };
  if (questions.intersects) {
    row.intersects = ask([&] { return query.intersects(pose, questions.budget); });
  }
  if (questions.leaf_pairs) {
    row.leaf_pairs =
        ask([&] { return query.leaf_pairs(pose, std::span<LeafPair>(), questions.budget); });
  }
  if (questions.distance) {
    row.distance = ask([&] { return query.distance(pose, questions.tolerance, questions.budget); });
  }
  if (questions.contacts) {
    row.contacts = ask([&] { return query.contacts(pose, *asker.manifold, questions.budget); });
    row.sums = asker.manifold->sums();
  }
  if (questions.penetration) {
    row.penetration = ask([&] {
      return penetration(query, pose, questions.tolerance, {.budget = questions.budget});
    });
  }
  return row;
}

}  // namespace

bool answer_rows(const RowSearch& search, std::span<const Eigen::Isometry3d> poses,
                 const RowQuestions& questions, std::size_t threads,
                 const std::function<void(std::size_t, const PoseRow&)>& give,
                 const Proceed& proceed) {
  const ScopedFloatEnvironment environment;
  require_tolerance(questions.tolerance);
  if (questions.leaf_pairs || questions.contacts) {
    require_voxels(search.query.fixed(), "the fixed body");
    require_voxels(search.query.moving(), "the moving body");
  }
  if (questions.penetration) {
    require_triangles(search.query.fixed(), "the fixed body");
    require_triangles(search.query.moving(), "the moving body");
    // Made here, so that their loops have all threads.
    static_cast<void>(search.query.fixed().self_intersections());
    static_cast<void>(search.query.moving().self_intersections());
  }
  std::optional<ScopedThreadLimit> limit;
  if (threads > 0) limit.emplace(threads);
  Askers askers(search, questions.contacts);
  // A slice is as long as the last one was quick, and has work for every thread.
  const std::size_t most = threads > 0 ? std::min(threads, thread_count()) : thread_count();
  const std::size_t least = kPosesAtOnce * most;
  std::size_t slice = least;
  for (std::size_t done = 0; done < poses.size();) {
    if (proceed && !proceed(static_cast<double>(done) / static_cast<double>(poses.size()))) {
      return false;
    }
    const auto begin = std::chrono::steady_clock::now();
    const std::size_t count = std::min(slice, poses.size() - done);
    parallel_for(count, kPosesAtOnce, [&](std::size_t first, std::size_t end) {
      Asker asker = askers.take();
      for (std::size_t i = done + first; i < done + end; ++i) {
        give(i, row_of(asker, poses[i], questions));
      }
      askers.give_back(std::move(asker));
    });
    done += count;
    const auto spent = std::chrono::steady_clock::now() - begin;
    if (spent < kSlice / 2) slice *= 2;
    if (spent > kSlice) slice = std::max(slice / 2, least);
  }
  return true;
}

}  // namespace ist
