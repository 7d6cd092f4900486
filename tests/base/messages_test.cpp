#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "ist/base/counted.h"
#include "ist/base/error.h"
#include "ist/base/printable.h"

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

TEST(Counted, OneHasNoPlural) {
  EXPECT_EQ(counted(0, "triangle"), "0 triangles");
  EXPECT_EQ(counted(1u, "triangle"), "1 triangle");
  EXPECT_EQ(counted(std::size_t{2}, "triangle"), "2 triangles");
  EXPECT_EQ(counted(1, "vertex", "vertices"), "1 vertex");
  EXPECT_EQ(counted(3, "vertex", "vertices"), "3 vertices");
}

TEST(Printable, KeepsTextAsItIs) {
  for (const std::string& text :
       {std::string(), std::string("a b/c\\d?"), std::string("Zähne 歯 🦷"),
        std::string("\xC2\xA0\xED\x9F\xBF\xEE\x80\x80"), std::string(40, 'x')})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, MarksWhatATerminalWouldObey) {
  const std::pair<std::string, std::string> all[] = {
      {"\x1B[31mred\x1B[0m", "?[31mred?[0m"},
      {std::string("a\0b", 3), "a?b"},
      {"line\r\n\ttwo\x1F\x7F", "line???two??"},
      {"\xC2\x9B"
       "31m",
       "??31m"},  // the control sequence introducer of Latin-1, in UTF-8
      {"\x9B"
       "31m",
       "?31m"},  // and as it is
      {"\xC3", "?"},
      {"\xC0\xAF", "??"}};
  for (const auto& [text, shown] : all) EXPECT_EQ(printable(text), shown);
}

TEST(Printable, CutsBetweenTwoCharacters) {
  EXPECT_EQ(printable(std::string(41, 'x')), std::string(40, 'x'));
  const std::string full(39, 'x'), room(38, 'x');
  EXPECT_EQ(printable(full + "ä"), full);
  EXPECT_EQ(printable(room + "ä"), room + "ä");
  EXPECT_EQ(printable("歯歯", 5), "歯");
  EXPECT_EQ(printable("abc", 0), "");
}

}  // namespace
}  // namespace ist
