#include "cli/poses/pose_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "ist/base/error.h"
#include "ist/base/files.h"
#include "ist/base/pose.h"

namespace ist::cli {
namespace {

[[noreturn]] void fail(ErrorCode code, const std::filesystem::path& file, const std::string& what) {
  throw Error(code, fmt::format("{}: {}", file.string(), what));
}

constexpr const char* kRemedy =
    "give an array of objects with \"pose\", 16 numbers, column by column";

// Discards all values; finds the place where a text stops being JSON.
struct Locator : nlohmann::json_sax<nlohmann::json> {
  std::string error;

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(std::int64_t) override { return true; }
  bool number_unsigned(std::uint64_t) override { return true; }
  bool number_float(double, const std::string&) override { return true; }
  bool string(std::string&) override { return true; }
  bool binary(nlohmann::json::binary_t&) override { return true; }
  bool start_object(std::size_t) override { return true; }
  bool key(std::string&) override { return true; }
  bool end_object() override { return true; }
  bool start_array(std::size_t) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(std::size_t byte, const std::string&,
                   const nlohmann::json::exception& e) override {
    error = e.what();
    const std::size_t name = error.find("] ");  // the parser's own name of the error ends there
    if (name != std::string::npos) error.erase(0, name + 2);
    constexpr int kOverflow = 406;  // the one error that names no line
    if (e.id == kOverflow) error += fmt::format(" at byte {}", byte);
    return false;
  }
};

nlohmann::json parse(const std::filesystem::path& file) {
  const std::string text = InputFile(file).read_rest();
  Locator locator;
  if (!nlohmann::json::sax_parse(text, &locator)) {
    fail(ErrorCode::kInputInvalid, file, fmt::format("not JSON: {}; {}", locator.error, kRemedy));
  }
  return nlohmann::json::parse(text);
}

}  // namespace

std::vector<Eigen::Isometry3d> read_poses(const std::filesystem::path& file) {
  const nlohmann::json list = parse(file);
  if (!list.is_array() || list.empty()) {
    fail(ErrorCode::kInputInvalid, file, kRemedy);
  }
  std::vector<Eigen::Isometry3d> poses;
  for (const nlohmann::json& item : list) {
    const auto place = fmt::format("item {}", poses.size());
    const auto pose = item.is_object() ? item.find("pose") : item.end();
    const bool is_matrix = pose != item.end() && pose->is_array() && pose->size() == 16 &&
                           std::all_of(pose->begin(), pose->end(),
                                       [](const nlohmann::json& x) { return x.is_number(); });
    if (!is_matrix) {
      fail(ErrorCode::kInputInvalid, file,
           place + ": give \"pose\" as an array of 16 numbers, column by column");
    }
    Eigen::Isometry3d& matrix = poses.emplace_back();
    for (Eigen::Index i = 0; i < 16; ++i) {
      matrix.matrix().data()[i] = (*pose)[static_cast<std::size_t>(i)].get<double>();
    }
    if (!project_to_rigid(matrix)) {
      fail(ErrorCode::kPoseInvalid, file,
           fmt::format("{}: not a rigid motion: {} (the 16 numbers are column by column)", place,
                       why_not_rigid(matrix)));
    }
  }
  return poses;
}

}  // namespace ist::cli
