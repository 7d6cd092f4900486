// The random numbers are numpy's, word by word.

#include "sweep/philox.h"

#include <gtest/gtest.h>

#include <array>

namespace ist::test {
namespace {

struct Known {
  std::uint64_t seed, stream;
  std::array<std::uint64_t, 9> words;  // numpy.random.Philox(key=seed, counter=[0, stream, 0, 0])
};

TEST(Philox, GivesTheWordsOfNumpy) {
  const Known all[] = {{0,
                        0,
                        {0x2f4ba6408e4d89b, 0x3dd62b0b9ca8c5b2, 0x1c8667a55d902e79,
                         0x907d7a052fd5b4dc, 0x809bf322883987c3, 0x471128b9e807f7dd,
                         0xf250ba0dbec065b7, 0xfc6ed66767a457bc, 0x40fa86f0f781945d}},
                       {7,
                        3,
                        {0x7062734096a622d9, 0x2a689b984de514c3, 0xfb785222f6fac48f,
                         0x76f3a8d69bc1e6d3, 0x5e7b7794719b66d5, 0xdcf5c204a7d561e,
                         0xa6a44c4f90cf34, 0xb9086f6602d18b82, 0xcdfa83f850be665e}},
                       {9223372036854775807U,
                        999999999999U,
                        {0x5af3316bb5ba5cd, 0xf848d45622afdd43, 0x3dd7472b1259c648,
                         0x501697d04511b9e1, 0x3a9572e326372e24, 0x7c2e65f11d192029,
                         0xec62c14f8859e720, 0x84ccb1aa4e3584f0, 0x9ac431bd5dd3aba0}}};
  for (const Known& known : all) {
    Philox random(known.seed, known.stream);
    for (const std::uint64_t word : known.words) EXPECT_EQ(random.bits(), word);
  }
}

TEST(Philox, GivesTheNumbersOfNumpysGenerator) {
  Philox random(7, 3);
  for (const double number :
       {0x1.c189cd025a988p-2, 0x1.5344dcc26f288p-3, 0x1.f6f0a445edf58p-1, 0x1.dbcea35a6f078p-2}) {
    EXPECT_EQ(random.uniform(), number);
  }
}

}  // namespace
}  // namespace ist::test
