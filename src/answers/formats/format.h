#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace ist::answers {

/// The format of a file that the command writes.
enum class FileFormat { kVtp, kPly, kGlb, kCsv, kJsonl, kJson, kHtml, kPng, kSvg, kPdf };

/// Returns the ending of the files of a format, such as ".vtp".
[[nodiscard]] const char* ending(FileFormat format);

/// Returns the endings of formats, each with the programs that open it, such as ".vtp (ParaView, 3D
/// Slicer) or .json". For helps, so that all of them name the same.
[[nodiscard]] std::string endings_with_programs(std::span<const FileFormat> formats);

/// Returns the format that a file's name says by its ending, in upper or lower case.
///
/// @param option the option that names the file, such as "-o", for the error's text
/// @param writable the formats that the command can write there, at least one
///
/// Throws a Refusal, naming the endings that can be written, for every other ending.
[[nodiscard]] FileFormat format_by_ending(const std::string& option,
                                          const std::filesystem::path& file,
                                          std::span<const FileFormat> writable);

}  // namespace ist::answers
