#include <fmt/format.h>

#include <charconv>
#include <string>

#include "hardware/vector_file.h"
#include "hardware/xxh64.h"
#include "ist/base/files.h"
#include "ist/base/throw_error.h"

namespace ist {
namespace {

constexpr std::uint64_t kHeaderLines = 8, kCountLine = 3;

[[noreturn]] void bad_file(const std::string& place, const std::string& what) {
  throw_error(ErrorCode::kInputInvalid, "{}: {}", place, what);
}

// Reads a file line by line, in memory that does not depend on its size.
class Lines {
 public:
  explicit Lines(const std::filesystem::path& file) : file_(file) {}

  /// Returns the next line with its line end, if it has one; an empty text after the last line.
  std::string_view next() {
    std::size_t end = text_.find('\n', begin_);
    while (end == std::string::npos && text_.size() - begin_ < kLongest) {
      text_.erase(0, begin_);
      begin_ = 0;
      const std::size_t before = text_.size();
      text_.resize(before + kPiece);
      text_.resize(before + file_.read(text_.data() + before, kPiece));
      if (text_.size() == before) break;
      end = text_.find('\n', before);
    }
    ++number_;
    const std::size_t begin = begin_;
    begin_ = end == std::string::npos ? text_.size() : end + 1;
    if (begin_ - begin > kLongest)
      bad_file(place(),
               "over 1000 characters, which is no line of a vector file: make one with 'ist table "
               "--vectors 1000'");
    return std::string_view(text_).substr(begin, begin_ - begin);
  }

  [[nodiscard]] std::uint64_t number() const { return number_; }
  [[nodiscard]] std::string place() const {
    return fmt::format("{}, line {}", file_.path().string(), number_);
  }

 private:
  static constexpr std::size_t kPiece = 1 << 16, kLongest = 1000;
  InputFile file_;
  std::string text_;
  std::size_t begin_ = 0;  // of the text not yet returned
  std::uint64_t number_ = 0;
};

std::string_view without_end(std::string_view line) {
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.remove_suffix(1);
  return line;
}

// Returns the number after the first words of a header line.
std::uint64_t header_number(const Lines& lines, std::string_view line, std::string_view words,
                            int base) {
  std::uint64_t value = 0;
  line = without_end(line);
  if (line.substr(0, words.size()) == words) {
    const char* end = line.data() + line.size();
    const auto [stop, error] = std::from_chars(line.data() + words.size(), end, value, base);
    if (error == std::errc() && stop == end) return value;
  }
  bad_file(lines.place(),
           fmt::format("expected '{}' and a number: make a file with 'ist table --vectors 1000'",
                       words));
}

struct Header {
  std::uint64_t count = 0, checksum = 0;
};

Header read_header(Lines& lines) {
  Header header;
  for (std::uint64_t i = 1; i <= kHeaderLines; ++i) {
    const std::string_view line = lines.next();
    if (line.empty() || line.front() != '#') {
      bad_file(lines.place(),
               "a vector file begins with 8 lines that begin with #: make one with "
               "'ist table --vectors 1000'");
    }
    if (i == kCountLine) header.count = header_number(lines, line, "# count ", 10);
    if (i == kHeaderLines) header.checksum = header_number(lines, line, "# checksum xxh64 ", 16);
  }
  if (header.count == 0) bad_file(lines.place(), "a file of 0 vectors: there is nothing to check");
  return header;
}

void compare(const GoldenVector& vector, std::uint64_t line, std::size_t most, VectorCheck& check) {
  const PairAnswer answer = test_pair(vector.pair, vector.registers);
  ++check.vectors;
  check.hits += answer.hit ? 1 : 0;
  if (answer == vector.answer) return;
  ++check.wrong;
  const auto note = [&](const char* field, std::uint64_t is, std::uint64_t should_be) {
    if (is == should_be || check.differences.size() >= most) return;
    check.differences.push_back({line, field, is, should_be});
  };
  note("reach", vector.answer.reach, answer.reach);
  note("hit", vector.answer.hit ? 1 : 0, answer.hit ? 1 : 0);
}

}  // namespace

VectorCheck check_vectors(const std::filesystem::path& file, std::size_t most) {
  Lines lines(file);
  const Header header = read_header(lines);
  VectorCheck check;
  Xxh64 checksum;
  for (std::string_view line = lines.next(); !line.empty(); line = lines.next()) {
    const std::string_view numbers = without_end(line);
    compare(read_line(numbers, lines.place()), lines.number(), most, check);
    checksum.add(numbers.data(), numbers.size());
    checksum.add("\n", 1);  // whatever the file's line ends are
    if (check.vectors > header.count) break;
  }
  if (check.vectors != header.count) {
    bad_file(lines.place(),
             fmt::format("the header announces {} vectors, but the file {}: write it again",
                         header.count,
                         check.vectors > header.count ? "holds more" : "ends before them"));
  }
  check.checksum_holds = checksum.value() == header.checksum;
  // Wrong answers say more than a wrong checksum.
  if (!check.checksum_holds && check.wrong == 0) {
    bad_file(file.string(),
             fmt::format("the vectors do not match the checksum: write the file again, or, if you "
                         "changed them, give {:016x} as the checksum in line {}",
                         checksum.value(), kHeaderLines));
  }
  return check;
}

}  // namespace ist
