#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <cfenv>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include "ist/query/query.h"
#include "ist/tree/sphere_tree.h"
#include "query/query_cases.h"
#include "support/shapes.h"
#include "support/stability.h"
#include "support/temp_dir.h"

namespace ist::test {

inline constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x40;
/// Flags, of which one is up or none: so is seen who clears them, and who raises them.
inline constexpr unsigned kFlags = 0x3F, kInexactSeen = 0x20;
/// That the processor traps what is invalid, divided by zero, too large or too small.
inline constexpr unsigned kTraps = 0x80 | 0x200 | 0x400 | 0x800;

/// The caller's arithmetic while it lives, of SSE and, as to rounding, of the x87 too.
class HostArithmetic {
 public:
  HostArithmetic(int rounding, unsigned bits, unsigned traps = 0) : saved_(_mm_getcsr()) {
    std::fesetround(rounding);
    _mm_setcsr((_mm_getcsr() & ~(traps | kFlags)) | bits | (traps != 0 ? kInexactSeen : 0));
    set_ = _mm_getcsr();
  }
  ~HostArithmetic() {
    std::fesetround(FE_TONEAREST);
    _mm_setcsr(saved_);
  }
  HostArithmetic(const HostArithmetic&) = delete;
  HostArithmetic& operator=(const HostArithmetic&) = delete;
  /// Whether it is as it was set, flags and all.
  [[nodiscard]] bool is_kept() const { return _mm_getcsr() == set_; }

 private:
  unsigned saved_, set_;
};

/// Bytes of all that is said, compared as they are: nothing here computes.
class Record {
 public:
  template <class Number>
  void add(const Number& number) {
    static_assert(std::is_arithmetic_v<Number> || std::is_enum_v<Number>);
    bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  template <class Number>
  void add(const std::vector<Number>& numbers) {
    for (const Number& number : numbers) add(number);
  }
  void add(const Eigen::Vector3d& vector) {
    for (const double x : vector) add(x);
  }
  void add(const DistanceInterval& gap) {
    add(gap.lower);
    add(gap.upper);
  }
  void add(const LeafPair& pair) {
    add(pair.fixed);
    add(pair.moving);
  }
  void add(const TrianglePair& pair) {
    add(pair.fixed);
    add(pair.moving);
  }
  void add(const FoundPairs& answer) {
    add(answer.leaf_pairs);
    add(answer.result.sphere_tests);
    add(answer.result.pad);
    add(answer.result.resolution);
  }
  void add(const Contact& contact) {
    add(contact.position);
    add(contact.normal);
    add(contact.depth);
    add(contact.weight);
  }
  void add(const std::string& bytes) { bytes_ += bytes; }
  [[nodiscard]] const std::string& all() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Two bodies with coordinates of every size, denormal ones too; `unit` makes them so small that
/// squares of lengths are nearly denormal floats.
struct Meshes {
  explicit Meshes(double unit) : a(icosphere(2, unit)), b(icosphere(1, 0.8 * unit)) {
    for (TriangleMesh* mesh : {&a, &b}) {
      mesh->vertices[0] += Eigen::Vector3d(1e-310, -3e-320, 0);
      *mesh = joined(*mesh, triangle({1e-310, 0, 0}, {0, 0.7 * unit, 1e-312}, {0, 0, 0.3 * unit}));
    }
  }
  TriangleMesh a, b;
};

[[nodiscard]] inline SphereTree built(const TriangleMesh& mesh, double voxel_size) {
  BuildOptions options;
  options.voxel_size = voxel_size;
  options.keep_triangles = true;
  options.proximity = true;
  return build_tree(mesh, options);
}

/// Two units of length: powers of two, so that nothing here is rounded.
class FloatEnvironmentOfTheCaller : public ::testing::TestWithParam<double> {
 protected:
  /// In each arithmetic of a caller, `call` records the same bytes, at least `least`, and leaves
  /// the arithmetic as it was.
  template <class Call>
  void changes_nothing(const std::string& name, std::size_t least, const Call& call) const {
    const std::string unit =
        unit_ == 1 ? "" : fmt::format(", unit of length 2^{}", std::ilogb(unit_));
    StabilityCase wrong("arithmetic", name + " in any arithmetic of the caller" + unit,
                        "answers that differ, or change the arithmetic");
    std::string expected;
    for (const int rounding : {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
      for (const unsigned bits :
           {0U, kFlushToZero, kDenormalsAreZero, kFlushToZero | kDenormalsAreZero}) {
        Record record;
        bool kept = false;
        {
          const HostArithmetic host(rounding, bits, bits == 0 ? 0 : kTraps);
          call(record);
          kept = host.is_kept();
        }
        if (expected.empty()) expected = record.all();
        std::ostringstream where;
        where << "rounding " << rounding << ", bits " << std::hex << bits;
        wrong.sample(record.all() == expected ? 0 : 1, 0, where.str() + ": the answer differs");
        wrong.sample(kept ? 0 : 1, 0, where.str() + ": MXCSR is changed");
      }
    }
    EXPECT_GE(expected.size(), least);
  }

  [[nodiscard]] SphereTree tree(const TriangleMesh& mesh) const {
    return built(mesh, 0.11 * unit_);
  }
  [[nodiscard]] std::string bytes_of(const SphereTree& tree) const {
    write_tree(tree, bytes_);
    return file_content(bytes_);
  }

  const double unit_ = GetParam();
  const Meshes meshes_{unit_};
  const TempDir folder_;
  const std::filesystem::path bytes_ = folder_.path() / "bytes.ist";  // joining names rounds
};

}  // namespace ist::test
