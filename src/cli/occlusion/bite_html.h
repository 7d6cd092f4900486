#pragma once

#include <filesystem>

#include "answers/occlusion/bite.h"
#include "ist/base/files.h"

namespace ist::cli {

/// Writes all that is known of a bite as one page of HTML, for people: pictures of both distance
/// maps, tables, and the limits of the method. The page holds no script and refers to nothing
/// outside; it is well-formed XML too. Its words for sides are those of the bite's divisions alone.
/// Throws kFileUnwritable. Cost: some 0.2 s for two bodies of 100,000 triangles; the file takes
/// about 0.5 MB.
void write_bite_html(const answers::Bite& bite, OutputFile& file);
/// The same, and completes the file.
void write_bite_html(const answers::Bite& bite, const std::filesystem::path& file);

}  // namespace ist::cli
