#pragma once

#include <cstdint>
#include <string>

#include "ist/mesh/mesh.h"

namespace ist::test {

/// A zip archive of one entry, deflated or stored. `claimed` is the unpacked size that its
/// directory states: the true one by default.
[[nodiscard]] std::string as_zip(const std::string& name, const std::string& content,
                                 bool deflated = true, std::uint32_t claimed = 0);

/// The archive that is a 3MF, of its model; the XML of a model of one mesh, in doubles.
[[nodiscard]] std::string as_3mf(const std::string& model);
[[nodiscard]] std::string threemf_model(const TriangleMesh& mesh);

}  // namespace ist::test
