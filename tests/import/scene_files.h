#pragma once

#include <string>

namespace ist::test {

/// A box from (0, 0, 0) to (1, 2, 3), of six quads wound outward, or of twelve triangles, as a file
/// of each format. All are plain: what most programs write.
[[nodiscard]] std::string box_dae(const std::string& unit, const std::string& up,
                                  const std::string& in_node = "");
[[nodiscard]] std::string box_x3d(const std::string& around = "", const std::string& end = "");
[[nodiscard]] std::string box_amf(const std::string& attributes, const std::string& extra = "");
[[nodiscard]] std::string box_fbx(const std::string& unit_scale_factor);
[[nodiscard]] std::string box_ac();
[[nodiscard]] std::string box_3ds();

/// Whether a refusal says that the importer crashed. A sanitizer makes an exit code of a signal.
[[nodiscard]] bool says_crash(const std::string& refusal);

}  // namespace ist::test
