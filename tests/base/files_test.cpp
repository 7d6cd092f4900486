#include "ist/base/files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <string>

#include "support/effort.h"
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

using test::error_of;
using test::file_content;

void write(OutputFile& file, const std::string& text) { file.write(text.data(), text.size()); }

TEST(OutputFile, IsThereWholeAfterCommitAndNothingElseIs) {
  const test::TempDir folder;
  const auto target = folder.path() / "out";
  {
    OutputFile file(target);
    write(file, "????body");
    EXPECT_FALSE(std::filesystem::exists(target));
    write(file, " and end");
    file.write_at(0, "head", 4);
    EXPECT_FALSE(std::filesystem::exists(target));
    file.commit();
    EXPECT_EQ(file_content(target), "headbody and end");
  }
  EXPECT_EQ(file_content(target), "headbody and end");
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(OutputFile, IsNotThereWithoutCommit) {
  const test::TempDir folder;
  {
    OutputFile file(folder.path() / "out");
    write(file, "half of it");
  }
  EXPECT_EQ(folder.entries(), 0u);
}

TEST(OutputFile, AnOlderFileStaysAsItWasUntilCommit) {
  const test::TempDir folder;
  const auto target = folder.write("out", "old");
  {
    OutputFile file(target);
    write(file, "new, but given up");
  }
  EXPECT_EQ(file_content(target), "old");
  EXPECT_EQ(folder.entries(), 1u);
  OutputFile file(target);
  write(file, "new");
  EXPECT_EQ(file_content(target), "old");
  file.commit();
  EXPECT_EQ(file_content(target), "new");
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(OutputFile, TwoOfOneNameDoNotMix) {
  const test::TempDir folder;
  const auto target = folder.path() / "out";
  OutputFile first(target), second(target);
  write(first, "first");
  write(second, "second");
  first.commit();
  EXPECT_EQ(file_content(target), "first");
  second.commit();
  EXPECT_EQ(file_content(target), "second");
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(OutputFile, WritesThroughALinkWithoutReplacingIt) {
  const test::TempDir folder;
  const auto target = folder.write("real", "old");
  std::filesystem::create_symlink(target, folder.path() / "link");
  OutputFile file(folder.path() / "link");
  write(file, "new");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "link"));
  EXPECT_EQ(file_content(target), "new");
}

TEST(OutputFile, AFolderThatDoesNotExistIsNamed) {
  const test::TempDir folder;
  const std::filesystem::path file = folder.path() / "missing" / "out";
  const auto error = error_of([&] { OutputFile output(file); });
  ASSERT_TRUE(error);
  EXPECT_EQ(test::error_of([&] { require_writable(file); }).value().what(),
            std::string(error->what()));
  EXPECT_EQ(error->code(), ErrorCode::kFileUnwritable);
  EXPECT_NE(std::string(error->what()).find("missing/out"), std::string::npos) << error->what();
  EXPECT_EQ(folder.entries(), 0u);
}

TEST(OutputFile, AFolderInTheFilesPlaceIsRefused) {
  const test::TempDir folder;
  const auto error = error_of([&] {
    OutputFile file(folder.path());
    file.commit();
  });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kFileUnwritable);
}

TEST(OutputFile, IsCheckedBeforeLongWorkAndNotCreated) {
  const test::TempDir folder;
  const auto refused = [](const std::filesystem::path& file) {
    return test::error_of([&] { require_writable(file); });
  };
  EXPECT_FALSE(refused(folder.path() / "new"));
  EXPECT_FALSE(refused("new"));
  EXPECT_FALSE(refused("/dev/null"));
  EXPECT_EQ(folder.entries(), 0u);
  const auto file = folder.write("old", "old");
  EXPECT_FALSE(refused(file));
  EXPECT_EQ(file_content(file), "old");
  const auto folder_there = refused(folder.path()), file_as_folder = refused(file / "new");
  ASSERT_TRUE(folder_there && file_as_folder);
  EXPECT_EQ(folder_there->code(), ErrorCode::kFileUnwritable);
  EXPECT_NE(std::string(folder_there->what()).find("Is a directory"), std::string::npos);
  EXPECT_NE(std::string(file_as_folder->what()).find("Not a directory"), std::string::npos);
  std::filesystem::create_directory(folder.path() / "read");
  std::filesystem::permissions(folder.path() / "read", std::filesystem::perms::owner_read);
  const bool may_write = ::access((folder.path() / "read").c_str(), W_OK) == 0;  // as root
  EXPECT_EQ(refused(folder.path() / "read" / "new").has_value(), !may_write);
}

