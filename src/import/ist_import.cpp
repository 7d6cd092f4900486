// ist-import: reads mesh files by other people's readers, which may crash, in a process of its own.

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <utility>

#include "import/placed_polygons.h"
#include "import/process_limits.h"
#include "import/readers.h"
#include "import/scene_format.h"
#include "ist/mesh/import/import_message.h"

namespace ist::import {
namespace {

constexpr std::string_view kUsage =
    R"(usage: ist-import FILE < FILE > ANSWER

Reads a mesh for libist and the command ist: glTF, 3MF, and what assimp knows.
The content comes from stdin. FILE is its path: its name may tell the format,
and files that it names are read from its folder. The answer is for libist.
Set IST_IMPORT to the path of this program if libist does not find it.

  --help     print this text
  --version  print the version
)";

std::string all_of_stdin() {
  std::string content;
  struct stat status {};
  if (::fstat(STDIN_FILENO, &status) == 0 && S_ISREG(status.st_mode))
    content.reserve(static_cast<std::size_t>(status.st_size));
  constexpr std::size_t kAtOnce = 1 << 20;
  for (;;) {
    const std::size_t before = content.size();
    content.resize(before + kAtOnce);
    const ssize_t got = ::read(STDIN_FILENO, content.data() + before, kAtOnce);
    content.resize(before + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0)
      refuse(ErrorCode::kFileUnreadable, "stdin", "the content cannot be read; give it by < FILE");
    if (got == 0) return content;
  }
}

void write_all(const void* data, std::size_t bytes) {
  const char* next = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t done = ::write(STDOUT_FILENO, next, bytes);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) ::_exit(1);  // nobody listens
    next += done;
    bytes -= static_cast<std::size_t>(done);
  }
}

template <class Range>
void write_all(const Range& range) {
  write_all(range.data(), range.size() * sizeof *range.data());
}

void answer(const PlacedPolygons& mesh) {
  ImportHeader header = import_header();
  header.kind = ImportHeader::kMesh;
  header.unit = static_cast<std::uint32_t>(mesh.unit);
  header.vertices = mesh.coordinates().size() / 3;
  header.polygons = mesh.sizes().size();
  header.corners = mesh.corners().size();
  write_all(&header, sizeof header);
  write_all(mesh.coordinates());
  write_all(mesh.sizes());
  write_all(mesh.corners());
  write_all(kImportEnd);
}

void answer(const Refusal& refusal) {
  ImportHeader header = import_header();
  header.kind = ImportHeader::kError;
  header.unit = static_cast<std::uint32_t>(refusal.code);
  header.vertices = refusal.place.size();
  header.polygons = refusal.cause.size();
  write_all(&header, sizeof header);
  write_all(refusal.place);
  write_all(refusal.cause);
  write_all(kImportEnd);
}

void run(const char* path) {
  try {
    struct stat status {};
    const bool known = ::fstat(STDIN_FILENO, &status) == 0;
    if (!limit_resources(known ? static_cast<std::size_t>(status.st_size) : 0) ||
        !limit_system_calls())
      refuse(ErrorCode::kFileUnreadable, "",
             fmt::format("the kernel does not limit what ist-import may do (setrlimit, seccomp): "
                         "allow it, or {}",
                         kConvert));
    Input input{all_of_stdin(), path};
    const std::string format = scene_format(input);
    answer(format == "3mf" ? read_3mf(input) : read_scene(std::move(input), format));
  } catch (const Refusal& refusal) {
    answer(refusal);
  } catch (const std::bad_alloc&) {
    answer(Refusal{ErrorCode::kMeshTooLarge, "",
                   fmt::format("to read it takes more than 4 GiB of memory; {}", kConvert)});
  } catch (const std::exception& error) {
    answer(Refusal{ErrorCode::kNotAMesh, "", fmt::format("{}; {}", error.what(), kConvert)});
  }
  // The answer is complete. A foreign destructor could only crash.
  ::_exit(0);
}

}  // namespace
}  // namespace ist::import

int main(int argc, char** argv) {
  const std::string_view word = argc > 1 ? argv[1] : "";
  if (argc == 2 && word == "--version") return std::printf("ist-import %s\n", IST_VERSION) < 0;
  const bool help = argc == 2 && word == "--help";
  if (argc == 2 && !word.starts_with("--") && !word.empty()) ist::import::run(argv[1]);
  std::fputs(ist::import::kUsage.data(), help ? stdout : stderr);
  return help ? 0 : 2;
}
