// The peers, as the command asks them: `ist bench --against`.
#include "cli/bench/rivals.h"

#include <chrono>
#include <memory>
#include <optional>
#include <utility>

#include "peers/peer.h"
#ifdef IST_PEER_EMBREE
#include "peers/embree_peer.h"
#endif
#ifdef IST_PEER_FCL
#include "peers/fcl_peer.h"
#endif

namespace ist::cli {
namespace {

using bench::Peer;
using bench::Question;

constexpr std::pair<Question, const char*> kAsked[] = {{Question::kMeets, "touch"},
                                                       {Question::kPairs, "triangle pairs"},
                                                       {Question::kDistance, "distance"}};

Contestant::Answer ask(Peer& peer, Question question, const Eigen::Isometry3d& pose) {
  const auto begin = std::chrono::steady_clock::now();
  std::optional<std::uint64_t> listed;
  switch (question) {
    case Question::kMeets:
      static_cast<void>(peer.meets(pose));
      break;
    case Question::kPairs:
      listed = peer.pairs(pose);
      break;
    default:
      static_cast<void>(peer.distance(pose));
  }
  const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - begin;
  return {time.count(), listed};
}

// Of the library's contestants the first alone: it does the whole work within its time.
std::vector<Contestant> contestants_of(const bench::Library& library, const TriangleMesh& fixed,
                                       const TriangleMesh& moving,
                                       std::span<const BenchPose> poses) {
  const std::shared_ptr<Peer> peer = std::move(library.make(fixed, moving).front());
  std::vector<Contestant> all;
  for (const auto& [question, words] : kAsked) {
    if (!peer->answers(question)) continue;
    all.push_back(
        {words, library.name, "", 1, [peer, question = question, poses](std::size_t pose) {
           return ask(*peer, question, poses[pose].pose);
         }});
  }
  return all;
}

}  // namespace

std::vector<Rival> rivals() {
  std::vector<Rival> all = {{"fcl", ""}, {"embree", ""}};
#ifdef IST_PEER_FCL
  all[0] = {
      "fcl", bench::fcl_library().version, true,
      [](const TriangleMesh& fixed, const TriangleMesh& moving, std::span<const BenchPose> poses) {
        return contestants_of(bench::fcl_library(), fixed, moving, poses);
      }};
#endif
#ifdef IST_PEER_EMBREE
  all[1] = {
      "embree", bench::embree_library().version, true,
      [](const TriangleMesh& fixed, const TriangleMesh& moving, std::span<const BenchPose> poses) {
        return contestants_of(bench::embree_library(), fixed, moving, poses);
      }};
#endif
  return all;
}

}  // namespace ist::cli