TEST(OutputFile, AFullDiskIsReported) {
  if (!std::filesystem::exists("/dev/full")) IST_SKIP("there is no /dev/full");
  const auto error = error_of([] {
    OutputFile file("/dev/full");
    write(file, "text");
    file.commit();
  });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kFileUnwritable);
  EXPECT_NE(std::string(error->what()).find("/dev/full"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

// A pipe without a reader is told from a disk that is full.
TEST(OutputFile, TellsTheSystemsCause) {
  if (!std::filesystem::exists("/dev/full")) IST_SKIP("there is no /dev/full");
  OutputFile file("/dev/full");
  try {
    write(file, "text");
    FAIL() << "it was written";
  } catch (const UnwritableFile& error) {
    EXPECT_EQ(error.cause(), ENOSPC);
  }
}

TEST(OutputFile, SeveralAreCommittedTogether) {
  const test::TempDir folder;
  const auto target = folder.write("b", "old");
  OutputFile a(folder.path() / "a"), b(target), direct("/dev/null");
  for (OutputFile* file : {&a, &b, &direct}) write(*file, "new");
  OutputFile* const files[] = {&a, &b, &direct};
  OutputFile::commit_all(files);
  EXPECT_EQ(file_content(folder.path() / "a"), "new");
  EXPECT_EQ(file_content(target), "new");
  EXPECT_EQ(folder.entries(), 2u);
}

// A folder that was made meanwhile takes the second name.
TEST(OutputFile, NoNewNameStaysWhereAnotherCannotBeGiven) {
  const test::TempDir folder;
  const auto older = folder.write("older", "old");
  {
    OutputFile first(folder.path() / "first"), replaced(older), second(folder.path() / "second");
    for (OutputFile* file : {&first, &replaced, &second}) write(*file, "new");
    std::filesystem::create_directory(folder.path() / "second");
    const auto error = error_of([&] {
      OutputFile* const files[] = {&first, &replaced, &second};
      OutputFile::commit_all(files);
    });
    ASSERT_TRUE(error);
    EXPECT_NE(std::string(error->what()).find("second: cannot rename"), std::string::npos);
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "first"));
  EXPECT_EQ(file_content(older), "new");
  EXPECT_EQ(folder.entries(), 2u) << "the older file and the folder";
}

// As a process does that ends by a signal.
TEST(OutputFile, IsNotThereWhereItIsAbandoned) {
  const test::TempDir folder;
  const auto target = folder.write("out", "old"), done = folder.path() / "done";
  const auto abandon = [&] {
    OutputFile committed(done), first(target), second(target), third(folder.path() / "third");
    write(committed, "whole");
    write(first, "half");
    committed.commit();
    abandon_output_files();
    ::_exit(7);
  };
  EXPECT_EXIT(abandon(), ::testing::ExitedWithCode(7), "");
  EXPECT_EQ(file_content(target), "old");
  EXPECT_EQ(file_content(done), "whole");
  EXPECT_EQ(folder.entries(), 2u);
}

// Nothing waits for the disk here: a command under a held fsync() shows that (RunLaterSignal).
TEST(OutputFile, IsNotThereWhereItIsNotWrittenWhole) {
  const test::TempDir folder;
  const auto target = folder.write("out", "old"), done = folder.path() / "done";
  const auto complete = [&] {
    OutputFile committed(done), half(target);
    write(committed, "whole");
    write(half, "half");
    committed.commit();
    complete_output_files();
    ::_exit(7);
  };
  EXPECT_EXIT(complete(), ::testing::ExitedWithCode(7), "");
  EXPECT_EQ(file_content(target), "old");
  EXPECT_EQ(file_content(done), "whole");
  EXPECT_EQ(folder.entries(), 2u);
}

// What another process left behind is not taken for one's own.
TEST(OutputFile, LeavesAForeignTemporaryFileAlone) {
  const test::TempDir folder;
  const std::string foreign = "out." + std::to_string(::getpid()) + "-0.tmp";
  folder.write(foreign, "foreign");
  {
    OutputFile file(folder.path() / "out");
    write(file, "mine");
    file.commit();
    OutputFile given_up(folder.path() / "out");
  }
  EXPECT_EQ(file_content(folder.path() / foreign), "foreign");
  EXPECT_EQ(file_content(folder.path() / "out"), "mine");
  EXPECT_EQ(folder.entries(), 2u);
}

}  // namespace
}  // namespace ist
