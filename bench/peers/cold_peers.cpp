#include "peers/cold_peers.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace ist::bench {
namespace {

constexpr std::size_t kLine = 64;                // bytes
constexpr std::size_t kUnknownCache = 32 << 20;  // bytes, where no size is told

// Going through memory takes longer than most answers, so not all are asked.
constexpr std::array<std::string_view, 5> kAsked = {"ist", "fcl", "fcl_within", "embree",
                                                    "embree_boxes"};

using Memory = std::vector<unsigned char>;

class ColdPeer final : public Peer {
 public:
  ColdPeer(Peer& peer, std::shared_ptr<Memory> memory)
      : Peer(peer.name(), peer.guarantee()), peer_(peer), memory_(std::move(memory)) {}

  [[nodiscard]] bool answers(Question question) const override { return peer_.answers(question); }
  void prepare(const Eigen::Isometry3d& pose) override {
    peer_.prepare(pose);
    for (std::size_t i = 0; i < memory_->size(); i += kLine) ++(*memory_)[i];
    benchmark::ClobberMemory();
  }
  [[nodiscard]] bool prepared() const override { return peer_.prepared(); }
  bool meets(const Eigen::Isometry3d& pose) override { return peer_.meets(pose); }
  std::uint64_t pairs(const Eigen::Isometry3d& pose) override { return peer_.pairs(pose); }
  std::uint64_t candidates(const Eigen::Isometry3d& pose) override {
    return peer_.candidates(pose);
  }
  DistanceInterval distance(const Eigen::Isometry3d& pose) override { return peer_.distance(pose); }

 private:
  Peer& peer_;
  const std::shared_ptr<Memory> memory_;
};

}  // namespace

std::size_t swept_bytes() {
  if (quick()) return 1 << 20;
  int largest = 0;
  for (const auto& cache : benchmark::CPUInfo::Get().caches) {
    largest = std::max(largest, cache.size);
  }
  return 2 * (largest > 0 ? static_cast<std::size_t>(largest) : kUnknownCache);
}

Peers cold_peers(const Peers& all) {
  const auto memory = std::make_shared<Memory>(swept_bytes());
  Peers cold;
  for (const auto& peer : all) {
    if (std::ranges::find(kAsked, peer->name()) == kAsked.end()) continue;
    cold.push_back(std::make_unique<ColdPeer>(*peer, memory));
  }
  return cold;
}

}  // namespace ist::bench
