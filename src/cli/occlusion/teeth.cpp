#include "cli/occlusion/teeth.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>

#include "ist/base/error.h"
#include "ist/base/files.h"

namespace ist::cli {
namespace {

constexpr const char* kFdi =
    "FDI numbers are 11 to 18 up to 41 to 48, of milk teeth 51 to 55 up "
    "to 81 to 85; 0 is no tooth";
constexpr const char* kUniversal = "universal numbers are 1 to 32; 0 is no tooth";

bool is_number(int number, ToothNumbers numbers) {
  if (number == 0) return true;
  if (numbers == ToothNumbers::kUniversal) return number >= 1 && number <= 32;
  const int quarter = number / 10, tooth = number % 10;
  return quarter >= 1 && quarter <= 8 && tooth >= 1 && tooth <= (quarter <= 4 ? 8 : 5);
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& detail) {
  throw Error(ErrorCode::kInputInvalid, fmt::format("{}: {}", file.string(), detail));
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

// One number a line. Blank lines are well at the end alone.
std::vector<int> numbers_in(const std::filesystem::path& file, ToothNumbers system) {
  const std::string content = InputFile(file).read_rest();
  std::vector<int> numbers;
  std::size_t line = 0, blank = 0;  // counted from 1; the first blank one
  for (std::size_t at = 0; at < content.size();) {
    const std::size_t end = std::min(content.find('\n', at), content.size());
    const std::string_view text = trimmed(std::string_view(content).substr(at, end - at));
    at = end + 1;
    ++line;
    if (text.empty()) {
      if (blank == 0) blank = line;
      continue;
    }
    if (blank != 0) refuse(file, fmt::format("line {} is empty: write 0 for no tooth", blank));
    int number = 0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || rest != text.data() + text.size()) {
      refuse(file, fmt::format("line {} is \"{}\": write one whole number a line", line,
                               text.substr(0, 40)));
    }
    if (!is_number(number, system)) {
      refuse(file, fmt::format("line {} is {}: {}; see --numbering", line, number,
                               system == ToothNumbers::kFdi ? kFdi : kUniversal));
    }
    numbers.push_back(number);
  }
  return numbers;
}

// The tooth that two corners name. Labels that belong to other vertices are taken for noise: then
// most triangles would lie between teeth.
ToothLabels of_triangles(const std::filesystem::path& file, const TriangleMesh& mesh,
                         const std::vector<int>& of_vertices) {
  ToothLabels labels;
  labels.reserve(mesh.triangles.size());
  std::size_t between = 0;
  for (const Triangle& t : mesh.triangles) {
    const int a = of_vertices[t[0]], b = of_vertices[t[1]], c = of_vertices[t[2]];
    labels.push_back(a == b || a == c ? a : b == c ? b : 0);
    if (a != b || b != c) ++between;
  }
  if (2 * between > mesh.triangles.size()) {
    refuse(file,
           "most triangles have corners of different teeth, so that these seem to be the "
           "labels of other vertices, which are counted as the triangles first use them: "
           "give a label for each triangle");
  }
  return labels;
}

}  // namespace

ToothLabels read_labels(const std::filesystem::path& file, const TriangleMesh& mesh,
                        ToothNumbers numbers) {
  std::vector<int> labels = numbers_in(file, numbers);
  if (labels.size() == mesh.triangles.size()) return labels;
  if (labels.size() == mesh.vertices.size()) return of_triangles(file, mesh, labels);
  refuse(file, fmt::format("{} labels for a mesh of {} triangles and {} vertices: write one a line "
                           "for each triangle, or for each vertex",
                           labels.size(), mesh.triangles.size(), mesh.vertices.size()));
}

std::vector<Tooth> teeth_of(const SurfaceOcclusion& surface, const TriangleMesh& mesh,
                            const ToothLabels& labels) {
  std::map<int, Tooth> teeth;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] == 0) continue;
    const auto [place, is_new] = teeth.try_emplace(labels[i]);
    Tooth& tooth = place->second;
    if (is_new) {
      tooth.number = labels[i];
      tooth.least_distance = std::numeric_limits<double>::quiet_NaN();
    }
    for (const std::uint32_t v : mesh.triangles[i]) {
      // The number, where only one of them is.
      tooth.least_distance = std::fmin(tooth.least_distance, surface.vertices[v].distance);
    }
  }
  double all = 0, all_thinner = 0, all_thicker = 0;
  for (const ContactRegion& region : surface.regions) {
    for (const ContactTriangle& contact : region.triangles) {
      all += contact.pressed;
      all_thinner += contact.pressed_thinner;
      all_thicker += contact.pressed_thicker;
      const auto found = teeth.find(labels[contact.triangle]);
      if (found == teeth.end()) continue;
      Tooth& tooth = found->second;
      tooth.area += contact.area;
      tooth.share += contact.pressed;
      tooth.share_thinner += contact.pressed_thinner;
      tooth.share_thicker += contact.pressed_thicker;
    }
  }
  const auto part = [](double& sum, double of) { sum = of > 0 ? sum / of : 0; };
  std::vector<Tooth> list;
  for (auto& [number, tooth] : teeth) {
    part(tooth.share, all);
    part(tooth.share_thinner, all_thinner);
    part(tooth.share_thicker, all_thicker);
    list.push_back(tooth);
  }
  return list;
}

}  // namespace ist::cli
