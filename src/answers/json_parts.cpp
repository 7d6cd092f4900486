#include "answers/json_parts.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <system_error>

#include "answers/commit.h"
#include "ist/base/files.h"
#include "ist/tree/mesh_source.h"
#include "ist/tree/tree_stream.h"

namespace ist::answers {

MeshSource source_of(const std::filesystem::path& file) {
  MeshSource source{source_name(file.filename().string())};
  std::error_code unknown;
  const auto status = std::filesystem::status(file, unknown);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) return source;
  InputFile input(file);
  Checksum checksum;
  std::vector<char> chunk(std::size_t{1} << 20);
  while (const std::size_t got = input.read(chunk.data(), chunk.size())) {
    checksum.add(chunk.data(), got);
  }
  source.hash = checksum.value();
  return source;
}

nlohmann::ordered_json json_of(const MeshSource& source) {
  nlohmann::ordered_json json{{"name", nullptr}, {"hash", nullptr}};
  if (!source.name.empty()) json["name"] = source.name;
  if (source.hash != 0) json["hash"] = fmt::format("{:016x}", source.hash);
  return json;
}

nlohmann::ordered_json json_of(LengthUnit unit) {
  if (unit == LengthUnit::kUnknown) return nullptr;
  return std::string(to_string(unit));
}

nlohmann::ordered_json json_of(PatientFrame frame) {
  if (frame == PatientFrame::kUnknown) return nullptr;
  return std::string(to_string(frame));
}

nlohmann::ordered_json voxel_size_json(const SphereTree& tree) {
  if (!tree.has_voxels()) return nullptr;
  return tree.voxel_size();
}

nlohmann::ordered_json pose_json(const Eigen::Isometry3d& pose) {
  return std::vector<double>(pose.data(), pose.data() + 16);
}

nlohmann::ordered_json point_json(const std::optional<Eigen::Vector3d>& point) {
  return point ? nlohmann::ordered_json{(*point)[0], (*point)[1], (*point)[2]}
               : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json pair_json(const std::optional<TrianglePair>& pair) {
  return pair ? nlohmann::ordered_json{pair->fixed, pair->moving} : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json header_line(const std::string& subcommand, const NamedSources& files) {
  nlohmann::ordered_json line{
      {"ist", IST_VERSION}, {"commit", IST_COMMIT}, {"subcommand", subcommand}};
  for (const auto& [name, source] : files) {
    line[name] = {{"file", source.name}, {"hash", nullptr}};
    if (source.hash != 0) line[name]["hash"] = fmt::format("{:016x}", source.hash);
  }
  return line;
}

nlohmann::ordered_json header_line(const std::string& subcommand, const NamedSources& files,
                                   const Bodies& bodies, const std::optional<TakenUnit>& unit) {
  nlohmann::ordered_json line = header_line(subcommand, files);
  line["unit"] = unit ? nlohmann::ordered_json(unit->name) : json_of(bodies.unit());
  if (unit) line["unit_assumed"] = unit->assumed;
  line["frame"] = json_of(bodies.frame());
  line["voxel_size"] = {voxel_size_json(bodies.fixed), voxel_size_json(bodies.moving)};
  return line;
}

std::string json_text(const nlohmann::ordered_json& json, int indent) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace ist::answers
