#include "answers/json_file.h"

#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>

#include "ist/base/files.h"
#include "ist/base/throw_error.h"

namespace ist::answers {
namespace {

// Discards all values, and finds the first place of a text that is not JSON.
struct Locator : nlohmann::json_sax<nlohmann::ordered_json> {
  std::string error;

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(std::int64_t) override { return true; }
  bool number_unsigned(std::uint64_t) override { return true; }
  bool number_float(double, const std::string&) override { return true; }
  bool string(std::string&) override { return true; }
  bool binary(nlohmann::ordered_json::binary_t&) override { return true; }
  bool start_object(std::size_t) override { return true; }
  bool key(std::string&) override { return true; }
  bool end_object() override { return true; }
  bool start_array(std::size_t) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(std::size_t byte, const std::string&,
                   const nlohmann::ordered_json::exception& e) override {
    error = e.what();
    const std::size_t name = error.find("] ");  // the parser's own name of the error ends there
    if (name != std::string::npos) error.erase(0, name + 2);
    constexpr int kOverflow = 406;  // the only error without a line
    if (e.id == kOverflow) error += fmt::format(" at byte {}", byte);
    return false;
  }
};

}  // namespace

nlohmann::ordered_json read_json(const std::filesystem::path& file, const std::string& remedy) {
  const std::string text = InputFile(file).read_rest();
  Locator locator;
  if (!nlohmann::ordered_json::sax_parse(text, &locator)) {
    throw_error(ErrorCode::kInputInvalid, "{}: not JSON: {}; {}", file.string(), locator.error,
                remedy);
  }
  return nlohmann::ordered_json::parse(text);
}

}  // namespace ist::answers
