"""Ways to break the code, each of which some test must notice. mutate.py runs them."""

from typing import NamedTuple


class Mutant(NamedTuple):
    name: str
    breaks: str  # what it does, for perf/MUTANTS.md
    edits: list  # (file, a passage that is there once, what stands there instead)
    tests: list  # programs, or programs and a filter, in the order in which they are asked


SEARCH_POSE = "src/ist/query/search_pose.cpp"
LANES = "src/ist/query/bound_lanes.h"
BOUNDS_INL = "simd/bounds-inl.h"
SHARED = "src/ist/query/shared_search.cpp"
NODE_BOUNDS = "src/ist/tree/node_bounds.cpp"
VOXELIZER = "src/ist/voxel/voxelizer.cpp"
BINS = "src/ist/voxel/triangle_bins.cpp"
BOX = "src/ist/voxel/triangle_box.h"
EXACT = "src/ist/query/exact/"
CONTACTS = "src/ist/query/contacts/"

TANGENCY = "stability_test *Tangency*"
KERNELS = "search_test *StepParts*:*TouchRow*:*Advance*"
PROMISE = "search_test *Promise*-*Thread*"

MUTANTS = [
    # What a query decides by.
    Mutant("ball-pad-dropped", "float's rounding is not added to the reach of two balls",
           [(SEARCH_POSE, "round_up(kBallRounding * lengths + kOfGrowth * grow)",
             "round_up(kOfGrowth * grow)")], [TANGENCY, PROMISE]),
    Mutant("slab-pad-dropped", "nor to that of a ball and a slab",
           [(SEARCH_POSE, "round_up(kSlabRounding * lengths + kOfGrowth * grow)",
             "round_up(kOfGrowth * grow)")], [TANGENCY, PROMISE]),
    Mutant("pad-forgets-the-place", "the pad does not grow with the translation",
           [(SEARCH_POSE, "reaches + std::sqrt((t[0] * t[0] + t[1] * t[1]) + t[2] * t[2])",
             "0.1 * reaches + 0 * t[0]")], [TANGENCY, PROMISE]),
    Mutant("touching-does-not-count", "`>=` for `>`: balls that are tangent to the last bit are apart",
           [(LANES, "if ((dx * dx + dy * dy) + dz * dz > reach * reach) return false;",
             "if ((dx * dx + dy * dy) + dz * dz >= reach * reach) return false;")], [KERNELS]),
    Mutant("no-number-is-lost", "kept by `<=` where it is rejected by `>`, so that NaN is lost",
           [(BOUNDS_INL, "auto apart = hn::Gt(squared, hn::Mul(reach, reach));",
             "auto apart = hn::Not(hn::Le(squared, hn::Mul(reach, reach)));")], [KERNELS]),
    Mutant("last-lane-skipped", "the last moving node of a row is not tested",
           [(BOUNDS_INL, "const auto touching = hn::AndNot(apart, hn::FirstN(d, end - i));",
             "const auto touching = hn::AndNot(apart, hn::FirstN(d, end - i - 1));")], [KERNELS]),
    Mutant("empty-lanes-kept", "what lies in the lanes behind the last moving node is tested too",
           [(BOUNDS_INL, "const auto touching = hn::AndNot(apart, hn::FirstN(d, end - i));",
             "const auto touching = hn::Not(apart);")], [KERNELS]),
    Mutant("moving-slab-forgotten", "a pair is not rejected by the moving node's slab",
           [(LANES, "return !(std::abs(above_moving) > m.lane[kHalf][at] + f.scaled_radius[row]);",
             "return above_moving == above_moving || true;")], [KERNELS]),
    Mutant("slab-offset-turned-round", "the fixed slab's offset is added where it is taken off",
           [(LANES, "rows.offset[at] = fixed.lane[kOffset][at] * kUnscale;",
             "rows.offset[at] = -fixed.lane[kOffset][at] * kUnscale;"),
            (BOUNDS_INL, "hn::StoreU(hn::Mul(load(kOffset), unscale), d, rows.offset + k);",
             "hn::StoreU(hn::Neg(hn::Mul(load(kOffset), unscale)), d, rows.offset + k);")],
           [PROMISE]),
    Mutant("rotation-narrowed-first", "the translation is turned by a rotation that is float already",
           [(SEARCH_POSE, "moved -= pose.rotation(j, i) * pose.translation[j];",
             "moved -= static_cast<float>(pose.rotation(j, i)) * static_cast<float>(pose.translation[j]);")],
           [TANGENCY, PROMISE]),
    Mutant("frames-in-plain-double", "frames are composed without compensation, so that the place counts",
           [("src/ist/base/compensated.h", "return sum_ + error_; }", "return sum_; }")],
           ["base_test", "query_test RelativePose*"]),
    Mutant("pose-not-projected", "a rotation that is nearly orthonormal is taken as it is",
           [("src/ist/base/pose.cpp", "for (int step = 0; step < 3; ++step) {",
             "for (int step = 0; step < 0; ++step) {")], ["base_test"]),
    Mutant("mirror-accepted", "a pose that mirrors is taken for a motion",
           [("src/ist/base/pose.cpp", "if (!(determinant(rotation) > 0)) return std::nullopt;",
             "static_cast<void>(determinant(rotation));")], ["base_test"]),
    Mutant("query-forgets-mxcsr", "a query computes as its caller's flags have it",
           [("src/ist/query/collision_query.cpp", """std::span<Contact> out) noexcept {
  const ScopedFloatEnvironment environment;""", "std::span<Contact> out) noexcept {")],
           ["search_test *KeepsTheFloatEnvironment*", "stability_test *Environment*"]),
    Mutant("worker-forgets-mxcsr", "the second worker does",
           [("src/ist/query/workers.cpp", "const ScopedFloatEnvironment environment;", "")],
           ["workers_test *Ieee*"]),
    Mutant("build-forgets-mxcsr", "the threads that build do",
           [("src/ist/base/parallel.cpp", "const ScopedFloatEnvironment environment;", "")],
           ["base_test *Parallel*", "stability_test *Environment*"]),
    # Work that is shared, or cut short.
    Mutant("last-chunk-lost", "the second worker's last chunk is forgotten",
           [(SHARED, "for (std::size_t index = board_.close(); index < chunk_count_; ++index) {",
             "for (std::size_t index = board_.close(); index + 1 < chunk_count_; ++index) {")],
           ["search_test SharedSearch*"]),
    Mutant("cut-chunk-taken-for-whole", "a chunk for which the worker had no room is taken as it is",
           [(SHARED, "made.whole = !sink.truncated();", "made.whole = true;")],
           ["search_test SharedSearch*"]),
    Mutant("late-worker-believed", "what a worker that is late makes of an earlier query counts",
           [("src/ist/query/chunk_board.cpp",
             "return epoch << 2 | verdict;", "return (epoch & 0) << 2 | verdict;")],
           ["workers_test ChunkBoard*", "search_test SharedSearch*"]),
    Mutant("pruned-taken-for-live", "the nearest pruned pair counts as touching, and the other way round",
           [(LANES, "float& least = touching ? measure.touching : measure.pruned;",
             "float& least = touching ? measure.pruned : measure.touching;")],
           ["search_test *Within*", KERNELS]),
    Mutant("gap-without-pad", "the lower end of a gap is raised by the pad, not lowered",
           [("src/ist/query/collision_gap.cpp", "within + known.leaves.touching - pad",
             "within + known.leaves.touching + pad")], ["exact_test Gap*", "stability_test"]),
    Mutant("budget-overdrawn", "a budget of tests is compared with what is spent alone",
           [("src/ist/query/budget.h", "tests > budget_.sphere_tests - tests_",
             "tests_ > budget_.sphere_tests")], ["search_test *Within*:Spending*"]),
    # The tree.
    Mutant("table-radius-less", "the lookup table's smallest radius is one less",
           [("src/ist/tree/lookup_table.h", "best_squared = farthest;\n",
             "best_squared = farthest;\n        if (farthest == 54) farthest = 53;\n")], ["tree_test"]),
    Mutant("table-radius-rounded-down", "the table's radii are rounded down when they become float",
           [(LANES, "radius * (1 + 0x1p-23)", "radius * (1 - 0x1p-22)")],
           ["tree_test", KERNELS, TANGENCY]),
    Mutant("ball-rounded-down", "a saved radius is rounded down",
           [(NODE_BOUNDS, "std::ceil((std::sqrt(farthest2) + payload.slack) / unit)",
             "std::max(1.0, std::floor((std::sqrt(farthest2) + payload.slack) / unit))")], ["tree_test"]),
    Mutant("slab-rounded-down", "a saved half-width is rounded down",
           [(NODE_BOUNDS, "std::ceil((half + payload.slack) / unit)",
             "std::max(1.0, std::floor((half + payload.slack) / unit))")], ["tree_test"]),
    Mutant("octants-swapped", "the x and y bits of an octant are swapped where children are placed",
           [("src/ist/tree/linear_octree.cpp",
             "{{from[0] + ((k & 1) != 0 ? half : -half), from[1] + ((k & 2) != 0 ? half : -half),",
             "{{from[0] + ((k & 2) != 0 ? half : -half), from[1] + ((k & 1) != 0 ? half : -half),")],
           ["tree_test"]),
    Mutant("implicit-octants-swapped", "likewise where a sphere is made from its parent's mask",
           [(LANES, "((octant & 1) != 0 ? offset : -offset)", "((octant & 2) != 0 ? offset : -offset)"),
            (LANES, "float y = node.centre[1] * side.voxel_size + ((octant & 2) != 0 ? offset : -offset)",
             "float y = node.centre[1] * side.voxel_size + ((octant & 1) != 0 ? offset : -offset)")],
           [PROMISE]),
    Mutant("morton-axes-swapped", "codes have y in the bits of z",
           [("src/ist/voxel/morton.h",
             "spread_bits(cell[0]) | spread_bits(cell[1]) << 1 | spread_bits(cell[2]) << 2",
             "spread_bits(cell[0]) | spread_bits(cell[2]) << 1 | spread_bits(cell[1]) << 2")],
           ["voxel_test"]),
    Mutant("checksum-not-compared", "a tree file is believed whatever its checksum",
           [("src/ist/tree/tree_stream.cpp", "if (checksum_.value() != expected_) corrupt",
             "if (checksum_.value() == 0 && expected_ != 0) corrupt")], ["tree_test *Damaged*:TreeFile*"]),
    Mutant("any-version-read", "a tree file of another version is read",
           [("src/ist/tree/tree_stream.cpp", "if (preamble.version != kTreeFileVersion) {",
             "if (preamble.version == 0) {")], ["tree_test *Damaged*:TreeFile*"]),
    # Voxels and meshes.
    Mutant("voxel-pad-dropped", "a cube is not grown before a triangle is tested against it",
           [(VOXELIZER, "return lattice.pad() * (1 - 1.0 / 1024);", "return 0 * lattice.pad();")],
           ["voxel_test"]),
    Mutant("voxels-in-float", "triangles are float when they are tested against cubes",
           [("src/ist/voxel/triangle_bins.cpp",
             "return Eigen::Vector3d(lattice.to_lattice(vertex).array() + offset);",
             "return Eigen::Vector3d(lattice.to_lattice(vertex).cast<float>().cast<double>().array() + offset);")],
           ["voxel_test"]),
    Mutant("sliver-normals-plain", "a triangle's normal is a plain difference of products",
           [("src/ist/voxel/triangle_box.cpp", "  return sum.value();", "  return a * d - b * c;")],
           ["voxel_test", "stability_test"]),
    Mutant("block-edge-lost", "a triangle that only touches a block from above is not sorted into it",
           [(BINS, "first[i] = block(triangle.min()[axis] - pad - 0.5);",
             "first[i] = block(triangle.min()[axis] + pad);")], ["voxel_test"]),
    Mutant("file-normals-trusted", "triangles are turned as the file's normals say",
           [("src/ist/mesh/mesh_io.cpp", "      triangulate(polygon, welder.vertices(), welded.triangles);",
             """      const auto& v = welder.vertices();
      if (mesh->HasNormals()) {
        const aiVector3D& n = mesh->mNormals[face.mIndices[0]];
        const Eigen::Vector3d across =
            (v[polygon[1]] - v[polygon[0]]).cross(v[polygon[2]] - v[polygon[0]]);
        if (across.dot(Eigen::Vector3d(n.x, n.y, n.z)) < 0) std::swap(polygon[1], polygon[2]);
      }
      triangulate(polygon, welder.vertices(), welded.triangles);""")],
           ["mesh_test"]),
    Mutant("inside-out-left", "a closed body that is inside out stays so",
           [("src/ist/mesh/orientation.cpp", "if (sign >= 0 || !is_outermost(mesh, components, component)) continue;",
             "if (sign >= 0 || is_outermost(mesh, components, component)) continue;")], ["mesh_test"]),
    Mutant("half-a-file-left", "what a write that failed leaves behind is not removed",
           [("src/ist/base/output_file.cpp", "if (!temporary_.empty()) ::unlink(temporary_.c_str());", "")],
           ["base_test OutputFile*"]),
    # Triangles and contact points.
    Mutant("predicate-without-bound", "the sign of a determinant is believed however small it is",
           [(EXACT + "orientation.cpp", "kBound3 = 8 * kRounding", "kBound3 = 0 * kRounding")],
           ["exact_test"]),
    Mutant("distance-stops-early", "an axis that almost separates two triangles is taken for one that does",
           [(EXACT + "triangle_distance.cpp", "constexpr double kRounding = 1 + 0x1p-40;",
             "constexpr double kRounding = 1 - 0x1p-10;")], ["exact_test"]),
    Mutant("triangle-box-shrunk", "the boxes of a node's triangles end at its centre",
           [(EXACT + "triangle_pairs.cpp",
             "bounds.box.low[i] = std::max(bounds.box.low[i], cube.low[i]);",
             "bounds.box.low[i] = std::max(bounds.box.low[i], 0.5F * (cube.low[i] + cube.high[i]));")],
           ["exact_test"]),
    Mutant("ancestors-not-weighed", "a contact does not fade with its ancestors",
           [(CONTACTS + "contact_points.cpp", "ancestors_.of(contact.fixed, contact.moving)",
             "(contact.fixed > 4000000000U ? 0.0 : 1.0)")], ["contacts_test *Lipschitz*:ContactPoints*"]),
    Mutant("contacts-jump", "a contact weighs all or nothing",
           [(CONTACTS + "contact_pair.h", "return std::clamp(left / (scale.reach * scale.reach), 0.0, 1.0);",
             "return left / (scale.reach * scale.reach) > 0 ? 1.0 : 0.0;")],
           ["contacts_test *Lipschitz*:ContactPoints*"]),
    Mutant("depth-turned-round", "depth is measured against the normal",
           [(CONTACTS + "contact_pair.h", "dot_in_order(terms.normal, difference(fixed.point, moving.point))",
             "dot_in_order(terms.normal, difference(moving.point, fixed.point))")],
           ["contacts_test *ClosedForms*:ContactPoints*"]),
]
