// Calls each fuzz target with the inputs of its corpus, and with the same inputs after a few bytes
// have changed. CMake unpacks corpus/TARGET.zip into a folder TARGET. An input is called
// OUTCOME.WHAT; its target must return OUTCOME.

#include <gtest/gtest.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <set>

#include "fuzz/fuzz_target.h"
#include "support/effort.h"
#include "support/random.h"
#include "support/stability.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

struct Target {
  const char* name;
  std::string (*run)(std::string_view bytes);
  std::set<std::string> outcomes;  // each must be in the corpus
};

void PrintTo(const Target& target, std::ostream* out) { *out << target.name; }

const std::vector<Target>& targets() {
  static const std::vector<Target> all{
      {"import", fuzz_import, {"fine", "file-unreadable", "mesh-not-finite", "mesh-empty"}},
      {"labels", fuzz_labels, {"fine", "input-invalid", "not-a-mesh", "mesh-bad-index"}},
      {"mesh",
       fuzz_mesh,
       {"fine", "not-a-mesh", "mesh-empty", "mesh-points-only", "mesh-truncated", "mesh-bad-index",
        "mesh-not-finite", "mesh-extent"}},
      {"poses", fuzz_poses, {"fine", "input-invalid", "pose-invalid"}},
      {"query", fuzz_query, {"touching", "apart", "invalid"}},
      {"scene", fuzz_scene, {"fine", "input-invalid"}},
      {"tree", fuzz_tree, {"fine", "not-a-tree", "tree-version", "tree-truncated", "tree-corrupt"}},
      {"vectors", fuzz_vectors, {"agree", "differ", "input-invalid", "fixed-point-range"}},
  };
  return all;
}

// What a target says, or why it is a finding.
std::string outcome(const Target& target, const std::string& bytes) {
  try {
    return target.run(bytes);
  } catch (const std::exception& finding) {
    return std::string("a finding: ") + finding.what();
  }
}

std::vector<std::filesystem::path> corpus(const Target& target) {
  const auto folder = std::filesystem::path(IST_CORPUS) / target.name;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

class Corpus : public ::testing::TestWithParam<Target> {};

INSTANTIATE_TEST_SUITE_P(Targets, Corpus, ::testing::ValuesIn(targets()),
                         [](const auto& target) { return std::string(target.param.name); });

TEST_P(Corpus, ComesToWhatItsNamesSay) {
  StabilityCase files("faults", std::string("corpus of ") + GetParam().name, "wrong outcomes");
  std::set<std::string> seen;
  for (const std::filesystem::path& file : corpus(GetParam())) {
    const std::string name = file.filename(), expected = name.substr(0, name.find('.'));
    const std::string got = outcome(GetParam(), file_content(file));
    files.sample(got == expected ? 0 : 1, 0, name + " comes to " + got);
    seen.insert(expected);
  }
  for (const std::string& each : GetParam().outcomes) {
    EXPECT_TRUE(seen.contains(each)) << "no file comes to " << each;
  }
}

// One to four bytes are changed, taken out, put in, or doubled as a block.
std::string changed(std::string bytes, Random& random) {
  for (std::size_t left = 1 + random.below(4); left > 0 && !bytes.empty(); --left) {
    const std::size_t at = random.below(static_cast<std::uint32_t>(bytes.size()));
    switch (random.below(4)) {
      case 0:
        bytes[at] = static_cast<char>(random.below(256));
        break;
      case 1:
        bytes.erase(at, 1 + random.below(8));
        break;
      case 2:
        bytes.insert(at, 1, static_cast<char>(random.below(256)));
        break;
      default:
        bytes.insert(at, bytes.substr(at, 1 + random.below(16)));
    }
  }
  return bytes;
}

TEST_P(Corpus, IsNoFindingWithBytesChanged) {
  StabilityCase files("faults", std::string("changed corpus of ") + GetParam().name, "findings");
  Random random(5);
  for (const std::filesystem::path& file : corpus(GetParam())) {
    const std::string bytes = file_content(file);
    for (int i = samples(8); i > 0; --i) {
      const std::string got = outcome(GetParam(), changed(bytes, random));
      files.sample(got.starts_with("a finding") ? 1 : 0, 0, file.filename().string() + ": " + got);
    }
  }
}

}  // namespace
}  // namespace ist::test
