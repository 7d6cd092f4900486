#include "cli/source_file.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <vector>

#include "ist/base/files.h"
#include "ist/tree/mesh_source.h"
#include "ist/tree/tree_stream.h"

namespace ist::cli {

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

}  // namespace ist::cli
