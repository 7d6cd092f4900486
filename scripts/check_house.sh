#!/usr/bin/env bash
# Checks that the code keeps the order of its rooms: includes go one way, and what only one file may
# do, only one does. Prints each breach and fails if there is any.
set -euo pipefail
cd "$(dirname "$0")/.."
failed=0
breach() { echo "$*" >&2; failed=1; }

# Folders are layers. Each includes those before it; `mesh < models`, which voxels do not need.
layers=(base mesh models voxel tree simd query measure haptics scene sweep capi)
room() { [ "$1" = simd ] && echo simd || echo "src/ist/$1"; }
path() { [ "$1" = simd ] && echo simd || echo "ist/$1"; }
for i in "${!layers[@]}"; do
  for later in "${layers[@]:i+1}"; do
    found=$(grep -rnE "#include \"$(path "$later")/" "$(room "${layers[i]}")" || true)
    [ -z "$found" ] || breach "${layers[i]} includes $later, which stands after it: $found"
  done
done
found=$(grep -rnE '#include "ist/models/' src/ist/voxel src/ist/tree simd src/ist/query || true)
[ -z "$found" ] || breach "built-in models are for scenes and tools alone: $found"
# Headers of users gather several layers, and angle brackets and paths upwards would hide one.
found=$(grep -rnE '#include "ist/(ist|measure|haptics|scene)\.h"' src/ist simd | grep -vE '^src/ist/((ist|measure|haptics|scene)\.h|scene/|capi/)' || true)
[ -z "$found" ] || breach "a layer includes a header of users: $found"
found=$(grep -rnE '#include (<(ist|simd)/|"\.\./)' src/ist simd src/cli src/verify src/advise || true)
[ -z "$found" ] || breach "an include that hides its layer: $found"
found=$(grep -rnE '#include "(cli|advise)/' src/verify src/hardware; grep -rnE '#include "(cli|verify)/' src/advise || true)
[ -z "$found" ] || breach "tools know the library, not each other: $found"
found=$(grep -rnE '#include "(cli|verify|advise|hardware)/|#include "ist/hardware/' src/ist simd || true)
[ -z "$found" ] || breach "the library sees no tool: $found"
found=$(grep -rnE '#include "viewer/' src simd | grep -v '^src/viewer/' || true)
[ -z "$found" ] || breach "the page stands behind all others: $found"
found=$(grep -rnE '#include "ist/' src/hardware | grep -vE '"ist/(base|mesh|voxel|tree|hardware)/' || true)
[ -z "$found" ] || breach "hardware includes more than base, mesh, voxel and tree: $found"
found=$(grep -rnE '#include "simd/[a-z_]+-inl\.h"' src || true)
[ -z "$found" ] || breach "vector code is for simd/ alone: $found"

only() {  # what, pattern, the one file (a pattern), where to look
  local found
  found=$(grep -rlE "$2" $4 | grep -vxE "$3" || true)
  [ -z "$found" ] || breach "$1 is also in: $found"
}
only "assimp, the second reader in tests," '#include [<"]assimp/' 'none' "src simd bench"
only "TBB" '#include [<"](tbb|oneapi)/' 'src/ist/base/platform/tbb_ranges\.cpp' "src simd"
only "Highway" '#include [<"]hwy/' 'simd/([a-z]+/)?[a-z_]+(\.cpp|-inl\.h)' "src simd tests bench"
only "toml++" '#include [<"]toml' 'src/ist/scene/toml_document\.cpp' "src simd tests bench"
only "GMP, an oracle of tests," '#include [<"]gmp' 'none' "src simd"
only "xxHash" '#include [<"]xxh' 'src/(ist/base/checksum|hardware/xxh64)\.(h|cpp)' "src simd"
only "zlib" '#include [<"]zlib' 'src/ist/mesh/format/threemf/zip_entry\.cpp' "src simd"
only "libpng" '#include [<"]png\.h' 'src/cli/occlusion/png_image\.cpp' "src simd"
only "JSON" '#include [<"]nlohmann/' 'src/(cli/.*|viewer/engine/.*|ist/mesh/format/gltf_(file|reader)\.(h|cpp)|ist/sweep/sweep_record\.cpp)' src
only "the command line" '#include [<"]CLI/' 'src/cli/.*' src
only "a catch" '(^|[^[:alnum:]_])catch \(' 'src/(cli/main\.cpp|examples/[a-z_]+\.cpp|ist/base/platform/thread_ranges\.cpp|ist/scene/scene_trees\.cpp|ist/capi/guard\.(h|cpp)|viewer/engine/exports\.cpp)' "src --include=*.h --include=*.cpp"
only "printing" '(std::cout|std::cerr|fmt::print|[^f]printf\()' 'src/ist/base/assert\.h' "src/ist simd"
only "a sum whose order depends on the platform's vectors (base/ordered_vector.h has one order)" '\.(dot|norm|squaredNorm|normalized|normalize|stableNorm|inverse)\(' 'none' "src/ist/base src/ist/mesh src/ist/voxel src/ist/tree src/ist/query src/ist/measure src/ist/sweep simd"
only "what a processor or a system decides" '__x86_64__|__aarch64__|__linux__|_mm_|prctl' 'src/ist/base/platform/.*' "src/ist simd"
only "a function of libm, whose bits depend on the platform" 'std::(sin|cos|tan|asin|acos|atan2?|sinh|cosh|tanh|exp2?|log(2|10|1p)?|pow|cbrt|hypot|fma|erf|tgamma)f?\(' 'none' "src/ist/base src/ist/mesh src/ist/models src/ist/voxel src/ist/tree src/ist/query src/ist/measure src/ist/sweep simd"
only "a root of several numbers at once, whose bits depend on the processor (Eigen's is an estimate)" '\.r?sqrt\(\)' 'none' "src simd"
# Sizes rounded up to a vector's can hide it, so a test of sizes alone does not.
found=$(grep -rnE '^ +(const )?Eigen::(Isometry3|Affine3|Projective3|Transform|Matrix4|Vector4|Quaternion)[^&*()]* [a-z_]+( = [^;]*|\{[^;]*\})?;' src/ist --include='*.h' || true)
[ -z "$found" ] || breach "a member whose alignment depends on the instruction set of who includes it: $found"

