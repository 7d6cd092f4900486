#include "viewer/engine/session.h"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "answers/bodies.h"
#include "answers/extents.h"
#include "answers/json_parts.h"
#include "ist/base/error.h"
#include "ist/measure/first_contact.h"
#include "ist/models/models.h"
#include "viewer/engine/replies.h"

namespace ist::viewer {
namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ErrorCode::kArgumentInvalid, what);
}

constexpr const char* name_of(Role role) { return role == Role::kFixed ? "fixed" : "moving"; }

// A folder of its own for each body: both files may have one name.
std::filesystem::path file_of(Role role, const std::string& name) {
  return std::filesystem::path(name_of(role)) / name;
}

std::vector<std::uint8_t> bytes_of(const std::vector<std::byte>& bytes) {
  std::vector<std::uint8_t> numbers(bytes.size());
  std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return numbers;
}

int level_of(const Asked& asked) {
  return static_cast<int>(std::min<std::uint64_t>(asked.count("level"), 64));
}

}  // namespace

Reply Session::answer(const std::string& question, const Asked& asked, Progress& progress) {
  Reply reply;
  if (question == "tick") {
    pairs().of(asked.policy()).tick(asked.pose("pose"), asked.number("stiffness"), reply);
  } else if (question == "collide") {
    reply.json = pairs().of(asked.policy()).collide(asked.pose("pose"));
  } else if (question == "occlusion") {
    fill_bite(whole(), asked, progress, reply);
  } else if (question == "facing") {
    fill_facing(whole(), asked, progress, reply);
  } else if (question == "swap") {
    swap();
  } else if (question == "save_glb") {
    reply.json["bytes"] = reply.array(coloured_glb(whole(), asked, progress));
  } else if (question == "make_jaws") {
    make_jaws(asked, reply);
  } else if (question == "open") {
    open(asked, reply);
  } else if (question == "build") {
    build(asked, progress, reply);
  } else if (question == "first_contact") {
    first_contact(asked, progress, reply);
  } else if (question == "level") {
    level(asked, reply);
  } else if (question == "touched") {
    touched(asked, reply);
  } else if (question == "fronts") {
    fronts(asked, reply);
  } else if (question == "front") {
    front(asked, reply);
  } else if (question == "save_body") {
    save_body(asked, reply);
  } else if (question == "memory") {
    // A count that is an int, and is read as one without a sign.
    reply.json["in_use"] = static_cast<std::uint32_t>(mallinfo().uordblks);
  } else {
    refuse(fmt::format("{}: the engine has no such question", question));
  }
  return reply;
}

PageBody& Session::present(Role role) {
  std::optional<PageBody>& found = body(role);
  if (!found) refuse(fmt::format("there is no {} body: open a file for it", name_of(role)));
  return *found;
}

Pairs& Session::pairs() {
  if (!pairs_) refuse("the trees are not built: build them first");
  return *pairs_;
}

answers::Bodies Session::whole() {
  PageBody &fixed = present(Role::kFixed), &moving = present(Role::kMoving);
  const SphereTree &one = fixed.whole(), &other = moving.whole();
  answers::Bodies bodies{one, other, std::min(one.tightest(), other.tightest())};
  name(bodies);
  return bodies;
}

void Session::name(answers::Bodies& bodies) {
  bodies.fixed_name = present(Role::kFixed).name();
  bodies.moving_name = present(Role::kMoving).name();
  if (contradict(bodies.fixed.frame(), bodies.moving.frame())) {
    refuse(fmt::format(
        "{} is in the frame {}, and {} in {}: turn one into the other, in the panel Bodies",
        bodies.fixed_name, to_string(bodies.fixed.frame()), bodies.moving_name,
        to_string(bodies.moving.frame())));
  }
}

void Session::make_jaws(const Asked& asked, Reply& reply) {
  const std::uint64_t seed = asked.count("seed");
  const std::filesystem::path upper = file_of(Role::kFixed, "upper_jaw.stl"),
                              lower = file_of(Role::kMoving, "lower_jaw.stl");
  // By way of files, as `ist demo --keep` writes them: the command's answers for those are these.
  write_stl(make_jaw(Jaw::kUpper, seed), upper);
  write_stl(make_jaw(Jaw::kLower, seed), lower);
  PageBody fixed(upper, LengthUnit::kUnknown), moving(lower, LengthUnit::kUnknown);
  std::filesystem::remove(upper);
  std::filesystem::remove(lower);
  reply.json["fixed"] = fixed.facts(reply);
  reply.json["moving"] = moving.facts(reply);
  take(Role::kFixed, std::move(fixed));
  take(Role::kMoving, std::move(moving));
}

void Session::take(Role role, PageBody read) {
  body(role) = std::move(read);
  pairs_.reset();
  recorded_.reset();
}

void Session::open(const Asked& asked, Reply& reply) {
  const Role role = asked.role();
  PageBody read(file_of(role, asked.text("name")), asked.unit(), asked.to_frame());
  reply.json = read.facts(reply);
  take(role, std::move(read));
}

