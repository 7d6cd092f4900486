#include "ist/hardware/vector_file.h"

#include <fmt/format.h>

#include "ist/hardware/vector_text.h"
#include "ist/hardware/xxh64.h"

namespace ist {
namespace {

// "fixed_x/20s": a name, bits, and whether there is a sign.
std::string names_of(int first, int end) {
  std::string names = "#";
  for (int i = first; i < end; ++i) {
    const VectorField& field = vector_fields()[static_cast<std::size_t>(i)];
    names += fmt::format(" {}/{}{}", field.name, field.bits, field.is_signed ? "s" : "u");
  }
  return names + "\n";
}

template <typename Use>
void for_each_piece(std::uint64_t count, std::uint64_t seed, const Use& use) {
  constexpr std::size_t kPiece = 1 << 16;
  GoldenVectors vectors(seed);
  std::string text;
  for (std::uint64_t i = 0; i < count; ++i) {
    append_line(vectors.next(), text);
    if (text.size() < kPiece && i + 1 < count) continue;
    use(text);
    text.clear();
  }
}

}  // namespace

std::uint64_t write_vectors(std::uint64_t count, std::uint64_t seed, std::string_view generator,
                            const std::function<void(std::string_view)>& write) {
  Xxh64 checksum;
  for_each_piece(count, seed,
                 [&](const std::string& text) { checksum.add(text.data(), text.size()); });
  write(
      fmt::format("# golden vectors of the sphere pair test with the lookup table; {}\n"
                  "# seed {}\n# count {}\n{}{}{}"
                  "# name/bits, s for signed: hexadecimal, two's complement, all digits\n"
                  "# checksum xxh64 {:016x}\n",
                  generator, seed, count, names_of(0, 10), names_of(10, 19),
                  names_of(19, kVectorFields), checksum.value()));
  for_each_piece(count, seed, write);
  return checksum.value();
}

}  // namespace ist
