#include <gtest/gtest.h>

#include "support/stability.h"

namespace ist::test {
namespace {

TEST(StabilityCase, Placeholder) {}

}  // namespace
}  // namespace ist::test
