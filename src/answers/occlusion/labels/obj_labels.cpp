#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string_view>

#include "answers/occlusion/labels/label_files.h"
#include "ist/base/printable.h"
#include "ist/base/throw_error.h"
#include "ist/mesh/format/mesh_readers.h"
#include "ist/mesh/format/text_reader.h"

namespace ist::answers {
namespace {

struct Prefix {
  std::string_view word;
  std::optional<ToothNumbers> system;  // that it names
};
constexpr std::array<Prefix, 4> kPrefixes = {{{"tooth", {}},
                                              {"universal", ToothNumbers::kUniversal},
                                              {"fdi", ToothNumbers::kFdi},
                                              {"t", {}}}};

// What names the labels of faces: groups or objects.
struct Naming {
  std::string_view statement, noun;
};

// Reads the names of an OBJ that has been checked.
class NameReader {
 public:
  NameReader(std::string_view content, const std::string& file, ToothNumbers numbers)
      : content_(content), file_(file), numbers_(numbers) {}

  // Returns the labels of the triangles: 0 for a triangle without the number of a tooth.
  [[nodiscard]] ToothLabels labels_by(const Naming& naming) const {
    TextReader reader(content_, file_, TextReader::LineEnd::kObj);
    ToothLabels labels;
    int tooth = 0;
    while (reader.next_line()) {
      const std::string_view statement = reader.word_before_comment();
      if (statement == naming.statement) {
        tooth = tooth_of_line(reader, naming);
      } else if (statement == "f") {
        std::size_t corners = 0;
        while (!reader.word_before_comment().empty()) ++corners;
        labels.insert(labels.end(), corners - 2, tooth);
      }
    }
    return labels;
  }

 private:
  // The tooth that the rest of a line names, else 0.
  [[nodiscard]] int tooth_of_line(TextReader& reader, const Naming& naming) const {
    const std::string place = fmt::format("{}: line {}", file_, reader.line_number());
    int tooth = 0;
    for (std::string_view name = reader.word_before_comment(); !name.empty();
         name = reader.word_before_comment()) {
      const int named = tooth_of_name(name, place, naming.noun);
      if (named != 0 && tooth != 0 && named != tooth) {
        throw_error(ErrorCode::kInputInvalid, "{} names tooth {} and tooth {}", place, tooth,
                    named);
      }
      if (named != 0) tooth = named;
    }
    return tooth;
  }

  // A number counts alone or after a known prefix, because programs number their objects: Mesh_16.
  [[nodiscard]] int tooth_of_name(std::string_view name, const std::string& place,
                                  std::string_view noun) const {
    std::string_view digits = name;
    std::optional<ToothNumbers> system;
    for (const Prefix& prefix : kPrefixes) {
      if (!same_word(name.substr(0, prefix.word.size()), prefix.word)) continue;
      digits.remove_prefix(prefix.word.size());
      if (digits.starts_with('_') || digits.starts_with('-')) digits.remove_prefix(1);
      system = prefix.system;
      break;
    }
    if (digits.empty() || digits[0] < '0' || digits[0] > '9') return 0;
    int number = 0;
    const char* const end = digits.data() + digits.size();
    const auto [rest, error] = std::from_chars(digits.data(), end, number);
    const bool other_system = system && system != numbers_;
    if (error != std::errc() || rest != end || other_system) {
      throw_error(
          ErrorCode::kInputInvalid,
          "{} names the {} \"{}\", which is {}: name a tooth by its number "
          "alone, such as 16 or tooth_16, and what is no tooth by a word",
          place, noun, printable(name),
          other_system ? "a number of another system than --numbering" : "no tooth's number");
    }
    if (!is_tooth_number(number, numbers_)) refuse_tooth_number(number, numbers_, place);
    return number;
  }

  std::string_view content_;
  const std::string& file_;
  ToothNumbers numbers_;
};

}  // namespace

ToothLabels labels_of_obj(const std::filesystem::path& file, ToothNumbers numbers) {
  const std::string content = text_of(file), name = file.string();
  (void)read_obj(content, name);
  for (const Naming& naming : {Naming{"g", "group"}, {"o", "object"}}) {
    ToothLabels labels = NameReader(content, name, numbers).labels_by(naming);
    if (std::any_of(labels.begin(), labels.end(), [](int label) { return label != 0; }))
      return labels;
  }
  refuse_labels(file, "no group or object is named by a tooth's number, such as 16 or tooth_16");
}

}  // namespace ist::answers
