#include "support/data_dir.h"

#include <cstdlib>

namespace ist::test {

std::filesystem::path data_dir() {
  const char* named = std::getenv("IST_DATA_DIR");
  return named != nullptr ? named : IST_SOURCE_DIR "/../shared/data";
}

}  // namespace ist::test