void Session::swap() {
  std::swap(present(Role::kFixed), present(Role::kMoving));
  pairs_.reset();
  recorded_.reset();
}

void Session::build(const Asked& asked, Progress& progress, Reply& reply) {
  PageBody &fixed = present(Role::kFixed), &moving = present(Role::kMoving);
  const double extent = std::min(fixed.extent(), moving.extent());
  const double voxel_size =
      asked.number_or_none("voxel_size").value_or(answers::rounded_voxel_size(extent));
  PageBody::Built one = fixed.built(voxel_size, progress),
                  other = moving.built(voxel_size, progress);
  answers::Bodies bodies{one.tree, other.tree,
                         std::min(one.tree.tightest(), other.tree.tightest())};
  name(bodies);
  auto pairs = std::make_unique<Pairs>(std::move(bodies));
  static_cast<void>(pairs->of({}));  // so that the first frame of a drag has it
  // Memory may have ended before here: what was before is whole until all that is new is there.
  fixed.take(std::move(one));
  moving.take(std::move(other));
  pairs_ = std::move(pairs);
  recorded_.reset();
  reply.json = {{"fixed", fixed.tree_facts()}, {"moving", moving.tree_facts()}};
  reply.json["policies"] = nlohmann::ordered_json::array();
  for (const SpherePolicy policy : kSpherePolicies) {
    if (policy <= pairs_->bodies().policy) reply.json["policies"].push_back(to_string(policy));
  }
}

void Session::first_contact(const Asked& asked, Progress& progress, Reply& reply) {
  progress.begin_stage("looking for the first contact", 0);
  const Motion motion = Motion::between(asked.pose("from"), asked.pose("to"));
  const FirstContact found =
      ist::first_contact(pairs().of({}).query(), motion, asked.number("tolerance"));
  const Eigen::Isometry3d pose = motion.at(found.upper);
  reply.json = {{"status", to_string(found.status)},
                {"lower", found.lower},
                {"upper", found.upper},
                {"pose", answers::pose_json(pose)},
                {"point", nullptr}};
  if (found.triangles) {
    const Eigen::Vector3d point = answers::shared_point(pairs().bodies(), *found.triangles, pose);
    reply.json["point"] = {point[0], point[1], point[2]};
  }
}

void Session::level(const Asked& asked, Reply& reply) {
  const answers::Bodies& bodies = pairs().bodies();
  fill_level(asked.role() == Role::kFixed ? bodies.fixed : bodies.moving,
             asked.policy().value_or(bodies.policy), level_of(asked), reply);
}

void Session::touched(const Asked& asked, Reply& reply) {
  const answers::Bodies& bodies = pairs().bodies();
  const int level = level_of(asked);
  const SearchLevels last{std::min(level, bodies.fixed.depth()),
                          std::min(level, bodies.moving.depth())};
  const std::vector<StepFront> fronts =
      record_fronts(bodies.fixed, bodies.moving, asked.policy().value_or(bodies.policy),
                    asked.pose("pose"), last);
  const StepFront none, &at = fronts.empty() ? none : fronts.back();
  reply.json["fixed"] = reply.array(nodes_in(at.fixed));
  reply.json["moving"] = reply.array(nodes_in(at.moving));
}

const std::vector<StepFront>& Session::recorded(const Asked& asked) {
  const answers::Bodies& bodies = pairs().bodies();
  const SpherePolicy policy = asked.policy().value_or(bodies.policy);
  const Eigen::Isometry3d pose = asked.pose("pose");
  if (!recorded_ || recorded_->policy != policy || recorded_->pose.matrix() != pose.matrix()) {
    recorded_ = {pose, policy, record_fronts(bodies.fixed, bodies.moving, policy, pose)};
  }
  return recorded_->fronts;
}

void Session::fronts(const Asked& asked, Reply& reply) {
  reply.json["steps"] = nlohmann::ordered_json::array();
  for (const StepFront& front : recorded(asked)) {
    reply.json["steps"].push_back({{"fixed_level", front.fixed_level},
                                   {"moving_level", front.moving_level},
                                   {"tests", front.tests},
                                   {"pairs", front.pairs}});
  }
}

void Session::front(const Asked& asked, Reply& reply) {
  const std::vector<StepFront>& fronts = recorded(asked);
  const std::uint64_t step = asked.count("step");
  if (step >= fronts.size()) {
    refuse(fmt::format("step {}: the query has {} steps", step, fronts.size()));
  }
  const StepFront& front = fronts[step];
  reply.json = {{"fixed_level", front.fixed_level}, {"moving_level", front.moving_level}};
  reply.json["fixed"] = reply.array(front.fixed);
  reply.json["moving"] = reply.array(front.moving);
}

void Session::save_body(const Asked& asked, Reply& reply) {
  const PageBody& saved = present(asked.role());
  if (!saved.tree()) refuse("the tree is not built: build it first");
  reply.json["bytes"] = reply.array(bytes_of(tree_to_bytes(*saved.tree())));
}

}  // namespace ist::viewer
