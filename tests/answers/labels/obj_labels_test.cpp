#include <gtest/gtest.h>

#include <string>

#include "answers/labels/label_cases.h"

namespace ist::test {
namespace {

using answers::ToothLabels, answers::ToothNumbers;

// Of the square's corners in their order round it.
std::string obj(const std::string& groups) {
  return "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n" + groups;
}

ToothLabels of_obj(const std::string& groups, ToothNumbers numbers = ToothNumbers::kFdi) {
  return labels_by("jaw.obj", obj(groups), numbers);
}

TEST(LabelsOfObj, AreGroupsByTheirNumber) {
  EXPECT_EQ(of_obj("g 16\nf 1 2 4\ng gum\nf 4 2 3\n"), (ToothLabels{16, 0}));
  EXPECT_EQ(of_obj("f 1 2 4\ng upper tooth_16 smooth # 11\nf 4 2 \\\n 3\n"), (ToothLabels{0, 16}));
  EXPECT_EQ(of_obj("g T_5\nf 1/1/1 2/2/2 4//3\nf 4/1 2 3\n", ToothNumbers::kUniversal),
            (ToothLabels{5, 5}));
  EXPECT_EQ(of_obj("g 16\ng\nf 1 2 4\ng 0\ng FDI_15 15\nf 4 2 3\n"), (ToothLabels{0, 15}));
  EXPECT_EQ(labels_by("jaw.obj", "\xEF\xBB\xBFg 16\n" + obj("f 1 2 4\ng gum\nf 4 2 3\n")),
            (ToothLabels{16, 0}))
      << "after a byte order mark";
}

TEST(LabelsOfObj, AreNumbersAloneOrAfterAPrefix) {
  for (const char* name : {"16", "tooth16", "tooth_16", "Tooth-16", "T16", "t_16", "FDI-16",
                           "fdi16", "016", "T-016"}) {
    EXPECT_EQ(of_obj(std::string("g ") + name + "\nf 1 2 4\ng gum\nf 4 2 3\n"),
              (ToothLabels{16, 0}))
        << name;
  }
  EXPECT_EQ(of_obj("g Universal_3\nf 1 2 4\nf 4 2 3\n", ToothNumbers::kUniversal),
            (ToothLabels{3, 3}));
}

TEST(LabelsOfObj, OtherNamesAreOfNoTooth) {
  for (const char* name : {"Mesh_16", "upper_jaw_2", "UR6", "-16", "_16", "a.16", "Object.001",
                           "tooth_", "tooth__16", "toothbrush", "mat16"}) {
    EXPECT_EQ(of_obj(std::string("g ") + name + "\nf 1 2 4\ng 11\nf 4 2 3\n"), (ToothLabels{0, 11}))
        << name;
  }
}

TEST(LabelsOfObj, OfObjectsCountWhereNoGroupIsATooth) {
  EXPECT_EQ(of_obj("o 16\nf 1 2 4\no gum\nf 4 2 3\n"), (ToothLabels{16, 0}));
  EXPECT_EQ(of_obj("g gum\no tooth_16\nf 1 2 4\ng default\nf 4 2 3\n"), (ToothLabels{16, 16}));
  EXPECT_EQ(of_obj("g 16\no upper\nf 1 2 4\no 11\nf 4 2 3\n"), (ToothLabels{16, 16}))
      << "an object ends no group";
  EXPECT_EQ(of_obj("o 99\ng 16\nf 1 2 4\nf 4 2 3\n"), (ToothLabels{16, 16}))
      << "objects are not asked";
}

TEST(LabelsOfObj, ThatTellNothingAreRefused) {
  const auto said = [](const std::string& groups, const std::string& expected) {
    const std::string text = refusal_of("jaw.obj", obj(groups));
    EXPECT_NE(text.find(expected), text.npos) << text;
  };
  said("f 1 2 4\ng gum\nf 4 2 3\n", "no group or object is named by a tooth's number");
  said("o Mesh_16\nf 1 2 4\ng Mesh_15\nf 4 2 3\n", "no group or object is named by");
  for (const char* name : {"16.001", "16b", "1_6", "6_", "tooth_16_upper", "T16x", "16_Mesh.001",
                           "99999999999999999999", "tooth_4294967312"}) {
    said(std::string("g ") + name + "\nf 1 2 4\nf 4 2 3\n",
         std::string("line 5 names the group \"") + name + "\", which is no tooth's number");
  }
  said("o 16.001\nf 1 2 4\nf 4 2 3\n", "line 5 names the object \"16.001\"");
  said("f 1 2 4\ng 19\nf 4 2 3\n", "line 6 is 19: FDI");
  said("g 11 12\nf 1 2 4\nf 4 2 3\n", "line 5 names tooth 11 and tooth 12");
  said("g 11\nf 1 2 4\nf 4 2 9\n", "names vertex 9");
  said("g universal_16\nf 1 2 4\nf 4 2 3\n", "line 5 names the group \"universal_16\"");
  EXPECT_NE(refusal_of("jaw.obj", obj("g FDI_16\nf 1 2 4\nf 4 2 3\n"), ToothNumbers::kUniversal)
                .find("of another system than --numbering"),
            std::string::npos);
}

TEST(LabelsOfObj, ThatAreAlsoAnStlAreRefused) {
  std::string file = "v 0 0 0\nv 1 0 0\nv 0 1 0\ng 16\nf 1 2 3\nf 1 2 3\n#";
  file.resize(80, ' ');
  file += std::string("\1\0\0\0", 4) + std::string(50, '\0');
  file.replace(96, 4, "\0\0\x80\x3F", 4);  // one coordinate is 1
  const std::string text = refusal_of("jaw.obj", file);
  EXPECT_NE(text.find("2 labels for 1 triangle"), text.npos) << text;
}

}  // namespace
}  // namespace ist::test
