#include "ist/base/error.h"

#include <gtest/gtest.h>

#include <string>

namespace ist {
namespace {

TEST(Error, EveryCodeHasANameOfItsOwn) {
  for (int i = 0; i <= static_cast<int>(ErrorCode::kCancelled); ++i) {
    const std::string name = to_string(static_cast<ErrorCode>(i));
    EXPECT_NE(name, "unknown");
    for (int j = 0; j < i; ++j) EXPECT_NE(name, to_string(static_cast<ErrorCode>(j)));
  }
}

TEST(Error, CarriesItsCodeAndItsText) {
  const Error error(ErrorCode::kMemoryLimit, "what, where and what to do");
  EXPECT_EQ(error.code(), ErrorCode::kMemoryLimit);
  EXPECT_STREQ(error.what(), "what, where and what to do");
  EXPECT_STREQ(to_string(error.code()), "memory-limit");
}

}  // namespace
}  // namespace ist
