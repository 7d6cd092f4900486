#include "c/status.h"

#include <gtest/gtest.h>

#include <new>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>

#include "c/guard.h"
#include "capi/c_bodies.h"
#include "ist/base/error.h"

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

// No exception leaves a C function; each becomes an error code.

template <typename Exception>
std::string thrown(const Exception& exception) {
  return name(capi::guarded("f", [&](capi::Call&) { throw exception; }));
}

TEST(CGuard, TurnsEveryExceptionIntoACode) {
  EXPECT_EQ(thrown(std::bad_alloc()), "out-of-memory");
  EXPECT_EQ(thrown(std::bad_array_new_length()), "out-of-memory");
  EXPECT_EQ(thrown(std::length_error("too long")), "out-of-memory");
  EXPECT_EQ(thrown(std::system_error(std::make_error_code(std::errc::io_error))), "system-error");
  EXPECT_EQ(thrown(std::logic_error("a bug")), "internal-error");
  EXPECT_STREQ(ist_last_error_message(), "f: a bug");
  EXPECT_EQ(thrown(7), "internal-error");
  EXPECT_EQ(thrown(std::string("text")), "internal-error");
}

TEST(CGuard, KeepsAnErrorsCodeAndText) {
  for (int i = 0; to_string(static_cast<ErrorCode>(i)) != std::string("unknown"); ++i) {
    const auto code = static_cast<ErrorCode>(i);
    EXPECT_EQ(thrown(Error(code, "place: cause: remedy")), to_string(code));
    EXPECT_STREQ(ist_last_error_message(), "f: place: cause: remedy");
  }
}

TEST(CGuard, LeavesTheMessageAloneWhereNothingFails) {
  EXPECT_EQ(thrown(std::logic_error("a bug")), "internal-error");
  EXPECT_EQ(capi::guarded("g", [](capi::Call&) {}), IST_OK);
  EXPECT_STREQ(ist_last_error_message(), "f: a bug");
}

TEST(CGuard, KeepsTheFirstOfTwoErrors) {
  const auto failing = [](capi::Call& call) {
    EXPECT_FALSE(call.need("a", nullptr));
    call.fail(IST_NOT_A_MESH, "b");
    throw std::logic_error("c");
  };
  EXPECT_EQ(name(capi::guarded("f", failing)), "null-argument");
  EXPECT_STREQ(ist_last_error_message(), "f: a is NULL: pass a valid pointer");
}

TEST(CGuard, CutsAMessageThatIsTooLong) {
  const std::string text(10'000, 'x');
  EXPECT_EQ(thrown(std::logic_error(text)), "internal-error");
  EXPECT_EQ(std::string(ist_last_error_message()), "f: " + text.substr(0, 508));
  const auto failing = [&](capi::Call& call) { call.fail(IST_NOT_A_MESH, "{}", text); };
  EXPECT_EQ(name(capi::guarded("function", failing)), "not-a-mesh");
  EXPECT_EQ(std::string(ist_last_error_message()), "function: " + text.substr(0, 501));
}

}  // namespace
}  // namespace ist::test
