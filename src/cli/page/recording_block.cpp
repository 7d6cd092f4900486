#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <variant>

#include "answers/json_parts.h"
#include "cli/load_bodies.h"
#include "cli/page/page_blocks.h"
#include "cli/progress_bar.h"
#include "cli/recordings/recording_header.h"
#include "ist/base/files.h"
#include "ist/base/throw_error.h"
#include "ist/scene.h"

namespace ist::cli {

using namespace answers;

namespace {

using nlohmann::ordered_json;

// Beside it the page holds trees, and each quotation mark takes two characters. An hour at 1 kHz
// takes 2 GB.
constexpr std::uint64_t kLongest = 300'000'000;

constexpr std::string_view kKey = R"({"recording":)";

// The tree that the page makes its own of.
SphereTree whole(const SceneBody& body) {
  const auto* file = std::get_if<std::filesystem::path>(&body.source);
  if (file != nullptr && is_tree_file(*file)) return read_tree(*file);
  TriangleMesh mesh =
      file != nullptr ? load_mesh(*file).mesh : make_shape(std::get<BuiltInShape>(body.source));
  return build_tree(std::move(mesh));
}

nlohmann::json header_of(const std::string& text, const std::filesystem::path& file) {
  const std::string line = text.substr(0, text.find('\n'));
  nlohmann::json header = nlohmann::json::parse(line, nullptr, /*allow_exceptions=*/false);
  RecordingHeader::check_format(header, file);
  return header;
}

void add_bodies(const Scene& scene, const BuiltScene& built, ordered_json& block) {
  const Simulation& simulation = *built.simulation;
  const Eigen::Isometry3d to_tool = simulation.tool_pose().isometry().inverse(Eigen::Isometry);
  std::size_t number = 0;
  for (const auto* bodies : {&scene.fixed, &scene.held}) {
    const bool held = bodies == &scene.held;
    for (const SceneBody& body : *bodies) {
      const Eigen::Isometry3d pose = simulation.body_pose(number).isometry();
      ordered_json line = body_block(held ? "moving" : "fixed",
                                     std::string(simulation.body_name(number)), whole(body));
      line["index"] = number++;
      line["held"] = held;
      line["pose"] = pose_json(pose);
      if (held) line["in_tool"] = pose_json(to_tool * pose);
      block["bodies"].push_back(std::move(line));
    }
  }
  block["metres_per_unit"] = scene.unit;
}

}  // namespace

bool is_recording(const std::filesystem::path& file) {
  InputFile input(file);
  std::string begin(kKey.size(), '\0');
  begin.resize(input.read(begin.data(), begin.size()));
  return begin == kKey;
}

ordered_json recording_block(const std::filesystem::path& recording,
                             const std::filesystem::path& scene_file, std::uint64_t max_memory) {
  InputFile input(recording);
  if (input.size() > kLongest) {
    throw_error(ErrorCode::kInputInvalid,

                "{}: it has {} MB, and a page holds recordings to {} MB: record fewer --seconds",
                recording.string(), input.size() / 1'000'000, kLongest / 1'000'000);
  }
  std::string text = input.read_rest();
  const nlohmann::json header = header_of(text, recording);
  ordered_json block = empty_block("recording");
  if (scene_file.empty()) {
    block["missing"] = {"The bodies are not in this page: write it again with ist view --scene."};
  } else {
    Scene scene = read_scene(scene_file);
    const auto dt = header.find("dt");
    if (dt != header.end() && dt->is_number()) scene.rate = 1 / dt->get<double>();
    ProgressBar progress;
    const BuiltScene built = build_scene(scene, {}, max_memory, &progress);
    RecordingHeader(scene, *built.simulation).check(header, recording);
    add_bodies(scene, built, block);
  }
  block["recording"] = std::move(text);
  return block;
}

}  // namespace ist::cli
