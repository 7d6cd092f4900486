#include "answers/version.h"

#include <fmt/format.h>

#include "answers/commit.h"
#include "answers/engine.h"
#include "ist/tree/tree_stream.h"

namespace ist::answers {
namespace {

#ifdef __clang__
constexpr const char* kCompiler = "clang " __clang_version__;
#else
constexpr const char* kCompiler = "g++ " __VERSION__;
#endif

}  // namespace

std::string version_words() { return fmt::format("ist {}, commit {}", IST_VERSION, IST_COMMIT); }

std::string version_lines() {
  return fmt::format("ist {}\ncommit {}\ncompiler {}\ninstruction sets {}\ntree file version {}",
                     IST_VERSION, IST_COMMIT, kCompiler, target_names(), kTreeFileVersion);
}

}  // namespace ist::answers
