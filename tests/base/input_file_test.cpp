#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>

#include "ist/base/files.h"
#include "support/errors.h"
#include "support/temp_dir.h"

namespace ist {
namespace {

void expect_unreadable(const std::filesystem::path& path) {
  const auto error = test::error_of([&] { InputFile file(path); });
  ASSERT_TRUE(error) << path;
  EXPECT_EQ(error->code(), ErrorCode::kFileUnreadable);
  EXPECT_NE(std::string(error->what()).find(path.string()), std::string::npos) << error->what();
}

TEST(InputFile, ReadsFromFrontToBackAndShortOnlyAtTheEnd) {
  const test::TempDir folder;
  InputFile file(folder.write("in", "abcdefg"));
  EXPECT_EQ(file.size(), 7u);
  char data[8] = "-------";
  EXPECT_EQ(file.read(data, 3), 3u);
  EXPECT_EQ(std::string(data), "abc----");
  EXPECT_EQ(file.read(data, 0), 0u);
  EXPECT_EQ(file.read(data, 7), 4u);
  EXPECT_EQ(std::string(data), "defg---");
  EXPECT_EQ(file.read(data, 7), 0u);
}

TEST(InputFile, IsReadAsItIsWhereItChangesAfterItWasOpened) {
  const test::TempDir folder;
  const auto path = folder.write("in", "abcdefg");
  InputFile cut(path);
  std::filesystem::resize_file(path, 3);
  EXPECT_EQ(cut.size(), 7u);
  EXPECT_EQ(cut.read_rest(), "abc");
  EXPECT_EQ(cut.read_rest(), "");
  InputFile grown(path);
  folder.write("in", "abcdefghijklmnopq");
  EXPECT_EQ(grown.read_rest(), "abcdefghijklmnopq");
}

TEST(InputFile, AnEmptyFileIsAFile) {
  const test::TempDir folder;
  InputFile file(folder.write("empty", ""));
  char byte = 0;
  EXPECT_EQ(file.size(), 0u);
  EXPECT_EQ(file.read(&byte, 1), 0u);
}

TEST(InputFile, RefusesWhatIsNotThereAndWhatIsNoFile) {
  const test::TempDir folder;
  expect_unreadable(folder.path() / "missing");
  expect_unreadable(folder.path());
  expect_unreadable("/dev/null");
}

TEST(InputFile, APipeThatNobodyWritesToDoesNotBlock) {
  const test::TempDir folder;
  const auto pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  expect_unreadable(pipe);
}

}  // namespace
}  // namespace ist
