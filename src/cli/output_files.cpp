#include "cli/output_files.h"

#include <algorithm>
#include <set>
#include <system_error>

#include "answers/refusals.h"
#include "cli/common_options.h"

namespace ist::cli {

using namespace answers;

namespace {

// One spelling of each file, whether it is there or not.
std::filesystem::path plain(const std::filesystem::path& file) {
  std::error_code unknown;
  const auto spelled = std::filesystem::weakly_canonical(std::filesystem::absolute(file), unknown);
  return unknown ? file : spelled;
}

}  // namespace

OutputFiles::OutputFiles(std::span<const std::filesystem::path> names,
                         std::span<const FileFormat> writable,
                         std::initializer_list<std::filesystem::path> inputs) {
  std::set<std::filesystem::path> known;
  for (const std::filesystem::path& name : names) {
    const FileFormat format = format_by_ending("-o", name, writable);
    check_output(name, inputs);
    refuse_if(!known.insert(plain(name)).second, "-o", "{} is named twice", name.string());
    files_.push_back({std::make_unique<OutputFile>(name), format});
  }
}

bool OutputFiles::has(std::initializer_list<FileFormat> formats) const {
  return std::any_of(files_.begin(), files_.end(), [&](const One& one) {
    return std::find(formats.begin(), formats.end(), one.format) != formats.end();
  });
}

void OutputFiles::commit() const {
  std::vector<OutputFile*> files;
  files.reserve(files_.size());
  for (const One& one : files_) files.push_back(one.file.get());
  OutputFile::commit_all(files);
}

}  // namespace ist::cli
