// .npy files: written as numpy writes them, and read or refused with a remedy.

#include "sweep/npy_file.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/errors.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

TEST(NpyHeader, IsThatOfNumpysFormat) {
  RowLayout layout;
  layout.add("index", ColumnType::kUint64);
  layout.add("status", ColumnType::kInt32);
  layout.add("area", ColumnType::kFloat64);
  const std::string header = npy_header(layout, 12345);
  EXPECT_EQ(header.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  EXPECT_EQ(header.size() % 64, 0U);
  const std::size_t bytes =
      static_cast<unsigned char>(header[8]) + 256U * static_cast<unsigned char>(header[9]);
  EXPECT_EQ(bytes, header.size() - 10);
  EXPECT_EQ(header.back(), '\n');
  const std::string text =
      "{'descr': [('index', '<u8'), ('status', '<i4'), ('area', '<f8')], "
      "'fortran_order': False, 'shape': (12345,), }";
  EXPECT_EQ(header.substr(10, text.size()), text);
  EXPECT_EQ(header.find_first_not_of(' ', 10 + text.size()), header.size() - 1);
}

// The text of a header takes whole blocks of 64 bytes with what stands before it.
TEST(NpyHeader, IsAlignedForEveryLength) {
  for (std::size_t letters = 1; letters < 130; ++letters) {
    RowLayout layout;
    layout.add(std::string(letters, 'x'), ColumnType::kInt32);
    const std::string header = npy_header(layout, 1);
    EXPECT_EQ(header.size() % 64, 0U) << letters;
    EXPECT_EQ(header.back(), '\n') << letters;
  }
}

std::string npy(const std::string& dictionary, const std::string& numbers, int version = 1) {
  std::string text = dictionary + "\n", file = "\x93NUMPY";
  file += static_cast<char>(version);
  file += '\0';
  for (int byte = 0; byte < (version == 1 ? 2 : 4); ++byte) {
    file += static_cast<char>((text.size() >> (8 * byte)) & 0xFF);
  }
  return file + text + numbers;
}

std::string bytes_of(const std::vector<double>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double)};
}

const char* const kSound = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 4, 4), }";

std::vector<double> counting(std::size_t count) {
  std::vector<double> numbers(count);
  for (std::size_t i = 0; i < count; ++i) numbers[i] = static_cast<double>(i);
  return numbers;
}

class NpyPosesTest : public ::testing::Test {
 protected:
  [[nodiscard]] NpyPoses read(const std::string& bytes) const {
    return NpyPoses(folder_.write("poses.npy", bytes));
  }
  void expect_refused(const std::string& bytes, const std::string& said) const {
    const auto error =
        error_of([&] { static_cast<void>(NpyPoses(folder_.write("p.npy", bytes))); });
    ASSERT_TRUE(error) << "it is taken for sound: " << said;
    EXPECT_EQ(error->code(), ErrorCode::kInputInvalid);
    EXPECT_NE(std::string(error->what()).find(said), std::string::npos) << error->what();
    EXPECT_NE(std::string(error->what()).find("p.npy: "), std::string::npos) << error->what();
  }

  TempDir folder_;
};

TEST_F(NpyPosesTest, AreReadRowByRow) {
  for (const int version : {1, 2, 3}) {
    const NpyPoses poses(folder_.write("poses.npy", npy(kSound, bytes_of(counting(32)), version)));
    ASSERT_EQ(poses.count(), 2U);
    Eigen::Isometry3d second;
    poses.read(1, {&second, 1});
    EXPECT_EQ(second(0, 1), 17);
    EXPECT_EQ(second(1, 0), 20);
    EXPECT_EQ(second(3, 3), 31);
  }
}

TEST_F(NpyPosesTest, AreReadInBlocksToTheLast) {
  constexpr std::size_t kPoses = 3000;
  const NpyPoses poses(folder_.write(
      "poses.npy", npy("{'descr': '<f8', 'fortran_order': False, 'shape': (3000, 4, 4), }",
                       bytes_of(counting(16 * kPoses)))));
  std::vector<Eigen::Isometry3d> all(kPoses - 1);
  poses.read(1, all);
  for (std::size_t i = 0; i < all.size(); ++i) {
    ASSERT_EQ(all[i](0, 3), static_cast<double>(16 * (i + 1) + 3));
  }
}

TEST_F(NpyPosesTest, OtherFilesAreRefusedWithARemedy) {
  const std::string numbers = bytes_of(counting(32));
  expect_refused("", "no .npy file");
  expect_refused("solid box", "no .npy file");
  expect_refused(npy(kSound, numbers).substr(0, 11), "cut off");
  expect_refused(npy(kSound, numbers).substr(0, 40), "cut off");
  expect_refused(npy(kSound, numbers.substr(1)), "cut off or damaged");
  expect_refused(npy(kSound, numbers + "x"), "cut off or damaged");
  expect_refused(npy("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 4, 4), }", numbers),
                 "float64");
  expect_refused(npy("{'descr': '>f8', 'fortran_order': False, 'shape': (2, 4, 4), }", numbers),
                 "float64");
  expect_refused(npy("{'descr': '<f8', 'fortran_order': True, 'shape': (2, 4, 4), }", numbers),
                 "ascontiguousarray");
  expect_refused(npy("{'descr': '<f8', 'fortran_order': False, 'shape': (4, 8), }", numbers),
                 "(N, 4, 4)");
  expect_refused(npy("{'descr': '<f8', 'fortran_order': False, 'shape': (2, 8, 2), }", numbers),
                 "(N, 4, 4)");
  expect_refused(npy("{'descr': '<f8', 'fortran_order': False, }", numbers), "no shape");
  expect_refused(npy("{'descr': '<f8', 'fortran_order': False, 'shape': (2, x), }", numbers),
                 "no shape");
  // A product beyond 2^64 must not wrap round to the length of the file.
  expect_refused(npy("{'descr': '<f8', 'fortran_order': False, "
                     "'shape': (1152921504606846978, 4, 4), }",
                     numbers),
                 "cut off or damaged");
}

TEST_F(NpyPosesTest, NoPoseIsSound) {
  EXPECT_EQ(read(npy("{'descr': '<f8', 'fortran_order': False, 'shape': (0, 4, 4), }", "")).count(),
            0U);
}

TEST_F(NpyPosesTest, AFileThatIsWrittenMeanwhileIsNoticed) {
  const std::filesystem::path file =
      folder_.write("poses.npy", npy(kSound, bytes_of(counting(32))));
  const NpyPoses poses(file);
  EXPECT_EQ(error_name([&] { poses.require_unchanged(); }), "none");
  // In place, as an editor or numpy's memmap does.
  std::filesystem::last_write_time(
      file, std::filesystem::last_write_time(file) + std::chrono::milliseconds(1));
  EXPECT_EQ(error_name([&] { poses.require_unchanged(); }), "input-invalid");
}

TEST_F(NpyPosesTest, IdentityIsThatOfTheContent) {
  std::vector<double> numbers = counting(32);
  const std::string identity = read(npy(kSound, bytes_of(numbers))).identity();
  EXPECT_EQ(read(npy(kSound, bytes_of(numbers))).identity(), identity);
  numbers[31] = 32;
  EXPECT_NE(read(npy(kSound, bytes_of(numbers))).identity(), identity);
}

}  // namespace
}  // namespace ist::test
