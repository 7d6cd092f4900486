#include "ist/mesh/import/imported_mesh.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <csignal>
#include <cstdlib>
#include <string>
#include <system_error>

#include "ist/base/printable.h"
#include "ist/mesh/format/mesh_readers.h"
#include "ist/mesh/format/text_reader.h"
#include "ist/mesh/import/import_message.h"
#include "ist/mesh/import/import_run.h"

namespace ist {
namespace {

// Returns the folder of the shared library that holds this code, or of the program, if the code is
// linked into it. The loader tells a relative path of a library that was named so. It is no use:
// the current folder may be another one today.
std::filesystem::path own_folder() {
  Dl_info info{};
  if (::dladdr(reinterpret_cast<const void*>(&read_imported), &info) == 0 ||
      info.dli_fname == nullptr)
    return {};
  std::error_code ignored;
  return std::filesystem::canonical(info.dli_fname, ignored).parent_path();
}

// Returns an empty path if the program is not installed.
std::filesystem::path importer_path(const std::string& file) {
  if (const char* named = ::secure_getenv("IST_IMPORT"); named != nullptr && *named != '\0') {
    if (*named == '/') return named;
    fail_mesh(ErrorCode::kFileUnreadable, file, "",
              fmt::format("the environment variable IST_IMPORT is '{}': give an absolute path",
                          printable(named)));
  }
  std::error_code ignored;
  const std::filesystem::path own = own_folder(),
                              host = std::filesystem::read_symlink("/proc/self/exe", ignored);
  for (const std::filesystem::path& candidate :
       {own / "ist-import", own / "../libexec/ist/ist-import", own / "../../libexec/ist/ist-import",
        std::filesystem::path(IST_LIBEXEC "/ist/ist-import"), host.parent_path() / "ist-import"}) {
    if (candidate.is_absolute() && std::filesystem::is_regular_file(candidate, ignored))
      return candidate.lexically_normal();
  }
  return {};
}

// Throws the error of a run that gave no complete answer.
[[noreturn]] void fail_of(const ImportRun& run, const std::filesystem::path& importer,
                          const std::string& file) {
  using End = ImportRun::End;
  ErrorCode code = ErrorCode::kMeshTooLarge;
  std::string cause;
  if (run.end == End::kTooLate || (run.end == End::kSignal && run.code == SIGXCPU)) {
    cause = "ist-import took too long to read it, and was ended";
  } else if (run.end == End::kTooMuch) {
    cause = "ist-import made more of it than the library takes";
  } else if (run.end == End::kSignal) {
    code = ErrorCode::kNotAMesh;
    cause = fmt::format("the importer ended by signal {} while it read the file", run.code);
  } else {
    code = ErrorCode::kFileUnreadable;
    cause = fmt::format("ist-import at {} ended without a complete answer{}", importer.string(),
                        run.end == End::kExit ? fmt::format(" (exit code {})", run.code) : "");
  }
  fail_mesh(code, file, "", fmt::format("{}: {}", cause, kConvert));
}

}  // namespace

TriangleMesh read_imported(std::string_view content, const std::filesystem::path& file) {
  const std::string name = file.string();
  const std::filesystem::path importer = importer_path(name);
  if (importer.empty())
    fail_mesh(ErrorCode::kFileUnreadable, name, "",
              fmt::format("its format is read by the program ist-import, which is not installed: "
                          "install it, or name it by the environment variable IST_IMPORT, or {}",
                          kConvert));
  const ImportRun run = run_importer(importer, content, file);
  if (!is_complete_import(run.answer)) fail_of(run, importer, name);
  return read_import_message(run.answer, importer, name);
}

std::string_view readable_formats() { return kMeshFormats; }

}  // namespace ist
