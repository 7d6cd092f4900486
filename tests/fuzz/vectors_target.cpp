// A file of golden vectors, as `ist table --check` takes it.

#include "fuzz/fuzz_target.h"
#include "hardware/vector_file.h"
#include "ist/base/error.h"
#include "support/temp_dir.h"

namespace ist::test {

std::string fuzz_vectors(std::string_view bytes) {
  static const MemoryFile file;
  file.write(bytes);
  constexpr std::size_t kMost = 2;
  VectorCheck check;
  try {
    check = check_vectors(file.path(), kMost);
  } catch (const Error& error) {
    require(std::string_view(error.what()).starts_with(file.path().string()),
            "an error does not name the file");
    return to_string(error.code());
  }
  require(check.vectors > 0, "a file without vectors is fine");
  require(check.wrong > 0 || check.checksum_holds, "vectors that were changed are fine");
  require((check.wrong > 0) == !check.differences.empty(), "what differs is not told");
  require(check.differences.size() <= kMost, "more is told than was asked for");
  for (const VectorDifference& at : check.differences) {
    require(at.line > 8 && at.line <= 8 + check.vectors, "a line that is not there differs");
    require(at.is != at.should_be, "what is told is no difference");
  }
  return check.wrong == 0 ? "agree" : "differ";
}

}  // namespace ist::test
