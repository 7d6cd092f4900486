// A sweep's folder: how its parts stand, and what is refused.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "support/errors.h"
#include "sweep/sweep_case.h"
#include "sweep/sweep_record.h"

namespace ist::test {
namespace {

using SweepFolders = SweepTest;

void append(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::app) << bytes;
}

void change_byte(const std::filesystem::path& file, std::size_t at) {
  std::string bytes = file_content(file);
  bytes[at] = static_cast<char>(bytes[at] ^ 1);
  std::ofstream(file, std::ios::binary) << bytes;
}

TEST_F(SweepFolders, OfAnotherSweepAreRefused) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  const Sweep other = sweep_with("seed = 7", "seed = 8");
  for (const auto access : {SweepFolder::Access::kRead, SweepFolder::Access::kWrite}) {
    const auto error =
        error_of([&] { SweepFolder(parts.path(), other.identity(), other.layout(), access); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ErrorCode::kInputInvalid);
    EXPECT_NE(std::string(error->what()).find("another sweep"), std::string::npos) << error->what();
  }
  EXPECT_EQ(error_name([&] { static_cast<void>(folder(job)); }), "none");
}

TEST_F(SweepFolders, OfAnotherVersionAreRefused) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  std::string record = file_content(parts.path() / "sweep.json");
  const std::size_t at = record.find("\"version\": \"") + 12;
  record.replace(at, record.find('"', at) - at, "0.0.9");
  std::ofstream(parts.path() / "sweep.json") << record;
  const auto error = error_of([&] { static_cast<void>(folder(job)); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kInputInvalid);
  EXPECT_NE(std::string(error->what()).find("version 0.0.9"), std::string::npos) << error->what();
}

// The first layout had no poses in its rows, and its sweep.json did not name the layout.
TEST_F(SweepFolders, OfAnotherLayoutAreRefused) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  const std::string sound = file_content(parts.path() / "sweep.json"), now = " \"layout\": 2,\n";
  ASSERT_NE(sound.find(now), std::string::npos);
  const auto refusal = [&](const std::string& line) {
    std::string record = sound;
    record.replace(record.find(now), now.size(), line);
    std::ofstream(parts.path() / "sweep.json") << record;
    const auto error = error_of([&] { static_cast<void>(folder(job)); });
    EXPECT_TRUE(error && error->code() == ErrorCode::kInputInvalid);
    return std::string(error ? error->what() : "");
  };
  EXPECT_NE(refusal("").find("sweep.json: an older version of ist began this folder, and its rows "
                             "have other columns (layout 1, and this is 2): "),
            std::string::npos);
  EXPECT_NE(refusal(" \"layout\": 3,\n").find("a newer version of ist"), std::string::npos);
  EXPECT_NE(refusal(" \"layout\": \"2\",\n").find("damaged"), std::string::npos);
}

TEST_F(SweepFolders, ThatCannotBeMadeAreBadInput) {
  const Sweep job = sweep();
  dir_.write("file", "");
  EXPECT_EQ(error_name([&] { static_cast<void>(folder(job, "file")); }), "input-invalid");
  EXPECT_EQ(error_name([&] { static_cast<void>(folder(job, "file/below")); }), "input-invalid");
  EXPECT_EQ(error_name([&] {
              SweepFolder(dir_.path() / "gone", job.identity(), job.layout(),
                          SweepFolder::Access::kRead);
            }),
            "file-unreadable");
  if (::geteuid() == 0) return;  // who may write everywhere
  std::filesystem::create_directory(dir_.path() / "shut");
  std::filesystem::permissions(dir_.path() / "shut", std::filesystem::perms::owner_read);
  EXPECT_EQ(error_name([&] { static_cast<void>(folder(job, "shut")); }), "input-invalid");
}

