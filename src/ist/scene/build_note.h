#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace ist {

/// One thing that a scene could need, and whether it does.
struct BuildNote {
  std::string what;
  bool built;
  std::string why;
  double milliseconds = 0;
  std::uint64_t bytes = 0;
};

/// Of everything that a scene could need a note, in the order of building.
class BuildNotes {
 public:
  void skip(std::string what, std::string why) {
    notes_.push_back({std::move(what), false, std::move(why), 0, 0});
  }
  /// Returns what `make` makes, a pointer to something of so many bytes().
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
