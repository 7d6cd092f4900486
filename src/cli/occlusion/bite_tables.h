#pragma once

#include <filesystem>
#include <span>

#include "answers/occlusion/bite.h"

namespace ist::cli {

/// Prints three lines for people: touch and how far or how deep; areas and the number of contacts;
/// checks, and the files that were written. A warning, a region and a hint have lines of their own.
void print_bite(const answers::Bite& bite, std::span<const std::filesystem::path> written);

/// Prints the contacts by their numbers, a line each.
void print_contacts(const answers::Bite& bite);

}  // namespace ist::cli
