#include "ist/base/compensated.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/effort.h"
#include "support/exact.h"
#include "support/random.h"

namespace ist {
namespace {

constexpr double kUnit = 0x1p-53;

double at_scale(test::Random& random, int largest_exponent) {
  return std::ldexp(random.uniform(-1, 1),
                    static_cast<int>(random.below(static_cast<std::uint32_t>(largest_exponent))));
}

TEST(CompensatedSum, FindsWhatAPlainSumLoses) {
  CompensatedSum sum;
  for (const double term : {1e16, 1.0, -1e16}) sum.add(term);
  EXPECT_EQ(sum.value(), 1.0);
  CompensatedSum product;
  product.add_product(1 + 0x1p-30, 1 - 0x1p-30);
  product.add(-1);
  EXPECT_EQ(product.value(), -0x1p-60);
}

TEST(CompensatedSum, StaysWithinItsBoundOnSumsThatNearlyCancel) {
  test::Random random(1);
  for (int round = 0; round < test::samples(200); ++round) {
    const std::size_t half = 2 + random.below(50);
    CompensatedSum sum;
    mpq_class exact = 0, magnitude = 0;
    const auto add = [&](double term) {
      sum.add(term);
      exact += mpq_class(term);
      magnitude += abs(mpq_class(term));
    };
    for (std::size_t i = 0; i < half; ++i) {
      const double term = at_scale(random, 60);
      add(term);
      add(-term + random.uniform(-1, 1) * 1e-3);  // condition numbers up to 1e20
    }
    const double n = 2.0 * static_cast<double>(half);
    const mpq_class bound =
        mpq_class(kUnit) * abs(exact) + mpq_class(n * n * kUnit * kUnit) * magnitude;
    EXPECT_LE(abs(mpq_class(sum.value()) - exact), bound);
  }
}

TEST(CompensatedSum, StaysWithinItsBoundOnDotProductsThatNearlyCancel) {
  test::Random random(2);
  for (int round = 0; round < test::samples(200); ++round) {
    const std::size_t half = 1 + random.below(50);
    CompensatedSum sum;
    mpq_class exact = 0, magnitude = 0;
    const auto add = [&](double a, double b) {
      sum.add_product(a, b);
      const mpq_class product = mpq_class(a) * mpq_class(b);
      exact += product;
      magnitude += abs(product);
    };
    for (std::size_t i = 0; i < half; ++i) {
      const double a = at_scale(random, 40), b = at_scale(random, 40);
      add(a, b);
      add(-a * (1 + 0x1p-50), b * (1 - 0x1p-50));
    }
    const double n = 4.0 * static_cast<double>(half);  // a product is two terms
    const mpq_class bound =
        mpq_class(kUnit) * abs(exact) + mpq_class(n * n * kUnit * kUnit) * magnitude;
    EXPECT_LE(abs(mpq_class(sum.value()) - exact), bound);
  }
}

TEST(CompensatedSum, ADeterminantOfTwoProductsIsRightToTheLastBitButOne) {
  test::Random random(3);
  for (int round = 0; round < test::samples(10'000); ++round) {
    const double a = random.uniform(0.5, 2), b = random.uniform(0.5, 2), c = random.uniform(0.5, 2);
    const double d = b * c / a;  // a·d - b·c is all rounding
    CompensatedSum sum;
    sum.add_product(a, d);
    sum.add_product(-b, c);
    const mpq_class exact = mpq_class(a) * mpq_class(d) - mpq_class(b) * mpq_class(c);
    EXPECT_LE(abs(mpq_class(sum.value()) - exact), mpq_class(2 * kUnit) * abs(exact));
  }
}

TEST(CompensatedSum, NothingIsZero) { EXPECT_EQ(CompensatedSum().value(), 0.0); }

}  // namespace
}  // namespace ist
