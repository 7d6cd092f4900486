#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "ist/base/error.h"

namespace ist {

/// Numbers that lie one after the other in a buffer of a glTF.
struct GltfAccessor {
  std::uint64_t component = 0;  ///< the type of a number, as glTF counts types
  std::string_view type;        ///< "SCALAR", "VEC3", ...
  std::size_t count = 0;        ///< elements
  std::size_t stride = 0;       ///< bytes from one element to the next
  const char* first = nullptr;
};

/// The JSON and the buffers of a glTF 2.0 file, text or binary (GLB). Every function throws an
/// Error that names the place in the JSON for what is missing, of another type or out of range.
class GltfFile {
 public:
  using Json = nlohmann::json;

  /// `content` must outlive this object; `file` is named in errors.
  GltfFile(std::string_view content, std::string_view file);
  ~GltfFile();
  GltfFile(const GltfFile&) = delete;
  GltfFile& operator=(const GltfFile&) = delete;

  [[nodiscard]] const Json& root() const { return *root_; }
  /// Returns the element of a top-level array: element("nodes", 3).
  [[nodiscard]] const Json& element(const char* array, std::uint64_t index) const;
  /// Returns an accessor whose elements, `bytes` bytes each, all lie within the file.
  [[nodiscard]] GltfAccessor accessor(std::uint64_t index);

  /// Returns a member of a JSON object, or null without it.
  [[nodiscard]] static const Json* find(const Json& object, const char* key);
  /// Returns a member that is a whole number, not negative.
  [[nodiscard]] std::uint64_t index(const Json& object, const char* key,
                                    std::string_view place) const;
  [[nodiscard]] std::uint64_t index_or(const Json& object, const char* key, std::uint64_t other,
                                       std::string_view place) const;
  /// Returns a JSON value that is a whole number, not negative.
  [[nodiscard]] std::uint64_t whole(const Json& value, std::string_view place) const;
  /// Returns a member that is an array of numbers, or those of `other`, which has as many.
  [[nodiscard]] std::vector<double> numbers(const Json& object, const char* key,
                                            std::vector<double> other,
                                            std::string_view place) const;

  [[noreturn]] void fail(ErrorCode code, std::string_view place, std::string_view cause) const;

 private:
  std::string_view json_of_glb(std::string_view content);
  std::string_view buffer(std::uint64_t index);

  std::string_view file_;
  std::unique_ptr<Json> root_;
  bool is_binary_ = false;
  std::string_view chunk_;                             // the buffer within a GLB
  std::vector<std::unique_ptr<std::string>> decoded_;  // of each buffer that is text
};

}  // namespace ist
