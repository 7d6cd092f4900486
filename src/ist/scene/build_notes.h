#pragma once

#include <chrono>
#include <utility>

#include "ist/scene.h"

namespace ist {

/// Collects a note for each stage, in the order of building.
class BuildNotes {
 public:
  void skip(std::string what, std::string why) {
    notes_.push_back({std::move(what), false, std::move(why), 0, 0});
  }
  /// Calls `make`, notes its time and the bytes() of its result, and returns the result, a pointer.
  template <typename Make>
  auto make(std::string what, std::string why, const Make& make) {
    const auto begin = std::chrono::steady_clock::now();
    auto made = make();
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - begin;
    notes_.push_back(
        {std::move(what), true, std::move(why), time.count(), std::uint64_t{made->bytes()}});
    return made;
  }
  [[nodiscard]] std::vector<BuildNote> take() { return std::move(notes_); }

 private:
  std::vector<BuildNote> notes_;
};

}  // namespace ist
