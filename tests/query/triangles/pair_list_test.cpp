#include "ist/query/triangles/pair_list.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "simd/guarded.h"
#include "support/random.h"

namespace ist::test {
namespace {

TEST(PairList, HoldsTheFirstPairsInOrder) {
  Random random(3);
  for (const std::size_t scratch : {0u, 70u, 5000u}) {
    PairList list(scratch);
    for (const std::uint32_t range : {4u, 300u, 70'000u, 4'000'000'000u}) {
      for (const std::size_t count : {0u, 1u, 63u, 64u, 65u, 700u, 3000u}) {
        std::vector<TrianglePair> wanted;
        for (std::size_t k = 0; k < count; ++k) {
          wanted.push_back({random.below(range), random.below(range)});
        }
        for (const std::size_t room : {0u, 1u, 64u, 699u, 700u, 4000u}) {
          Guarded<TrianglePair> out(room, 1);
          list.begin(out.span());
          for (const TrianglePair& pair : wanted) list.add(pair);
          list.finish();
          std::vector<TrianglePair> sorted = wanted;
          std::sort(sorted.begin(), sorted.end());
          ASSERT_EQ(list.count(), count);
          const auto kept = static_cast<std::ptrdiff_t>(std::min(room, count));
          ASSERT_TRUE(std::equal(sorted.begin(), sorted.begin() + kept, out.data()));
          ASSERT_TRUE(out.intact());
        }
      }
    }
  }
}

}  // namespace
}  // namespace ist::test
