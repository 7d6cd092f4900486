#include "cli/page/page_blocks.h"

#include <string_view>

#include "cli/occlusion/html/html_text.h"
#include "cli/version.h"
#include "ist/tree/tree_parts.h"

namespace ist::cli {
namespace {

using nlohmann::ordered_json;

constexpr int kFormat = 1;

// The same tree under another name, or none: its file would tell its mesh's otherwise.
SphereTree renamed(const SphereTree& tree, const std::string& name) {
  TreeParts parts = tree.parts();
  parts.source.name = name;
  return SphereTree(std::move(parts));
}

ordered_json block_of(const char* kind) {
  return {{"format", kFormat},
          {"made_by", version_words()},
          {"kind", kind},
          {"bodies", ordered_json::array()}};
}

}  // namespace

ordered_json matrix_block(const Eigen::Isometry3d& pose) {
  ordered_json numbers = ordered_json::array();
  for (Eigen::Index i = 0; i < 16; ++i) numbers.push_back(pose.matrix().data()[i]);
  return numbers;
}

ordered_json body_block(const char* role, const std::string& name, const SphereTree& tree) {
  const std::vector<std::byte> bytes = tree_to_bytes(tree);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return {{"role", role}, {"name", name}, {"tree", base64_of(text)}};
}

ordered_json bodies_block(const SphereTree& fixed, const std::string& fixed_name,
                          const SphereTree* moving, const std::string& moving_name,
                          const Eigen::Isometry3d& pose) {
  ordered_json block = block_of("bodies");
  block["bodies"].push_back(body_block("fixed", fixed_name, fixed));
  if (moving == nullptr) return block;
  block["bodies"].push_back(body_block("moving", moving_name, *moving));
  block["pose"] = matrix_block(pose);
  return block;
}

ordered_json bite_block(const Bodies& bodies, const Bite& bite, const BiteQuestions& questions) {
  ordered_json block = block_of("bite");
  const auto add = [&](const char* role, const BiteBody& body, const SphereTree& tree) {
    block["bodies"].push_back(
        body_block(role, body.name, questions.no_names ? renamed(tree, std::string()) : tree));
  };
  add("fixed", bite.fixed, bodies.fixed);
  add("moving", bite.moving, bodies.moving);
  block["pose"] = matrix_block(bite.pose);
  ordered_json asked{
      {"preset", bite.preset->name}, {"reach", questions.reach}, {"frame", questions.sides.frame}};
  if (questions.unit != LengthUnit::kUnknown) asked["unit"] = to_string(questions.unit);
  block["occlusion"] = asked;
  return block;
}

bool page_shows(const BiteQuestions& questions) {
  const SideOptions& sides = questions.sides;
  return sides.left.empty() && sides.front.empty() && sides.midline.empty() &&
         questions.labels_fixed.empty() && questions.labels_moving.empty() &&
         questions.scanner_band == BiteQuestions{}.scanner_band;
}

}  // namespace ist::cli
