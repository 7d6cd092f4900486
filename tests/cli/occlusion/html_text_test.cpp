#include "cli/occlusion/html/html_text.h"

#include <gtest/gtest.h>

namespace ist::test {
namespace {

using cli::base64_of, cli::escaped;

TEST(HtmlText, MarkupIsEscaped) {
  EXPECT_EQ(escaped("<a href=\"x\">'&amp;</a>"),
            "&lt;a href=&quot;x&quot;&gt;&#39;&amp;amp;&lt;/a&gt;");
  EXPECT_EQ(escaped("Zähne µ 歯 😀 ‰"), "Zähne µ 歯 😀 ‰");
  EXPECT_EQ(escaped(""), "");
}

TEST(HtmlText, WhatIsNoCharacterIsReplaced) {
  EXPECT_EQ(escaped("a\x01z\n\x7F"), "a\uFFFDz\uFFFD\uFFFD");
  EXPECT_EQ(escaped("\xC2\x85|\xC2\xA0"), "\uFFFD|\u00A0");
  EXPECT_EQ(escaped("\xFF|\x80|\xC0\xAF|\xC1z"), "\uFFFD|\uFFFD|\uFFFD\uFFFD|\uFFFDz");
  EXPECT_EQ(escaped("\xC3"), "\uFFFD") << "cut off";
  EXPECT_EQ(escaped("\xE2\x82"), "\uFFFD\uFFFD");
  EXPECT_EQ(escaped("\xE2\x82<"), "\uFFFD\uFFFD&lt;");
  EXPECT_EQ(escaped("\xE0\x80\xAF"), "\uFFFD\uFFFD\uFFFD") << "longer than it need be";
  EXPECT_EQ(escaped("\xED\xA0\x80"), "\uFFFD\uFFFD\uFFFD") << "half of a pair";
  EXPECT_EQ(escaped("\xF4\x90\x80\x80").size(), 12U) << "beyond the last character";
  EXPECT_EQ(escaped("\xF0\x80\x80\x80").size(), 12U);
  EXPECT_EQ(escaped("\xEF\xBF\xBE"), "\uFFFD");
}

TEST(HtmlText, Base64IsThatOfRfc4648) {
  EXPECT_EQ(base64_of(""), "");
  EXPECT_EQ(base64_of("f"), "Zg==");
  EXPECT_EQ(base64_of("fo"), "Zm8=");
  EXPECT_EQ(base64_of("foo"), "Zm9v");
  EXPECT_EQ(base64_of("foob"), "Zm9vYg==");
  EXPECT_EQ(base64_of("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64_of("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64_of(std::string_view("\xFB\xFF\xFE\x00", 4)), "+//+AA==");
}

}  // namespace
}  // namespace ist::test
