#pragma once

#include <filesystem>
#include <span>

#include "cli/occlusion/bite.h"
#include "ist/base/files.h"

namespace ist::cli {

/// Writes the object of json_of(). Throws kFileUnwritable.
void write_bite_json(const Bite& bite, OutputFile& file);

/// Prints three lines for people: touch and how far or how deep; areas and the number of contacts;
/// checks, and the files that were written. A warning, a region and a hint have lines of their own.
void print_bite(const Bite& bite, std::span<const std::filesystem::path> written);

/// Prints the contacts by their numbers, a line each.
void print_contacts(const Bite& bite);

}  // namespace ist::cli
