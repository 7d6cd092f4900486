"""Faults in the tests of a query, and in work that is shared or cut short."""

from .mutant import Mutant, SEARCH_POSE, LANES, BOUNDS_INL, MEASURE_INL, PAIR_ROWS_INL, SHARED, TANGENCY, KERNELS, GUARANTEE

RULES = "src/ist/query/query_rules.h"
RESOLUTION = "return 2 * (fixed.largest_leaf_radius(policy) + moving.largest_leaf_radius(policy)) + result.pad;"
RESOLUTIONS = ["query_test Engines/Resolution*:ResolutionOfContacts*"]

MUTANTS = [
    # The tests of a query.
    Mutant("ball-pad-dropped", "the sum of two radii lacks the pad for float rounding",
           [(SEARCH_POSE, "round_up(kLeafBall * lengths + kLeafMargin * margin)",
             "round_up(kLeafMargin * margin)")], [TANGENCY, GUARANTEE]),
    Mutant("slab-pad-dropped", "the reach of a ball and a slab lacks the pad for float rounding",
           [(SEARCH_POSE, "round_up(kLeafSlab * lengths + kLeafMargin * margin)",
             "round_up(kLeafMargin * margin)")], [TANGENCY, GUARANTEE]),
    Mutant("pad-forgets-the-place", "the pad does not grow with the translation",
           [(SEARCH_POSE, "std::sqrt((t[0] * t[0] + t[1] * t[1]) + t[2] * t[2]);", "0 * t[0];")], ["query_test SearchPose*"]),
    Mutant("touching-does-not-count", "`>=` instead of `>`: balls that are tangent to the last bit are apart",
           [(LANES, "return !(squared > radius_sum * radius_sum)", "return !(squared >= radius_sum * radius_sum)")],
           [KERNELS]),
    Mutant("no-number-is-lost", "a pair is kept by `<=` instead of rejected by `>`, so that NaN is lost",
           [(BOUNDS_INL, "auto separate = hn::Gt(squared, hn::Mul(radius_sum, radius_sum));",
             "auto separate = hn::Not(hn::Le(squared, hn::Mul(radius_sum, radius_sum)));")], [KERNELS]),
    Mutant("last-lane-skipped", "the last moving node of a row is not tested",
           [(PAIR_ROWS_INL, "const auto here = hn::FirstN(d, end - i);",
             "const auto here = hn::FirstN(d, end - i - 1);")], [KERNELS]),
    Mutant("empty-lanes-kept", "the lanes behind the last moving node are tested too",
           [(PAIR_ROWS_INL, "const auto overlapping = hn::AndNot(test.Separate(), here);",
             "const auto overlapping = hn::Not(test.Separate());")], [KERNELS]),
    Mutant("moving-slab-forgotten", "a pair is not rejected by the moving node's slab",
           [(LANES, "!(over_moving > moving_sum);", "!(over_moving > 1e9F * moving_sum);")], [KERNELS]),
    Mutant("slab-offset-turned-round", "the fixed slab's offset is added instead of subtracted",
           [(LANES, "rows.offset[at] = fixed.lane[kOffset][at] * kUnscale;",
             "rows.offset[at] = -fixed.lane[kOffset][at] * kUnscale;"),
            (BOUNDS_INL, "hn::StoreU(hn::Mul(load(kOffset), unscale), d, rows.offset + k);",
             "hn::StoreU(hn::Neg(hn::Mul(load(kOffset), unscale)), d, rows.offset + k);")],
           [GUARANTEE]),
    Mutant("rotation-narrowed-first", "the translation is turned by a rotation already rounded to float",
           [(SEARCH_POSE, "moved -= pose.rotation(j, i) * pose.translation[j];",
             "moved -= static_cast<float>(pose.rotation(j, i)) * static_cast<float>(pose.translation[j]);")],
           ["query_test SearchPose*"]),
    Mutant("frames-in-plain-double", "frames are composed without compensation, so that the answer depends on the place",
           [("src/ist/base/compensated.h", "return sum_ + error_; }", "return sum_; }")],
           ["base_test", "query_test RelativePose*"]),
    Mutant("pose-not-projected", "a nearly orthonormal rotation is not projected",
           [("src/ist/base/pose.cpp", "for (int step = 0; step < 3; ++step) {",
             "for (int step = 0; step < 0; ++step) {")], ["query_test *AnswersAreAboutTheProjectedPose*", "base_test"]),
    Mutant("mirror-accepted", "a mirroring pose is accepted as a rigid motion",
           [("src/ist/base/pose.cpp", "if (!(determinant(rotation) > 0)) return std::nullopt;",
             "static_cast<void>(determinant(rotation));")], ["base_test"]),
    Mutant("query-forgets-mxcsr", "a query computes with its caller's floating-point flags",
           [("src/ist/query/query.cpp", """                              const Budget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  detail::QueryState& s = *state_;
  const detail::Use use(s);
  if (!use) return {.status = QueryStatus::kBusy, .complete = false};
  LeafPairSink sink(s.plan, s.kernels, out);""", """                              const Budget& budget) noexcept {
  detail::QueryState& s = *state_;
  const detail::Use use(s);
  if (!use) return {.status = QueryStatus::kBusy, .complete = false};
  LeafPairSink sink(s.plan, s.kernels, out);""")],
           ["search_test *KeepsTheFloatEnvironment*", "stability_test *Environment*"]),
    Mutant("environment-not-restored", "a query leaves its own floating-point environment to its caller",
           [("src/ist/query/query.cpp", """                              const Budget& budget) noexcept {
  const ScopedFloatEnvironment environment;
  detail::QueryState& s = *state_;
  const detail::Use use(s);
  if (!use) return {.status = QueryStatus::kBusy, .complete = false};
  LeafPairSink sink(s.plan, s.kernels, out);""", """                              const Budget& budget) noexcept {
  FloatRegisters().write();
  detail::QueryState& s = *state_;
  const detail::Use use(s);
  if (!use) return {.status = QueryStatus::kBusy, .complete = false};
  LeafPairSink sink(s.plan, s.kernels, out);""")],
           ["search_test *KeepsTheFloatEnvironment*"]),
    Mutant("worker-forgets-mxcsr", "the second worker computes with the flags of its thread",
           [("src/ist/query/workers/resident_worker.cpp", "const ScopedFloatEnvironment environment;", "")],
           ["workers_test *Ieee*"]),
    Mutant("build-forgets-mxcsr", "the threads that build compute with their own flags",
           [("src/ist/base/parallel.cpp", "const ScopedFloatEnvironment environment;", "")],
           ["base_test *Parallel*"]),

    # Work that is shared, or cut short.
    Mutant("last-chunk-lost", "the second worker's last chunk is forgotten",
           [(SHARED, "for (std::size_t index = queue_.close(); index < chunk_count_ && in_time; ++index) {",
             "for (std::size_t index = queue_.close(); index + 1 < chunk_count_ && in_time; ++index, ++done) {")],
           ["search_test SharedSearch*"]),
    Mutant("cut-chunk-taken-for-whole", "a chunk that did not fit the worker's memory counts as complete",
           [(SHARED, "made.whole = !sink.truncated();", "made.whole = true;")],
           ["search_test SharedSearch*"]),
    Mutant("short-list-taken-for-whole", "a chunk whose leaves did not fit the worker's memory counts as complete",
           [(SHARED, "made.whole = !found_leaves_.is_short();", "made.whole = true;")],
           ["search_test SharedContacts*"]),
    Mutant("step-made-twice", "a search with a limit of tests forgets the tests of a step that overflowed",
           [(SHARED, "if (meter.budget().has_tests()) {", "if (meter.budget().tests == 0) {")],
           ["search_test SharedSearch*"]),
    Mutant("margin-widens-interval", "the roots' bound on the distance includes the margin",
           [("src/ist/query/traversal/root_test.cpp", "test.pad = pad_in_double(bounding_radii, farthest);",
             "test.pad = pad_in_double(bounding_radii, farthest) + margin;")],
           ["contacts_test StoppedContacts*"]),
    Mutant("late-worker-believed", "a late worker's result for an earlier query counts",
           [("src/ist/query/workers/split_queue.cpp",
             "return epoch << 2 | verdict;", "return (epoch & 0) << 2 | verdict;")],
           ["workers_test SplitQueue*", "search_test SharedSearch*"]),
    Mutant("leaf-pairs-not-measured", "the lower end of a distance forgets the pairs of the last step",
           [("simd/step_scalar.cpp", "(step.last || !overlapping)", "!overlapping"),
            (PAIR_ROWS_INL, "last ? here : hn::AndNot(overlapping, here)", "hn::AndNot(overlapping, here)")],
           ["search_test *Within*", "exact_test QueryDistance*"]),
    Mutant("bound-missed", "a pair that improves a bound slightly is skipped",
           [(MEASURE_INL, "const float spare = 0x1p-20F;", "const float spare = -0x1p-6F;")],
           [KERNELS]),
    Mutant("gap-raised", "the lower end of a gap is eight pads above the float bound",
           [("src/ist/query/query_distance.cpp", "std::max(lower, nearest.least())",
             "std::max(lower, nearest.least() + 8 * pad_of(plain))")],
           ["exact_test QueryDistance*"]),
    Mutant("budget-overdrawn", "tests spent before do not count",
           [("src/ist/query/traversal/budget_meter.h", "budget_.tests - spent_", "budget_.tests")],
           ["search_test *Within*:BudgetMeter*"]),
    Mutant("clock-read-seldom", "the clock is read every 5000 tests",
           [("src/ist/query/traversal/budget_meter.h", "kUnwatchedTests = 500", "kUnwatchedTests = 5000")],
           ["search_test *Within*"]),
    Mutant("row-torn", "an unfinished row counts as two",
           [("simd/step.h", "--frontier.group_count;\n  return frontier.group_count == 0 ? 0",
             "return frontier.group_count == 0 ? 0")], ["search_test *Within*:*Advance*"]),

    # What a result tells of its pairs.
    Mutant("resolution-of-two-radii", "the resolution is the distance of two centres, not of two surfaces",
           [(RULES, RESOLUTION, RESOLUTION.replace("2 * (", "("))], RESOLUTIONS),
    Mutant("resolution-of-the-smaller-body", "the resolution goes by the smaller body's leaves alone",
           [(RULES, RESOLUTION, RESOLUTION.replace("2 * (", "4 * std::min(").replace(" + moving", ", moving"))], RESOLUTIONS),
    Mutant("resolution-without-the-margin", "the resolution lacks the margin that was asked for",
           [(RULES, RESOLUTION, RESOLUTION.replace(" + result.pad", " + 0 * result.pad"))], RESOLUTIONS),
]
