#pragma once

#include <gtest/gtest.h>

#include <clocale>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <locale>
#include <regex>
#include <string>

#include "support/effort.h"
#include "support/run_command.h"
#include "support/scoped_variable.h"
#include "support/temp_dir.h"

namespace ist::test {

/// Tests in the locale of a country that writes 0,5 and 1.000.000: in C's and in C++'s, as a host
/// program may set them. The environment names it too, for programs that are run.
class GermanLocale : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists("/usr/share/i18n/locales/de_DE")) {
      IST_SKIP("no sources of locales are here: scripts/setup.sh --tests installs them");
    }
    static const TempDir kLocales;  // one for all tests of a program
    static const CommandResult kMade =
        run_command("/usr/bin/localedef", {"--no-archive", "-i", kLocales.write("source", source()),
                                           "-f", "UTF-8", kLocales.path() / kName});
    ASSERT_EQ(kMade.exit_code, 0) << kMade.err;
    locales_.set(kLocales.path().c_str());
    language_.set(kName);
    set_german();
    ASSERT_STREQ(std::localeconv()->decimal_point, ",");
    ASSERT_EQ(std::strtod("0,5", nullptr), 0.5);
  }
  void TearDown() override { set_classic(); }

  static void set_german() { std::locale::global(std::locale(kName)); }  // C's with it
  static void set_classic() { std::locale::global(std::locale::classic()); }

  /// `speak` returns one text in both locales, with a number that has a decimal point.
  static void expect_same(const std::function<std::string()>& speak) {
    set_classic();
    const std::string expected = speak();
    set_german();
    EXPECT_EQ(speak(), expected);
    EXPECT_TRUE(std::regex_search(expected, std::regex("[0-9]\\.[0-9]"))) << expected;
  }

  /// Its numbers; and no alphabet, which takes two seconds to make.
  static std::string source() {
    std::string text;
    for (const char* part : {"CTYPE", "COLLATE", "TIME", "MESSAGES", "NUMERIC", "MONETARY", "PAPER",
                             "NAME", "ADDRESS", "TELEPHONE", "MEASUREMENT", "IDENTIFICATION"}) {
      const std::string name = part;
      const bool plain =
          name == "CTYPE" || name == "COLLATE" || name == "TIME" || name == "MESSAGES";
      text +=
          "LC_" + name + "\ncopy \"" + (plain ? "POSIX" : "de_DE") + "\"\nEND LC_" + name + "\n";
    }
    return text;
  }

  static constexpr const char* kName = "de_DE.UTF-8";
  const TempDir folder_;
  const ScopedVariable locales_{"LOCPATH", nullptr}, language_{"LC_ALL", nullptr};
};

}  // namespace ist::test
