#include "cli/page/page_blocks.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "answers/json_parts.h"
#include "answers/version.h"
#include "cli/occlusion/html/html_text.h"
#include "ist/tree/tree_parts.h"

namespace ist::cli {

using namespace answers;

namespace {

using nlohmann::ordered_json;

constexpr int kPageFormat = 1;

// Whether a preset is one that the page has too.
bool is_built_in(const Preset* preset) {
  return std::any_of(presets().begin(), presets().end(),
                     [preset](const Preset& each) { return &each == preset; });
}

}  // namespace

ordered_json empty_block(const char* kind) {
  return {{"format", kPageFormat},
          {"made_by", version_words()},
          {"kind", kind},
          {"bodies", ordered_json::array()}};
}

ordered_json body_block(const char* role, const std::string& name, const SphereTree& tree) {
  const std::vector<std::byte> bytes = tree_to_bytes(tree);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return {{"role", role}, {"name", name}, {"tree", base64_of(text)}};
}

SphereTree without_name(const SphereTree& tree) {
  TreeParts parts = parts_of(tree);
  parts.source.name.clear();
  return tree_from(std::move(parts));
}

ordered_json body_alone_block(const NamedTree& body) {
  ordered_json block = empty_block("bodies");
  block["bodies"].push_back(body_block("fixed", body.name, body.tree));
  return block;
}

ordered_json bodies_block(const NamedTree& fixed, const NamedTree& moving,
                          const Eigen::Isometry3d& pose) {
  ordered_json block = body_alone_block(fixed);
  block["bodies"].push_back(body_block("moving", moving.name, moving.tree));
  block["pose"] = pose_json(pose);
  return block;
}

ordered_json bite_block(const Bodies& bodies, const Bite& bite, const BiteQuestions& questions) {
  ordered_json block = empty_block("bite");
  const auto add = [&](const char* role, const BiteBody& body, const SphereTree& tree) {
    block["bodies"].push_back(
        body_block(role, body.name, questions.no_names ? without_name(tree) : tree));
  };
  add("fixed", bite.fixed, bodies.fixed);
  add("moving", bite.moving, bodies.moving);
  block["pose"] = pose_json(bite.pose);
  ordered_json asked{
      {"preset", bite.preset->name}, {"reach", questions.reach}, {"frame", questions.sides.frame}};
  if (questions.unit != LengthUnit::kUnknown) asked["unit"] = to_string(questions.unit);
  block["occlusion"] = asked;
  return block;
}

bool page_shows(const BiteQuestions& questions) {
  const SideOptions& sides = questions.sides;
  return sides.left.empty() && sides.front.empty() && sides.midline.empty() &&
         questions.labels_fixed.empty() && questions.labels_moving.empty() && !questions.region &&
         is_built_in(questions.preset) && questions.scanner_band == BiteQuestions{}.scanner_band;
}

}  // namespace ist::cli
