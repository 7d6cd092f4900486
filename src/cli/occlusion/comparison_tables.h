#pragma once

#include <filesystem>
#include <span>

#include "answers/comparison/bite_comparison.h"

namespace ist::cli {

/// Prints a comparison for people: the motion of the moving body, areas, depths and distances of
/// both bites, notes and the files that were written; then a line for each contact and each tooth.
void print_comparison(const answers::BiteComparison& comparison,
                      std::span<const std::filesystem::path> written);

}  // namespace ist::cli
