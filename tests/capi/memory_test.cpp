// A failed allocation gives an error code, and the process continues.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <fstream>

#include "capi/c_bodies.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

// Limits the process to `more` bytes beyond its present address space.
class LittleMemory {
 public:
  explicit LittleMemory(rlim_t more) {
    rlim_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    getrlimit(RLIMIT_AS, &before_);
    rlimit now = before_;
    now.rlim_cur = 4096 * pages + more;
    setrlimit(RLIMIT_AS, &now);
  }
  ~LittleMemory() { setrlimit(RLIMIT_AS, &before_); }
  LittleMemory(const LittleMemory&) = delete;
  LittleMemory& operator=(const LittleMemory&) = delete;

 private:
  rlimit before_{};
};

TEST(CMemory, ThatIsNotThereIsTold) {
  // With enough leaves that a frontier is one block of half a gigabyte: the heaps that threads of
  // other tests left behind, 64 MB at most, have no room for it.
  ist_tree* tree = c_tree(icosphere(2, 1), 0.03);
  auto options = sized<ist_query_options>();
  options.frontier_pairs = 1 << 26;
  ist_query* query = nullptr;
  std::string status, message;
  {
    const LittleMemory little(100 << 20);
    status = name(ist_query_create(tree, tree, &options, &query));
    message = ist_last_error_message();
  }
  EXPECT_EQ(status, "out-of-memory");
  EXPECT_EQ(message, "ist_query_create: not enough memory: request less, or free unused objects");
  EXPECT_EQ(query, nullptr);

  ASSERT_EQ(name(ist_query_create(tree, tree, nullptr, &query)), "ok");
  auto result = sized<ist_query_result>();
  EXPECT_EQ(
      name(ist_query_leaf_pairs(query, c_shift(1.9, 0, 0).data(), nullptr, nullptr, 0, &result)),
      "ok");
  EXPECT_GT(result.leaf_pairs, 0u);
  EXPECT_EQ(name(ist_query_free(query)), "ok");
  EXPECT_EQ(name(ist_tree_free(tree)), "ok");
}

}  // namespace
}  // namespace ist::test
