#include "ist/capi/status.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "capi/c_bodies.h"

namespace ist::test {
namespace {

// Fails for an ErrorCode without a number in the C interface.
TEST(CStatus, HasEveryErrorCode) {
  int codes = 0;
  for (; to_string(static_cast<ErrorCode>(codes)) != std::string("unknown"); ++codes) {
    const auto code = static_cast<ErrorCode>(codes);
    const ist_status status = capi::status_of(code);
    if (code == ErrorCode::kArgumentInvalid) {
      EXPECT_EQ(status, IST_ARGUMENT_INVALID);  // as old as the C interface
    } else if (code == ErrorCode::kCancelled) {
      EXPECT_EQ(status, IST_CANCELLED);  // of the C interface first
    } else {
      EXPECT_GT(status, 100) << to_string(code);
    }
    EXPECT_EQ(capi::error_code_of(status), code);
    EXPECT_EQ(name(status), to_string(code));
  }
  EXPECT_GE(codes, 22);
  EXPECT_EQ(capi::status_of(static_cast<ErrorCode>(codes)), IST_INTERNAL_ERROR);
}

TEST(CStatus, HasNamesThatDiffer) {
  std::set<std::string> names;
  for (ist_status status = IST_OK; status <= IST_CANCELLED; ++status) {
    names.insert(name(status));
    EXPECT_EQ(capi::error_code_of(status).has_value(),
              status == IST_ARGUMENT_INVALID || status == IST_CANCELLED);
  }
  EXPECT_EQ(names.size(), std::size_t{IST_CANCELLED} + 1);
  EXPECT_EQ(names.count("unknown"), 0u);
  EXPECT_EQ(name(-1), "unknown");
  EXPECT_EQ(name(99), "unknown");
  EXPECT_EQ(name(INT32_MAX), "unknown");
}

TEST(CVersion, IsTheHeadersAndTheProjects) {
  EXPECT_EQ(ist_abi_version(), std::uint32_t{IST_ABI_VERSION});
  EXPECT_STREQ(ist_version_string(), IST_VERSION);
}

}  // namespace
}  // namespace ist::test
