#include "cli/poses/pose_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "answers/json_file.h"
#include "answers/refusals.h"
#include "ist/base/angles.h"
#include "ist/base/files.h"
#include "ist/base/pose.h"
#include "ist/base/throw_error.h"

namespace ist::cli {

using namespace answers;

namespace {

constexpr std::string_view kItk = "#Insight Transform File";
constexpr const char* kReadTypes =
    "AffineTransform, MatrixOffsetTransformBase, Rigid3DTransform, VersorRigid3DTransform, "
    "Euler3DTransform and TranslationTransform are read";

[[noreturn]] void refuse(ErrorCode code, const std::filesystem::path& file,
                         const std::string& what) {
  throw_error(code, "{}: {}", file.string(), what);
}

// The text after `key` on its line, or nothing if no line begins with it. Two such lines are a list
// of transforms, and none of them can be chosen.
struct Value {
  std::optional<std::string> text;
  int count = 0;
};
Value value_of(const std::string& content, std::string_view key) {
  Value value;
  for (std::size_t at = 0; at < content.size();) {
    const std::size_t end = std::min(content.find('\n', at), content.size());
    const std::string_view line = std::string_view(content).substr(at, end - at);
    if (line.starts_with(key)) {
      value.text = line.substr(key.size());
      ++value.count;
    }
    at = end + 1;
  }
  return value;
}

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  return begin == std::string::npos
             ? ""
             : text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

Eigen::Matrix3d turn_about(int axis, double angle) {
  const auto [sine, cosine] = sine_cosine(angle);
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn(u, u) = turn(v, v) = cosine;
  turn(u, v) = -sine;
  turn(v, u) = sine;
  return turn;
}

// A unit quaternion's vector part.
Eigen::Matrix3d of_versor(double x, double y, double z) {
  const double w = std::sqrt(std::max(0.0, 1 - (x * x + y * y + z * z)));
  return Eigen::Quaterniond(w, x, y, z).toRotationMatrix();
}

// y = matrix (x - centre) + shift + centre, as all of ITK's matrix transforms have it.
struct ItkTransform {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
};

// Returns nothing for an unknown type, or for a wrong number of parameters.
std::optional<ItkTransform> transform_of(std::string_view type, const std::vector<double>& p,
                                         const std::vector<double>& fixed) {
  const auto shift = [&](std::size_t first) {
    return Eigen::Vector3d(p[first], p[first + 1], p[first + 2]);
  };
  ItkTransform made;
  if (type == "TranslationTransform" && p.size() == 3) {
    made.shift = shift(0);
  } else if ((type == "AffineTransform" || type == "MatrixOffsetTransformBase" ||
              type == "Rigid3DTransform") &&
             p.size() == 12) {
    made.matrix = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(p.data());
    made.shift = shift(9);
  } else if (type == "VersorRigid3DTransform" && p.size() == 6) {
    made.matrix = of_versor(p[0], p[1], p[2]);
    made.shift = shift(3);
  } else if (type == "Euler3DTransform" && p.size() == 6) {
    // A fourth fixed parameter says that z is turned last: R = Rz Ry Rx instead of Rz Rx Ry.
    const bool zyx = fixed.size() == 4 && fixed[3] != 0;
    const Eigen::Matrix3d x = turn_about(0, p[0]), y = turn_about(1, p[1]), z = turn_about(2, p[2]);
    made.matrix = zyx ? Eigen::Matrix3d(z * y * x) : Eigen::Matrix3d(z * x * y);
    made.shift = shift(3);
  } else {
    return std::nullopt;
  }
  return made;
}

Eigen::Isometry3d require_rigid(const std::filesystem::path& file, const Eigen::Isometry3d& pose) {
  const auto rigid = project_to_rigid(pose);
  if (!rigid) {
    refuse(
        ErrorCode::kPoseInvalid, file,
        fmt::format("not a rigid motion: {} (the 16 numbers are row by row)", why_not_rigid(pose)));
  }
  return *rigid;
}

GivenPose read_itk(const std::filesystem::path& file, const std::string& content) {
  const Value type = value_of(content, "Transform:"), parameters = value_of(content, "Parameters:"),
              fixed = value_of(content, "FixedParameters:");
  if (type.count > 1) {
    refuse(ErrorCode::kInputInvalid, file, "it holds several transforms: write them as one");
  }
  const auto numbers = numbers_of(parameters.text.value_or("none"));
  const auto centre = numbers_of(fixed.text.value_or(""));
  if (!type.text || !numbers || !centre) {
    refuse(
        ErrorCode::kInputInvalid, file,
        "a transform of ITK needs the lines \"Transform:\" and \"Parameters:\" of finite numbers");
  }
  const std::string name = trimmed(*type.text), kind = name.substr(0, name.find('_'));
  const auto made = transform_of(kind, *numbers, *centre);
  if (!made || !name.ends_with("_3_3") ||
      (centre->size() > 4 || (!centre->empty() && centre->size() < 3))) {
    refuse(ErrorCode::kInputInvalid, file,
           fmt::format(
               "{} of {} parameters and {} fixed ones is no rigid transform that can be read: {}",
               name.empty() ? "a transform without a name" : name, numbers->size(), centre->size(),
               kReadTypes));
  }
  Eigen::Vector3d c(0, 0, 0);
  if (centre->size() >= 3) c = Eigen::Vector3d((*centre)[0], (*centre)[1], (*centre)[2]);
  Eigen::Isometry3d to_moving = Eigen::Isometry3d::Identity();
  to_moving.linear() = made->matrix;
  to_moving.translation() = made->shift + c - made->matrix * c;
  return {require_rigid(file, to_moving).inverse(), rotation_error(to_moving)};
}

constexpr const char* kRemedy =
    "give an array of objects with \"pose\", 16 numbers, column by column";

}  // namespace

GivenPose read_matrix(const std::filesystem::path& file) {
  const std::string content = InputFile(file).read_rest();
  if (content.starts_with(kItk)) return read_itk(file, content);
  const auto numbers = numbers_of(content);
  if (!numbers || numbers->size() != 16) {
    refuse(ErrorCode::kInputInvalid, file,
           fmt::format("give 4 lines of 4 finite numbers, or a transform of ITK as text{}",
                       numbers ? fmt::format("; these are {} numbers", numbers->size()) : ""));
  }
  Eigen::Isometry3d pose;
  pose.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers->data());
  return {require_rigid(file, pose), rotation_error(pose)};
}

