#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "cli/occlusion/labels/label_files.h"
#include "ist/base/error.h"
#include "ist/base/files.h"
#include "ist/mesh/format/mesh_format.h"
#include "ist/mesh/format/obj_word.h"

namespace ist::cli {
namespace {

constexpr std::string_view kDigits = "0123456789";

// The number that a group's name ends in; 0 for a name without digits.
int tooth_of_name(std::string_view name, TextReader& reader, const std::string& place,
                  ToothNumbers numbers) {
  if (name.find_first_of(kDigits) == name.npos) return 0;
  const std::size_t begin = name.find_last_not_of(kDigits) + 1;  // 0 where all are digits
  const std::string_view before = name.substr(0, begin);
  const bool tells = before.empty() || before.ends_with('_');
  if (begin == name.size() || !tells || before.find_first_of(kDigits) != before.npos) {
    throw Error(ErrorCode::kInputInvalid,
                fmt::format("{} names the group \"{}\", which does not tell its tooth: name it by "
                            "its number alone, such as 16 or tooth_16, and what is no tooth "
                            "without digits",
                            place, name.substr(0, 40)));
  }
  const std::int64_t number = reader.integer(name.substr(begin));
  if (!is_tooth_number(number, numbers)) refuse_tooth_number(number, numbers, place);
  return static_cast<int>(number);
}

}  // namespace

ToothLabels labels_of_obj(const std::filesystem::path& file, ToothNumbers numbers) {
  const std::string content = InputFile(file).read_rest();
  const std::string name = file.string();
  (void)check_obj(content, name);
  TextReader reader(content, name, TextReader::LineEnd::kContinuedByBackslash);
  ToothLabels labels;
  int tooth = 0;
  while (reader.next_line()) {
    const std::string_view statement = obj_word(reader);
    if (statement == "g" || statement == "o") {
      const std::string place = fmt::format("{}: line {}", name, reader.line_number());
      tooth = 0;
      for (std::string_view word = obj_word(reader); !word.empty(); word = obj_word(reader)) {
        const int named = tooth_of_name(word, reader, place, numbers);
        if (named != 0 && tooth != 0 && named != tooth) {
          throw Error(ErrorCode::kInputInvalid,
                      fmt::format("{} names tooth {} and tooth {}", place, tooth, named));
        }
        if (named != 0) tooth = named;
      }
    } else if (statement == "f") {
      std::size_t corners = 0;
      while (!obj_word(reader).empty()) ++corners;
      labels.insert(labels.end(), corners - 2, tooth);
    }
  }
  if (std::ranges::all_of(labels, [](int label) { return label == 0; })) {
    refuse_labels(file, "no group is named by a tooth's number, such as 16 or tooth_16");
  }
  return labels;
}

}  // namespace ist::cli