TEST_F(SweepFolders, SayHowPartsStand) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  EXPECT_EQ(parts.look(0).state, PartState::kMissing);
  EXPECT_TRUE(std::isnan(parts.look(0).seconds));
  run_all(job, parts);
  for (std::uint64_t part = 0; part < 3; ++part) {
    EXPECT_EQ(parts.look(part).state, PartState::kDone);
    EXPECT_EQ(parts.verify(part).state, PartState::kDone);
    EXPECT_GT(parts.look(part).seconds, 0);
    EXPECT_EQ(parts.look(part).checksum.size(), 32U);
    EXPECT_FALSE(parts.look(part).running);
  }
}

TEST_F(SweepFolders, APartThatIsShortOrLongIsDamaged) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  run_all(job, parts);
  std::filesystem::resize_file(parts.part_file(0), parts.bytes_of_part(0) - 1);
  append(parts.part_file(1), "x");
  for (const std::uint64_t part : {0U, 1U}) {
    EXPECT_EQ(parts.look(part).state, PartState::kDamaged);
    EXPECT_EQ(error_name([&] { job.run_part(parts, part, 1); }), "input-invalid");
  }
  EXPECT_EQ(parts.look(2).state, PartState::kDone);
}

TEST_F(SweepFolders, AChangedByteIsFoundByTheChecksum) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  run_all(job, parts);
  for (const std::uint64_t at : {std::uint64_t{9}, parts.bytes_of_part(1) - 1}) {
    change_byte(parts.part_file(1), at);
    EXPECT_EQ(parts.look(1).state, PartState::kDone);
    EXPECT_EQ(parts.verify(1).state, PartState::kDamaged) << at;
    change_byte(parts.part_file(1), at);
    EXPECT_EQ(parts.verify(1).state, PartState::kDone);
  }
}

TEST_F(SweepFolders, APartOfAnotherSweepIsRefused) {
  const Sweep job = sweep(), other = sweep_with("seed = 7", "seed = 8");
  const SweepFolder parts = folder(job), others = folder(other, "others");
  run_all(other, others);
  std::filesystem::copy(others.part_file(0), parts.part_file(0));
  const auto alone = error_of([&] { static_cast<void>(parts.look(0)); });
  ASSERT_TRUE(alone);
  EXPECT_EQ(alone->code(), ErrorCode::kInputInvalid);
  EXPECT_NE(std::string(alone->what()).find("has no record"), std::string::npos) << alone->what();
  std::filesystem::copy(others.record_file(0), parts.record_file(0));
  const auto error = error_of([&] { static_cast<void>(parts.look(0)); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kInputInvalid);
  EXPECT_NE(std::string(error->what()).find("another sweep"), std::string::npos) << error->what();
}

TEST_F(SweepFolders, APartUnderAnotherNumberIsRefused) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  run_all(job, parts);
  std::filesystem::rename(parts.part_file(1), parts.part_file(0));
  std::filesystem::rename(parts.record_file(1), parts.record_file(0));
  EXPECT_EQ(error_name([&] { static_cast<void>(parts.look(0)); }), "input-invalid");
}

TEST_F(SweepFolders, DamagedRecordsAreRefused) {
  const Sweep job = sweep();
  const SweepFolder parts = folder(job);
  run_all(job, parts);
  const std::string sound = file_content(parts.record_file(0));
  for (const std::string& bad :
       {std::string(), std::string("[]"), sound.substr(0, sound.size() / 2), std::string("{}"),
        std::string("{\"sweep\": 1}")}) {
    std::ofstream(parts.record_file(0)) << bad;
    const auto error = error_of([&] { static_cast<void>(parts.look(0)); });
    ASSERT_TRUE(error) << bad;
    EXPECT_EQ(error->code(), ErrorCode::kInputInvalid) << bad;
  }
  std::ofstream(parts.path() / "sweep.json") << "{";
  const auto error = error_of([&] { static_cast<void>(folder(job)); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kInputInvalid);
  EXPECT_TRUE(std::string(error->what()).ends_with("remove it; the next run writes it anew"));
  std::filesystem::remove(parts.path() / "sweep.json");
  EXPECT_EQ(folder(job).look(1).state, PartState::kDone);
}

}  // namespace
}  // namespace ist::test
