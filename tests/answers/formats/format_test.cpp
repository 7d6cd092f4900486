#include "answers/formats/format.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "answers/refusals.h"

namespace ist::test {
namespace {

using answers::FileFormat;

std::string refusal(const std::string& file, std::vector<FileFormat> writable) {
  try {
    static_cast<void>(answers::format_by_ending("-o", file, writable));
  } catch (const answers::Refusal& error) {
    return error.what();
  }
  return "none";
}

TEST(FileFormats, EachIsKnownByItsEndingInAnyCase) {
  constexpr std::array kAll{FileFormat::kVtp, FileFormat::kPly,   FileFormat::kGlb,
                            FileFormat::kCsv, FileFormat::kJsonl, FileFormat::kJson,
                            FileFormat::kHtml};
  const std::vector<std::string> files{"a.vtp",   "a.b.PLY",      "folder.ply/a.glb",
                                       "./a.Csv", "/tmp/a.JsonL", "a.jsonl.json",
                                       "a b.hTmL"};
  for (std::size_t i = 0; i < kAll.size(); ++i) {
    EXPECT_EQ(answers::format_by_ending("-o", files[i], kAll), kAll[i]) << files[i];
  }
}

TEST(FileFormats, HelpsNameThePrograms) {
  constexpr std::array kSome{FileFormat::kVtp, FileFormat::kCsv, FileFormat::kJson};
  EXPECT_EQ(answers::endings_with_programs(kSome),
            ".vtp (ParaView, 3D Slicer), .csv (Excel, R) or .json");
}

TEST(FileFormats, WhatCannotBeWrittenIsRefusedWithARemedy) {
  EXPECT_EQ(refusal("v.stl", {FileFormat::kVtp, FileFormat::kPly}),
            "-o v.stl: .stl cannot be written here: name a file that ends in .vtp or .ply");
  EXPECT_EQ(refusal("a.VTP", {FileFormat::kPly, FileFormat::kGlb, FileFormat::kCsv}),
            "-o a.VTP: .VTP cannot be written here: name a file that ends in .ply, .glb or .csv");
  EXPECT_EQ(refusal("folder.ply/v", {FileFormat::kPly}),
            "-o folder.ply/v: a name without an ending says no format: name a file that ends in "
            ".ply");
  EXPECT_EQ(refusal("v.plyx", {FileFormat::kPly}),
            "-o v.plyx: .plyx cannot be written here: name a file that ends in .ply");
}

}  // namespace
}  // namespace ist::test
