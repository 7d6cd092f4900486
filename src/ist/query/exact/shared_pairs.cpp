#include "ist/query/exact/shared_pairs.h"

#include <algorithm>

#include "ist/query/workers/patience.h"

namespace ist {
namespace {

// Fewer pairs of nodes above clusters, some 0.4 µs each, are not worth sharing; and of more the
// caller searches alone.
constexpr std::size_t kFewestNodes = 192, kMostNodes = 1 << 16;
constexpr std::size_t kMostTasks = 1 << 13;
// The pairs of nodes of a chunk: some 5 µs of work.
constexpr std::size_t kChunkNodes = 16, kMostChunks = kMostNodes / kChunkNodes;
constexpr std::size_t kFoundPairs = 1 << 18;

}  // namespace

// Takes the tasks of a search, as far as there is room.
class SharedPairs::Tasks {
 public:
  static constexpr bool kMostFirst = false, kMeasuresRest = false;

  Tasks(SharedPairs& to, float reach) noexcept : to_(to), reach_(reach) {
    to.node_count_ = to.task_count_ = 0;
  }
  [[nodiscard]] float reach() const noexcept { return reach_; }
  [[nodiscard]] bool full() const noexcept { return full_; }
  bool take(const ClusterTask& task) noexcept {
    full_ = task.nodes.count > kMostNodes - to_.node_count_ || to_.task_count_ == to_.tasks_.size();
    if (full_) return false;
    std::copy_n(task.nodes.codes, task.nodes.count, to_.nodes_.data() + to_.node_count_);
    to_.tasks_[to_.task_count_++] = {task.moving, task.fixed_level, to_.node_count_,
                                     task.nodes.count};
    to_.node_count_ += task.nodes.count;
    return true;
  }

 private:
  SharedPairs& to_;
  float reach_;
  bool full_ = false;
};

SharedPairs::SharedPairs(const TriangleClusters& fixed, const TriangleClusters& moving,
                         const ClusterKernels& kernels, std::chrono::nanoseconds period)
    : kernels_(kernels),
      period_(period),
      nodes_(kMostNodes + kClusterWidth),
      tasks_(kMostTasks),
      chunk_ends_(kMostChunks),
      queue_(chunk_ends_.size()),
      helper_(fixed, moving, kernels),
      found_{std::vector<TrianglePair>(kFoundPairs)},
      parts_(chunk_ends_.size()),
      job_([](void* self) noexcept { static_cast<SharedPairs*>(self)->help(); }, this) {}

SharedPairs::~SharedPairs() {
  worker_.retract(job_);
  job_.wait_idle();
}

bool SharedPairs::run(ClusterSearch& search, const Meshes& meshes, BudgetMeter& meter,
                      AllPairs<PairList>& all, PairList& list) noexcept {
  worker_.tick(std::chrono::steady_clock::now(), period_);
  ++sharing_.queries;
  if (meter.budget().has_tests() || job_.busy()) return search.run(meter, all);
  BudgetMeter above = meter;
  Tasks tasks(*this, all.reach());
  const bool whole = search.run(above, tasks);
  if (tasks.full()) return search.run(meter, all);
  meter = above;
  if (!whole) return false;
  if (node_count_ < kFewestNodes) {
    for (std::size_t i = 0; i < task_count_; ++i) {
      if (!search.run(task(i), meter, all)) return false;
    }
    return true;
  }
  ++sharing_.worth;
  helper_.begin(search.step().pose);
  meshes_.emplace(meshes);
  cut();
  return do_chunks(search, meter, all, list);
}

ClusterTask SharedPairs::task(std::size_t index) const noexcept {
  const Task& task = tasks_[index];
  return {task.moving, task.fixed_level, {nodes_.data() + task.first, task.count}};
}

void SharedPairs::cut() noexcept {
  chunk_count_ = 0;
  std::size_t nodes = 0;
  for (std::size_t i = 0; i < task_count_; ++i) {
    nodes += tasks_[i].count;
    if (nodes < kChunkNodes && i + 1 < task_count_) continue;
    chunk_ends_[chunk_count_++] = i + 1;
    nodes = 0;
  }
  epoch_ = queue_.open(chunk_count_);
}

template <class Visitor>
bool SharedPairs::do_chunk(std::size_t chunk, ClusterSearch& search, BudgetMeter& meter,
                           Visitor& visitor) const noexcept {
  for (std::size_t i = chunk == 0 ? 0 : chunk_ends_[chunk - 1]; i < chunk_ends_[chunk]; ++i) {
    if (!search.run(task(i), meter, visitor)) return false;
  }
  return true;
}

bool SharedPairs::do_chunks(ClusterSearch& search, BudgetMeter& meter, AllPairs<PairList>& all,
                            PairList& list) noexcept {
  // With back-to-back queries the worker starts polling in the middle of one, so the job is offered
  // before each chunk.
  bool taken = worker_.offer(job_), in_time = true;
  while (in_time) {
    const auto chunk = queue_.claim_front();
    if (!chunk) break;
    in_time = do_chunk(*chunk, search, meter, all);
    if (!taken) taken = worker_.offer(job_);
  }
  for (std::size_t chunk = queue_.close(); chunk < chunk_count_ && in_time; ++chunk) {
    if (queue_.collect(chunk, patience(meter.budget())) && parts_[chunk].whole) {
      const Part& part = parts_[chunk];
      for (std::size_t k = part.begin; k < part.begin + part.count; ++k) list.add(found_.pairs[k]);
      meter.spend(part.tests);
      ++sharing_.chunks;
    } else {
      ++sharing_.dropped;
      in_time = do_chunk(chunk, search, meter, all);
    }
  }
  if (taken && !worker_.retract(job_)) ++sharing_.shared;
  return in_time;
}

void SharedPairs::help() noexcept {
  std::size_t used = 0;
  while (const auto chunk = queue_.claim_back(epoch_)) {
    hand_over(HandOver::kClaimed);
    found_.count = used;
    AllPairs<Found> all({helper_.step(), kernels_, *meshes_, memory_, {}}, found_);
    BudgetMeter meter;
    do_chunk(*chunk, helper_, meter, all);
    all.finish();
    const bool whole = found_.count <= found_.pairs.size();
    parts_[*chunk] = {used, found_.count - used, meter.spent(), whole};
    if (whole) used = found_.count;
    hand_over(HandOver::kWorked);
    queue_.complete(epoch_, *chunk);
  }
}

std::size_t SharedPairs::bytes() const noexcept {
  return helper_.bytes() + memory_.bytes() + found_.pairs.size() * sizeof(TrianglePair) +
         nodes_.size() * sizeof(std::uint32_t) + tasks_.size() * sizeof(Task) +
         chunk_ends_.size() * sizeof(std::size_t) + parts_.size() * sizeof(Part) +
         queue_.capacity() * sizeof(std::uint64_t);
}

std::size_t SharedPairs::bytes_for(const TriangleClusters& fixed,
                                   const TriangleClusters& moving) noexcept {
  return ClusterSearch::bytes_for(fixed, moving) + FoundMemory::bytes_reserved() +
         kFoundPairs * sizeof(TrianglePair) + (kMostNodes + kClusterWidth) * sizeof(std::uint32_t) +
         kMostTasks * sizeof(Task) +
         kMostChunks * (sizeof(std::size_t) + sizeof(Part) + sizeof(std::uint64_t));
}

}  // namespace ist