twice=$(find src simd -name '*.h' -o -name '*.cpp' | xargs -n1 basename | sort | uniq -d | grep -vx 'servo_loop\.cpp' || true)
[ -z "$twice" ] || breach "two sources or headers share a name: $twice"
# Each of these exceeds a limit for the reason that HACKING.md gives beside its name.
exempt="bench scripts scripts/report tests/capi tests/cli tests/cli/occlusion tests/support tests/viewer
  docs/guarantees.md docs/python.md perf/NOTES.md perf/REPORT.md perf/STABILITY.md src/python/ist/__init__.pyi
  tests/CMakeLists.txt tests/capi/layout.c"
kind() { find "$@" -name node_modules -prune -o -type f -regextype posix-extended -regex ".*\.($kinds)" -print; }
kinds='h|cpp|c|js|mjs|py|pyi|sh'
wide=$(kind src simd bench tests scripts | sed 's/\.[a-z]*$//' | sort -u | xargs -n1 dirname | sort | uniq -c | awk '$1 > 20 {print $2 " has " $1 " units"}')
kinds="$kinds|md|cmake|txt"
long=$(kind src simd bench tests scripts docs perf ./*.md ./*.txt | grep -v '^tests/fuzz/corpus/' | xargs wc -l | awk '$2 != "total" && $1 > 400 {print $2 " has " $1 " lines"}')
for name in $exempt; do
  grep -qF "\`$name\`:" HACKING.md || breach "HACKING.md does not say why $name exceeds a limit"
  grep -qE "^$name has " <<<"$wide"$'\n'"$long" || breach "$name exceeds no limit any more: it is no exception"
done
within() { grep -vE "^($(tr -s ' \n' '|' <<<"$exempt" | sed 's/|$//')) has " <<<"$1" || true; }
found=$(within "$wide")
[ -z "$found" ] || breach "a folder of over 20 units (a header and its source are one) is several rooms: $found"
found=$(within "$long")
[ -z "$found" ] || breach "longer than 400 lines: $found"
# Sentences: subject, verb, object; the field's nouns (docs/glossary.md).
found=$(grep -rnE '\b[Ll]ikewise\b|\bis none\b|/// What\b' src simd --include='*.h' --include='*.cpp' --include='*.md' || true)
[ -z "$found" ] || breach "a sentence that leans on another one, or on a bare word: $found"
found=$(grep -rnE '//.*(\b[Ll]ikewise\b|\bis none\b|\bso many\b|\bcom(es|ing) to\b)|/// What\b' bench tests --include='*.h' --include='*.cpp' --include='*.c'
  grep -rnE '\b[Ll]ikewise\b|\bis none\b|\bso many\b|\bcom(es|ing) to\b' bench tests scripts --include='*.py' --include='*.sh' --exclude=check_house.sh || true)
[ -z "$found" ] || breach "a sentence in a foreign syntax, in a comment: $found"
found=$(grep -rnE '\b[Ll]ikewise\b|\b(is|are|was|were) none\b|\bso many\b|\b[Tt]old\b|\bcom(es|ing) to\b|\bfor who\b' \
  README.md HACKING.md CHANGELOG.md docs perf scripts --include='*.md' --include='*.py' || true)
[ -z "$found" ] || breach "a sentence in a foreign syntax (say who does what, with the field's noun): $found"
found=$(grep -rnwE 'CollisionQuery|ContactPoints?|ContactSink|TouchedLeaves|TouchSet|ChunkBoard|PromiseCheck|GapResult|WrenchGuard|promises?|promised|breach|growth|[dD]ive|run_hurried|run_until|run_within|widen|StepParts' src simd --include='*.h' --include='*.cpp' || true)
[ -z "$found" ] || breach "a word of the first version (docs/glossary.md has the new one): $found"
found=$(grep -rnoE '[ ="]/[a-zA-Z]+/[^" ]*' perf/results || true)
[ -z "$found" ] || breach "a result names a folder of the machine that it was made on: $found"
headers=$(grep -c '^ist/' src/package/public_headers.txt)
[ "$headers" -le 34 ] || breach "$headers headers are installed: 34 are the most"
exit $failed
