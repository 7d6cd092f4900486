#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ist/mesh/mesh.h"

namespace ist::test {

/// An entry of a zip archive. `claimed` is the unpacked size that its records state: the true one
/// by default.
struct ZipPart {
  std::string name, content;
  bool deflated = true;
  std::uint64_t claimed = 0;
};

/// Whether sizes and offsets have 32 bits, or 64 (ZIP64), as lib3mf writes them for any size.
enum class ZipNumbers : std::uint8_t { kNarrow, kWide };

[[nodiscard]] std::string as_zip(const std::vector<ZipPart>& parts,
                                 ZipNumbers numbers = ZipNumbers::kNarrow);
/// A zip archive of one entry, deflated or stored.
[[nodiscard]] std::string as_zip(const std::string& name, const std::string& content,
                                 bool deflated = true, std::uint32_t claimed = 0);

/// The archive that is a 3MF, of its model; the XML of a model of one mesh, in doubles.
[[nodiscard]] std::string as_3mf(const std::string& model);
[[nodiscard]] std::string threemf_model(const TriangleMesh& mesh);

}  // namespace ist::test
