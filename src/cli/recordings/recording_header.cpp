#include "cli/recordings/recording_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <tuple>

#include "answers/commit.h"
#include "answers/json_parts.h"
#include "ist/base/throw_error.h"

namespace ist::cli {

using namespace answers;

namespace {

// 1 had no header, and 2 no contact points.
constexpr int kRecordingFormat = 3;

void add_file(nlohmann::ordered_json& line, const char* name, const char* hash,
              const std::filesystem::path& file) {
  const MeshSource source = source_of(file);
  line[name] = source.name;
  if (source.hash != 0) line[hash] = fmt::format("{:016x}", source.hash);
}

nlohmann::ordered_json json_of_body(const SceneBody& body, const Simulation& simulation,
                                    std::size_t number, bool held) {
  nlohmann::ordered_json line{{"name", std::string(simulation.body_name(number))},
                              {"file", nullptr},
                              {"hash", nullptr},
                              {"script", nullptr},
                              {"script_hash", nullptr},
                              {"held", held}};
  if (const auto* file = std::get_if<std::filesystem::path>(&body.source)) {
    add_file(line, "file", "hash", *file);
  }
  if (!body.script_file.empty()) add_file(line, "script", "script_hash", body.script_file);
  return line;
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what) {
  throw_error(ErrorCode::kInputInvalid, "{}:1: {}", file.string(), what);
}

// Returns the number of the first line that differs, from 1.
std::size_t line_of_difference(const std::string& a, const std::string& b) {
  const auto end = std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first;
  return 1 + static_cast<std::size_t>(std::count(a.begin(), end, '\n'));
}

}  // namespace

RecordingHeader::RecordingHeader(const Scene& scene, const Simulation& simulation)
    : line_(new nlohmann::ordered_json{{"recording", kRecordingFormat},
                                       {"ist", IST_VERSION},
                                       {"commit", IST_COMMIT},
                                       {"dt", simulation.dt()},
                                       {"unit", scene.unit},
                                       {"bodies", nlohmann::ordered_json::array()},
                                       {"scene", scene.text}}) {
  nlohmann::ordered_json& bodies = line_->at("bodies");
  std::size_t number = 0;
  for (const SceneBody& body : scene.fixed) {
    bodies.push_back(json_of_body(body, simulation, number++, false));
  }
  for (const SceneBody& body : scene.held) {
    bodies.push_back(json_of_body(body, simulation, number++, true));
  }
}

RecordingHeader::~RecordingHeader() = default;
RecordingHeader::RecordingHeader(RecordingHeader&&) noexcept = default;
RecordingHeader& RecordingHeader::operator=(RecordingHeader&&) noexcept = default;

std::string RecordingHeader::line() const { return line_->dump(); }

double RecordingHeader::dt() const { return line_->at("dt").get<double>(); }

std::vector<std::string> RecordingHeader::body_names() const {
  std::vector<std::string> names;
  for (const auto& body : line_->at("bodies")) names.push_back(body.at("name").get<std::string>());
  return names;
}

void RecordingHeader::check_format(const nlohmann::json& recorded,
                                   const std::filesystem::path& file) {
  const auto format = recorded.find("recording");
  if (format == recorded.end() || !format->is_number_integer()) {
    refuse(file,
           "no header of a recording: give a file that --record wrote as JSON lines, with version "
           "0.2 or later");
  }
  if (*format != kRecordingFormat) {
    refuse(file,
           fmt::format("a recording of format {}, and this version reads {}: record the scene "
                       "again, or use the version that recorded it",
                       format->dump(), kRecordingFormat));
  }
}

void RecordingHeader::check(const nlohmann::json& recorded,
                            const std::filesystem::path& file) const {
  check_format(recorded, file);
  const auto scene = recorded.find("scene");
  if (scene == recorded.end() || !scene->is_string()) refuse(file, "no text 'scene': record again");
  const auto text = scene->get<std::string>();
  const auto own = line_->at("scene").get<std::string>();
  if (text != own) {
    refuse(file, fmt::format("it was recorded with another scene, which differs from line {} on: "
                             "give that scene, which the recording holds as 'scene'",
                             line_of_difference(text, own)));
  }
  const auto bodies = recorded.find("bodies");
  if (bodies == recorded.end() || !bodies->is_array() ||
      bodies->size() != line_->at("bodies").size()) {
    refuse(file, "no array 'bodies' of the scene's: record again");
  }
  for (std::size_t i = 0; i < bodies->size(); ++i) {
    const auto& body = line_->at("bodies")[i];
    const nlohmann::json& then = (*bodies)[i];
    for (const auto& [name, hash, what] :
         {std::tuple("file", "hash", "file"), std::tuple("script", "script_hash", "script")}) {
      if (then.is_object() && then.contains(hash) && then.at(hash) == nlohmann::json(body.at(hash)))
        continue;
      refuse(file,
             fmt::format("the {} of '{}', {}, is not the one that was recorded: give that one",
                         what, body.at("name").get<std::string>(), json_text(body.at(name))));
    }
  }
}

}  // namespace ist::cli
