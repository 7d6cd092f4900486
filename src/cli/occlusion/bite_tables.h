#pragma once

#include <filesystem>
#include <span>

#include "cli/occlusion/bite.h"
#include "ist/base/files.h"

namespace ist::cli {

/// Writes a row for each contact region: of the fixed body, then of the moving one, the largest
/// first. Throws kFileUnwritable.
void write_bite_csv(const Bite& bite, OutputFile& file);

/// Writes the object of json_of() in the same way. Throws kFileUnwritable.
void write_bite_json(const Bite& bite, OutputFile& file);

/// Prints three lines for people: touch and how far or how deep; areas and regions; checks, and
/// the files that were written.
void print_bite(const Bite& bite, std::span<const std::filesystem::path> written);

}  // namespace ist::cli
