#!/usr/bin/env bash
# Checks that the code keeps the order of its rooms: includes go one way, and what only one file may
# do, only one does. Prints each breach and fails if there is any.
set -euo pipefail
cd "$(dirname "$0")/.."
failed=0
breach() { echo "$*" >&2; failed=1; }

layers=(base mesh voxel tree query haptics scene capi)
for i in "${!layers[@]}"; do
  for later in "${layers[@]:i+1}"; do
    found=$(grep -rnE "#include \"ist/$later/" "src/ist/${layers[i]}" || true)
    [ -z "$found" ] || breach "${layers[i]} includes $later, which stands after it: $found"
  done
done
found=$(grep -rnE '#include "ist/' src/ist/hardware | grep -vE '"ist/(base|mesh|voxel|tree|hardware)/' || true)
[ -z "$found" ] || breach "hardware includes more than base, mesh, voxel and tree: $found"
found=$(grep -rn '#include "ist/hardware/' src/ist simd | grep -v '^src/ist/hardware/' || true)
[ -z "$found" ] || breach "hardware is for the command, tests and benchmarks alone: $found"
found=$(grep -rn '#include "cli/' src/ist simd || true)
[ -z "$found" ] || breach "the library includes the command: $found"
found=$(grep -rnE '#include "ist/' simd | grep -vE '"ist/(base|tree|query)/' || true)
[ -z "$found" ] || breach "simd includes more than base, tree and query: $found"
found=$(grep -rn '#include "simd/' src | grep -v '"simd/kernels\.h"' || true)
[ -z "$found" ] || breach "the vector twins have one door, simd/kernels.h: $found"

only() {  # what, pattern, the one file (a pattern), where to look
  local found
  found=$(grep -rlE "$2" $4 | grep -vxE "$3" || true)
  [ -z "$found" ] || breach "$1 is also in: $found"
}
only "assimp" '#include [<"]assimp/' 'src/ist/mesh/mesh_io\.cpp' "src simd"
only "TBB" '#include [<"](tbb|oneapi)/' 'src/ist/base/tbb_ranges\.cpp' "src simd"
only "Highway" '#include [<"]hwy/' 'simd/[a-z_]+(\.cpp|-inl\.h)' "src simd tests bench"
only "toml++" '#include [<"]toml' 'src/ist/scene/toml_document\.cpp' "src simd tests bench"
only "a catch" '(^|[^[:alnum:]_])catch \(' 'src/(cli/main\.cpp|examples/[a-z_]+\.cpp|ist/scene/scene_trees\.cpp|ist/capi/guard\.(h|cpp))' src
only "printing" '(std::cout|std::cerr|fmt::print|[^f]printf\()' 'src/ist/base/assert\.h' "src/ist simd"
only "a root of several numbers at once, whose bits depend on the processor (Eigen's is an estimate)" '\.r?sqrt\(\)' 'none' "src simd"
# Sizes rounded up to a vector's can hide it, so a test of sizes alone does not.
found=$(grep -rnE '^ +(const )?Eigen::(Isometry3|Affine3|Projective3|Transform|Matrix4|Vector4|Quaternion)[^&*()]* [a-z_]+( = [^;]*|\{[^;]*\})?;' src/ist --include='*.h' || true)
[ -z "$found" ] || breach "a member whose alignment depends on the instruction set of who includes it: $found"

long=$(find src simd tests bench -name '*.h' -o -name '*.cpp' | xargs -r wc -l | awk '$2 != "total" && $1 > 400 {print $2 " has " $1 " lines"}')
[ -z "$long" ] || breach "longer than 400 lines: $long"
exit $failed
