#include "ist/tree/mesh_source.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "ist/base/error.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace ist {
namespace {

TEST(LengthUnits, HaveNamesAndLengths) {
  const std::pair<LengthUnit, std::pair<const char*, double>> all[] = {
      {LengthUnit::kMillimetre, {"mm", 0.001}},
      {LengthUnit::kMetre, {"m", 1}},
      {LengthUnit::kInch, {"inch", 0.0254}},
      {LengthUnit::kMicrometre, {"µm", 1e-6}}};
  EXPECT_EQ(std::size(all), kLengthUnits.size());
  for (const auto& [unit, known] : all) {
    EXPECT_EQ(to_string(unit), known.first);
    EXPECT_EQ(length_unit(known.first), unit);
    EXPECT_EQ(metres_per_unit(unit), known.second);
  }
  EXPECT_EQ(length_unit("um"), LengthUnit::kMicrometre);
  EXPECT_EQ(to_string(LengthUnit::kUnknown), "unknown");
  EXPECT_EQ(metres_per_unit(LengthUnit::kUnknown), 0);
  EXPECT_EQ(to_string(static_cast<LengthUnit>(5)), "");
  EXPECT_EQ(metres_per_unit(static_cast<LengthUnit>(5)), 0);
  for (const char* none : {"", "unknown", "MM", "mm ", "in", "cm", "micrometre"}) {
    EXPECT_EQ(length_unit(none), std::nullopt) << none;
  }
}

TEST(MeshSources, KeepAnAllowedNameAsItIs) {
  for (const std::string& name :
       {std::string(), std::string("upper.stl"), std::string(".."), std::string("a b?.stl"),
        std::string("Zähne 歯 🦷.stl"), std::string("\xC2\xA0\xDF\xBF\xE0\xA0\x80"),
        std::string("\xED\x9F\xBF\xEE\x80\x80\xF4\x8F\xBF\xBF"), std::string(255, 'x')}) {
    EXPECT_EQ(source_name(name), name);
    EXPECT_EQ(source_flaw({name}), nullptr) << name;
  }
}

TEST(MeshSources, MarkEachByteThatIsNotAllowed) {
  const std::pair<std::string, std::string> all[] = {
      {"a/b\\c", "a?b?c"},
      {std::string("a\0b", 3), "a?b"},
      {"a\nb\x1F\x7F", "a?b??"},
      {"\xC2\x85", "??"},  // a control character of Latin-1
      {"\x80"
       "a\xFF",
       "?a?"},        // no first byte of a character
      {"\xC3", "?"},  // cut off
      {"\xE6\xAD"
       "a",
       "??a"},             // cut off by another
      {"\xC0\xAF", "??"},  // a slash, longer than it is written
      {"\xE0\x80\xAF", "???"},
      {"\xF0\x80\x80\xAF", "????"},
      {"\xED\xA0\x80", "???"},       // half of a pair of UTF-16
      {"\xF4\x90\x80\x80", "????"},  // beyond Unicode
      {"\xF8\x88\x80\x80\x80", "?????"}};
  for (const auto& [text, name] : all) {
    EXPECT_EQ(source_name(text), name);
    EXPECT_NE(source_flaw({text}), nullptr) << name;
  }
}

TEST(MeshSources, CutALongNameBetweenCharacters) {
  EXPECT_EQ(source_name(std::string(300, 'x')), std::string(255, 'x'));
  EXPECT_EQ(source_name(std::string(254, 'x') + "ä"), std::string(254, 'x'));
  EXPECT_STREQ(source_flaw({std::string(256, 'x')}), "the mesh's name is longer than 255 bytes");
}

TEST(MeshSources, ThatAreNotAllowedBuildNoTree) {
  BuildOptions options;
  options.voxel_size = 1;
  for (const MeshSource& source : {MeshSource{"jaws/upper.stl"}, MeshSource{std::string(256, 'x')},
                                   MeshSource{"", 0, static_cast<LengthUnit>(5)}}) {
    options.source = source;
    const auto error = test::error_of([&] { (void)build_tree(test::icosphere(1, 1), options); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ErrorCode::kArgumentInvalid);
    EXPECT_NE(std::string(error->what()).find(source_flaw(source)), std::string::npos);
    EXPECT_NE(std::string(error->what()).find("give a file's name"), std::string::npos);
  }
}

TEST(MeshSources, AreUnknownUnlessTold) {
  const SphereTree tree = build_tree(test::icosphere(1, 1), {.voxel_size = 1});
  EXPECT_EQ(tree.source(), MeshSource{});
}

}  // namespace
}  // namespace ist
