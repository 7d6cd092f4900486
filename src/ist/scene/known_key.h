#pragma once

#include <string>
#include <string_view>

namespace ist {

/// A key that a reader of scenes knows. The reader fills it in as it reads, so that the reference
/// of all keys (docs/scene-reference.md) is made of what is read.
struct KnownKey {
  std::string name;
  std::string values = {};     ///< for people: "1 to 2", `"a" or "b"`, "true or false"
  std::string_view unit = {};  ///< of numbers
  std::string otherwise = {};  ///< the default, if the reader has one
  bool optional = false;       ///< the key may be missing
};

}  // namespace ist