std::vector<Eigen::Isometry3d> read_poses(const std::filesystem::path& file) {
  const nlohmann::ordered_json list = read_json(file, kRemedy);
  if (!list.is_array() || list.empty()) {
    refuse(ErrorCode::kInputInvalid, file, kRemedy);
  }
  std::vector<Eigen::Isometry3d> poses;
  for (const nlohmann::ordered_json& item : list) {
    const auto place = fmt::format("item {}", poses.size());
    const auto pose = item.is_object() ? item.find("pose") : item.end();
    const bool is_matrix =
        pose != item.end() && pose->is_array() && pose->size() == 16 &&
        std::all_of(pose->begin(), pose->end(),
                    [](const nlohmann::ordered_json& x) { return x.is_number(); });
    if (!is_matrix) {
      refuse(ErrorCode::kInputInvalid, file,
             place + ": give \"pose\" as an array of 16 numbers, column by column");
    }
    Eigen::Isometry3d& matrix = poses.emplace_back();
    for (Eigen::Index i = 0; i < 16; ++i) {
      matrix.matrix().data()[i] = (*pose)[static_cast<std::size_t>(i)].get<double>();
    }
    if (!project_to_rigid(matrix)) {
      refuse(ErrorCode::kPoseInvalid, file,
             fmt::format("{}: not a rigid motion: {} (the 16 numbers are column by column)", place,
                         why_not_rigid(matrix)));
    }
  }
  return poses;
}

}  // namespace ist::cli
