#pragma once

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "ist/base/error.h"
#include "ist/mesh/import/import_message.h"
#include "support/temp_dir.h"

namespace ist::test {

/// Sets IST_IMPORT to a program, and then back.
class ScopedImporter {
 public:
  explicit ScopedImporter(const std::string& program) {
    const char* before = std::getenv("IST_IMPORT");
    before_ = before == nullptr ? "" : before;
    ::setenv("IST_IMPORT", program.c_str(), 1);
  }
  ~ScopedImporter() { ::setenv("IST_IMPORT", before_.c_str(), 1); }
  ScopedImporter(const ScopedImporter&) = delete;
  ScopedImporter& operator=(const ScopedImporter&) = delete;

 private:
  std::string before_;
};

/// A shell script in place of ist-import; `answer` lies in its folder, in the file that $ANSWER
/// names.
class FakeImporter {
 public:
  explicit FakeImporter(const std::string& script, const std::string& answer = "")
      : program_(folder_.write("importer", "#!/bin/sh\nANSWER='" +
                                               folder_.write("answer", answer).string() + "'\n" +
                                               script + "\n")),
        scoped_((std::filesystem::permissions(program_, std::filesystem::perms::owner_all),
                 program_.string())) {}
  [[nodiscard]] const std::filesystem::path& program() const { return program_; }

 private:
  TempDir folder_;
  std::filesystem::path program_;
  ScopedImporter scoped_;
};

/// An answer of ist-import: a mesh of these doubles, sizes and corners.
struct FakeMesh {
  ImportHeader header = import_header();
  std::vector<double> coordinates = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::vector<std::uint32_t> sizes = {3}, corners = {0, 1, 2};
  std::string end{kImportEnd};

  [[nodiscard]] FakeMesh& counted() {
    header.vertices = coordinates.size() / 3;
    header.polygons = sizes.size();
    header.corners = corners.size();
    return *this;
  }
  [[nodiscard]] std::string bytes() const {
    std::string all;
    const auto add = [&](const void* data, std::size_t size) {
      all.append(static_cast<const char*>(data), size);
    };
    add(&header, sizeof header);
    add(coordinates.data(), coordinates.size() * sizeof(double));
    add(sizes.data(), sizes.size() * 4);
    add(corners.data(), corners.size() * 4);
    return all + end;
  }
};

/// An answer of ist-import: an error.
[[nodiscard]] inline std::string fake_error(ErrorCode code, const std::string& place,
                                            const std::string& cause) {
  ImportHeader header = import_header();
  header.kind = ImportHeader::kError;
  header.unit = static_cast<std::uint32_t>(code);
  header.vertices = place.size();
  header.polygons = cause.size();
  std::string all(sizeof header, '\0');
  std::memcpy(all.data(), &header, sizeof header);
  return all + place + cause + std::string(kImportEnd);
}

}  // namespace ist::test
