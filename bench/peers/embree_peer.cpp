#include "peers/embree_peer.h"

#include <embree3/rtcore.h>

#include <cstdlib>
#include <iostream>
#include <thread>

#include "ist/base/pose.h"
#include "peers/exact_parts.h"

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

// A mesh as boxes of float, which hold its triangles.
class Body {
 public:
  explicit Body(const TriangleMesh& mesh)
      : triangles_(mesh.triangles), vertices_(mesh.vertices), scene_(rtcNewScene(device())) {
    geometry_ = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry_, static_cast<unsigned>(triangles_.size()));
    rtcSetGeometryUserData(geometry_, this);
    rtcSetGeometryBoundsFunction(geometry_, bounds, nullptr);
    // Only a scene of low quality asks how a geometry is to be built; this one is built well at
    // first, and refitted after. Both bodies' scenes are so, that their hierarchies are of one
    // kind.
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);
    rtcSetGeometryBuildQuality(geometry_, RTC_BUILD_QUALITY_REFIT);
    find_margin();
    rtcCommitGeometry(geometry_);
    rtcAttachGeometry(scene_, geometry_);
    rtcCommitScene(scene_);
  }
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;
  ~Body() {
    rtcReleaseGeometry(geometry_);
    rtcReleaseScene(scene_);
  }

  // In the very doubles that TrianglePairs guarantees.
  void move(const std::vector<Eigen::Vector3d>& from, const Eigen::Isometry3d& pose) {
    const Eigen::Isometry3d rigid = *project_to_rigid(pose);
    const auto& m = rigid.matrix();
    for (std::size_t k = 0; k < from.size(); ++k) {
      const Eigen::Vector3d& v = from[k];
      for (Eigen::Index i = 0; i < 3; ++i) {
        vertices_[k][i] = ((m(i, 0) * v[0] + m(i, 1) * v[1]) + m(i, 2) * v[2]) + m(i, 3);
      }
    }
    find_margin();
    rtcCommitGeometry(geometry_);
    rtcCommitScene(scene_);
  }

  [[nodiscard]] RTCScene scene() const { return scene_; }
  [[nodiscard]] TriangleCorners corners(unsigned triangle) const {
    const auto& [a, b, c] = triangles_[triangle];
    return {vertices_[a], vertices_[b], vertices_[c]};
  }

 private:
  // Twice what a float of these coordinates may be off.
  void find_margin() {
    double largest = 0;
    for (const Eigen::Vector3d& v : vertices_) largest = std::max(largest, v.cwiseAbs().maxCoeff());
    margin_ = static_cast<float>(largest * 0x1p-22);
  }

  static void bounds(const RTCBoundsFunctionArguments* args) {
    const Body& body = *static_cast<const Body*>(args->geometryUserPtr);
    const auto& [a, b, c] = body.triangles_[args->primID];
    const Eigen::Vector3d &p = body.vertices_[a], &q = body.vertices_[b], &r = body.vertices_[c];
    const Eigen::Vector3f low = p.cwiseMin(q).cwiseMin(r).cast<float>().array() - body.margin_;
    const Eigen::Vector3f high = p.cwiseMax(q).cwiseMax(r).cast<float>().array() + body.margin_;
    *args->bounds_o = {low.x(), low.y(), low.z(), 0, high.x(), high.y(), high.z(), 0};
  }

  const std::vector<Triangle>& triangles_;
  std::vector<Eigen::Vector3d> vertices_;
  RTCScene scene_;
  RTCGeometry geometry_;
  float margin_ = 0;
};

bool boxes_apart(const TriangleCorners& a, const TriangleCorners& b) {
  const auto low = [](const TriangleCorners& t) { return t[0].cwiseMin(t[1]).cwiseMin(t[2]); };
  const auto high = [](const TriangleCorners& t) { return t[0].cwiseMax(t[1]).cwiseMax(t[2]); };
  return (high(a).array() < low(b).array()).any() || (high(b).array() < low(a).array()).any();
}

enum class Part : std::uint8_t { kAll, kWithoutRefit, kBoxes };
constexpr const char* kNames[] = {"embree", "embree_no_refit", "embree_boxes"};

// Each contestant moves the moving one before it asks.
struct Bodies {
  Bodies(const TriangleMesh& a, const TriangleMesh& b) : fixed(a), moving(b) {}
  Body fixed, moving;
};

class EmbreePeer final : public Peer {
 public:
  EmbreePeer(const TriangleMesh& moving, std::shared_ptr<Bodies> bodies, Part part)
      : Peer(kNames[static_cast<std::size_t>(part)], Guarantee::kExact),
        part_(part),
        from_(moving.vertices),
        bodies_(std::move(bodies)) {
    rtcCollide(fixed_.scene(), moving_.scene(), find_thread, this);
  }

  [[nodiscard]] bool answers(Question question) const override {
    if (part_ == Part::kBoxes) return question == Question::kCandidates;
    return question == Question::kPairs || question == Question::kMeets;
  }
  void prepare(const Eigen::Isometry3d& pose) override {
    if (prepared()) moving_.move(from_, pose);
  }
  [[nodiscard]] bool prepared() const override { return part_ != Part::kAll; }
  bool meets(const Eigen::Isometry3d& pose) override { return pairs(pose) > 0; }
  std::uint64_t pairs(const Eigen::Isometry3d& pose) override {
    if (!prepared()) moving_.move(from_, pose);
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
      const TriangleCorners a = peer.fixed_.corners(found[i].primID0);
      const TriangleCorners b = peer.moving_.corners(found[i].primID1);
      if (boxes_apart(a, b) || !meet(a, b)) continue;
      peer.pairs_.push_back({found[i].primID0, found[i].primID1});
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
  const std::vector<Eigen::Vector3d>& from_;
  const std::shared_ptr<Bodies> bodies_;
  Body &fixed_ = bodies_->fixed, &moving_ = bodies_->moving;
  std::vector<TrianglePair> pairs_;
  std::uint64_t candidates_ = 0;
};

Peers make_peers(const TriangleMesh& fixed, const TriangleMesh& moving) {
  const auto bodies = std::make_shared<Bodies>(fixed, moving);
  Peers peers;
  for (const Part part : {Part::kAll, Part::kWithoutRefit, Part::kBoxes}) {
    peers.push_back(std::make_unique<EmbreePeer>(moving, bodies, part));
  }
  return peers;
}

}  // namespace

Library embree_library() { return {"embree", RTC_VERSION_STRING, make_peers}; }

}  // namespace ist::bench
