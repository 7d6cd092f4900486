#include <cstdlib>
#include <iostream>
#include <thread>

#include "peers/embree_body.h"
#include "peers/exact_parts.h"
#include "peers/libraries.h"

namespace ist::bench {
namespace {

void print_error(void*, RTCError error, const char* text) {
  std::cerr << "embree: error " << error << ": " << text << '\n';
  std::exit(1);
}

RTCDevice device() {
  static const RTCDevice made = [] {
    const RTCDevice device = rtcNewDevice("threads=1,set_affinity=0");
    rtcSetDeviceErrorFunction(device, print_error, nullptr);
    return device;
  }();
  return made;
}

enum class Part : std::uint8_t { kAll, kWithoutRefit, kBoxes };
constexpr const char* kNames[] = {"embree", "embree_no_refit", "embree_boxes"};

// Each contestant moves the moving one before it asks.
struct Bodies {
  Bodies(const TriangleMesh& a, const TriangleMesh& b)
      : fixed(device(), a), moving(device(), b), from(corners_of(b)) {}
  EmbreeBody fixed, moving;
  const std::vector<Corner> from;
};

class EmbreePeer final : public Peer {
 public:
  EmbreePeer(std::shared_ptr<Bodies> bodies, Part part)
      : Peer(kNames[static_cast<std::size_t>(part)], Guarantee::kExact),
        part_(part),
        bodies_(std::move(bodies)) {
    rtcCollide(fixed_.scene(), moving_.scene(), find_thread, this);
  }

  [[nodiscard]] bool answers(Question question) const override {
    if (part_ == Part::kBoxes) return question == Question::kCandidates;
    return question == Question::kPairs || question == Question::kMeets;
  }
  void prepare(const Eigen::Isometry3d& pose) override {
    if (prepared()) moving_.move(bodies_->from, pose);
  }
  [[nodiscard]] bool prepared() const override { return part_ != Part::kAll; }
  bool meets(const Eigen::Isometry3d& pose) override { return pairs(pose) > 0; }
  std::uint64_t pairs(const Eigen::Isometry3d& pose) override {
    if (!prepared()) moving_.move(bodies_->from, pose);
    pairs_.clear();
    rtcCollide(fixed_.scene(), moving_.scene(), test, this);
    return pairs_.size();
  }
  std::uint64_t candidates(const Eigen::Isometry3d&) override {
    candidates_ = 0;
    rtcCollide(fixed_.scene(), moving_.scene(), count, this);
    return candidates_;
  }

 private:
  static void test(void* user, RTCCollision* found, unsigned size) {
    EmbreePeer& peer = *static_cast<EmbreePeer*>(user);
    for (unsigned i = 0; i < size; ++i) {
      const unsigned a = found[i].primID0, b = found[i].primID1;
      if (peer.fixed_.box_apart(a, peer.moving_, b)) continue;
      if (meet(peer.fixed_.corners(a), peer.moving_.corners(b))) peer.pairs_.push_back({a, b});
    }
  }
  static void count(void* user, RTCCollision*, unsigned size) {
    static_cast<EmbreePeer*>(user)->candidates_ += size;
  }
  // What is called from other threads would race, and would be no peer of one worker.
  static void find_thread(void* user, RTCCollision*, unsigned) {
    if (std::this_thread::get_id() == static_cast<EmbreePeer*>(user)->thread_) return;
    std::cerr << "embree: works in more than one thread\n";
    std::exit(1);
  }

  const Part part_;
  const std::thread::id thread_ = std::this_thread::get_id();
  const std::shared_ptr<Bodies> bodies_;
  EmbreeBody &fixed_ = bodies_->fixed, &moving_ = bodies_->moving;
  std::vector<TrianglePair> pairs_;
  std::uint64_t candidates_ = 0;
};

Peers make_peers(const TriangleMesh& fixed, const TriangleMesh& moving) {
  const auto bodies = std::make_shared<Bodies>(fixed, moving);
  Peers peers;
  for (const Part part : {Part::kAll, Part::kWithoutRefit, Part::kBoxes}) {
    peers.push_back(std::make_unique<EmbreePeer>(bodies, part));
  }
  return peers;
}

}  // namespace

Library embree_library() { return {"embree", RTC_VERSION_STRING, make_peers}; }

}  // namespace ist::bench
