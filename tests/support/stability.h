#pragma once

#include <cstdint>
#include <string>

namespace ist::test {

/// One line of perf/STABILITY.md: errors that were seen in a hard case, beside what is guaranteed.
///
/// Each sample that breaks its bound fails the test. At its end the case is appended, as one JSON
/// object, to the file that IST_STABILITY names, if it names one.
class StabilityCase {
 public:
  /// @param group what is hard about it, one word or two: the heading it stands under
  /// @param name  what was tried
  /// @param error what is measured, with its unit, in a few words: "mm of gap", "wrong pairs"
  StabilityCase(std::string group, std::string name, std::string error);
  ~StabilityCase();
  StabilityCase(const StabilityCase&) = delete;
  StabilityCase& operator=(const StabilityCase&) = delete;

  /// One sample. Fails the test where `error` is larger than `bound`, or no number. With a bound of
  /// 0 nothing but 0 will do: so are answers counted that are right or wrong.
  void sample(double error, double bound, const std::string& what = {});
  /// `count` samples at once, of which `error` is the worst over its bound.
  void samples_of(std::uint64_t count, double error, double bound, const std::string& what = {});

  [[nodiscard]] std::uint64_t tried() const { return tried_; }

 private:
  std::string group_, name_, error_;
  std::uint64_t tried_ = 0, broken_ = 0;
  double worst_ratio_ = -1, worst_ = 0, bound_ = 0;  // at the sample whose error / bound is largest
};

}  // namespace ist::test
