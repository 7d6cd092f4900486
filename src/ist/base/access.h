#pragma once

#include <utility>

namespace ist::detail {

/// Reaches the private members of public classes, for the library's own code and for tests. No
/// installed header includes it. The functions beside each content name its types: parts_of(),
/// tree_from(), reducer_of(), simulation_from(), sharing_of().
struct Access {
  /// Returns the content of a SphereTree.
  template <class Tree>
  [[nodiscard]] static const auto& parts(const Tree& tree) noexcept {
    return *tree.parts_;
  }
  /// Returns the reducer of a ContactManifold.
  template <class Manifold>
  [[nodiscard]] static auto& reducer(Manifold& manifold) noexcept {
    return *manifold.reducer_;
  }
  /// Returns the state of a Query.
  template <class Query>
  [[nodiscard]] static auto& state(Query& query) noexcept {
    return *query.state_;
  }
  /// Makes an object of its content.
  template <class Made, class Parts>
  [[nodiscard]] static Made made_of(Parts&& parts) {
    return Made(std::forward<Parts>(parts));
  }
};

}  // namespace ist::detail
