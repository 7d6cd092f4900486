#!/usr/bin/env bash
# Checks the order of the rooms: includes go one way, one file includes each dependency, and code whose bits count uses no
# function that differs between platforms. It prints each breach, and fails if there is one.
set -euo pipefail
cd "$(dirname "$0")/.."
failed=0
library="src/ist src/c src/loop src/models src/sweep simd"
breach() { echo "$*" >&2; failed=1; }
never() {  # a breach, its pattern, folders, and a pattern of allowed lines
  local found
  found=$(grep -rnE "$2" $3 | grep -vE "${4:-^$}" || true)
  [ -z "$found" ] || breach "$1: $found"
}

# Folders are layers. Each includes those before it: its folder, and the names by which others include it.
layers=(base mesh voxel tree simd query constraint measure c models haptics scene sweep)
folder() {
  case $1 in
    simd) echo simd ;; c | models | sweep) echo "src/$1" ;;
    haptics) echo src/loop/haptics src/loop/include/ist/haptics ;; scene) echo src/loop/scene src/loop/include/ist/scene.h ;;
    *) echo "src/ist/$1" ;;
  esac
}
name() {
  case $1 in
    simd) echo simd/ ;; c) echo "c/|ist/capi/" ;; models | sweep) echo "$1/|ist/$1/" ;;
    haptics | scene) echo "loop/$1/|ist/$1[/.]" ;; *) echo "ist/$1/" ;;
  esac
}
for i in "${!layers[@]}"; do
  for later in "${layers[@]:i+1}"; do
    never "${layers[i]} includes $later, which stands after it" "#include \"($(name "$later"))" "$(folder "${layers[i]}")" '^src/c/ist_c_(models|servo|sweep)\.cpp'
  done
done
# Headers for users include several layers. Angle brackets and paths upwards would hide a layer.
never "a layer includes a header of users" '#include "ist/(ist|measure|haptics|scene)\.h"' "$library" '^src/(ist/(ist|measure)\.h|loop/(include|scene)/|c/)'
never "an include that hides its layer" '#include (<(ist|simd)/|"\.\./)' "$library src/answers src/cli src/verify src/advise"
never "tools know the library, not each other" '#include "(answers|cli|advise)/' "src/verify src/hardware"
never "tools know the library, not each other" '#include "(answers|cli|verify)/' src/advise
never "the answers include neither the command nor the page" '#include "(cli|viewer)/' src/answers
never "the page does not include the command" '#include "cli/' src/viewer
never "the library sees no tool" '#include "(answers|cli|import|verify|advise|hardware)/|#include "ist/hardware/' "$library"
never "only the page includes the page" '#include "viewer/' "src simd" '^src/viewer/'
never "hardware includes more than base, mesh, voxel and tree" '#include "ist/' src/hardware '"ist/(base|mesh|voxel|tree|hardware)/'
never "vector code is for simd/ alone" '#include "simd/[a-z_]+-inl\.h"' src

only() {  # a thing, its pattern, a pattern of the one file, folders
  local found
  found=$(grep -rlE "$2" $4 | grep -vxE "$3" || true)
  [ -z "$found" ] || breach "$1 is also in: $found"
}
only "assimp, which may crash," '#include [<"]assimp/' 'src/import/[a-z_]+\.(h|cpp)' "src simd bench"
only "libzip, pugixml and libseccomp" '#include [<"](zip|pugixml|seccomp)\.h' 'src/import/[a-z_]+\.cpp' "src simd"
only "TBB" '#include [<"](tbb|oneapi)/' 'src/ist/base/platform/tbb_ranges\.cpp' "src simd"
only "Highway" '#include [<"]hwy/' 'simd/([a-z]+/)?[a-z_]+(\.cpp|-inl\.h)' "src simd tests bench"
only "toml++" '#include [<"]toml' 'src/loop/scene/toml_document\.cpp' "src simd tests bench"
only "GMP, an oracle of tests," '#include [<"]gmp' 'none' "src simd"
only "xxHash" '#include [<"]xxh' 'src/(ist/base/checksum|hardware/xxh64)\.(h|cpp)' "src simd"
only "zlib" '#include [<"]zlib' 'src/ist/mesh/format/inflate\.cpp' "src simd"
only "cairo" '#include [<"]cairo' 'src/cli/occlusion/figure/canvas\.cpp' "src simd"
only "JSON" '#include [<"]nlohmann/' 'src/(answers/.*|cli/.*|viewer/engine/.*|import/gltf_check\.cpp|sweep/sweep_record\.cpp)' src
only "the command line" '#include [<"]CLI/' 'src/cli/.*' src
only "a catch" '(^|[^[:alnum:]_])catch \(' 'src/(cli/main\.cpp|import/ist_import\.cpp|ist/base/platform/thread_ranges\.cpp|loop/scene/scene_trees\.cpp|sweep/sweep_body\.cpp|c/guard\.(h|cpp)|viewer/engine/exports\.cpp)' "src --include=*.h --include=*.cpp"
only "printing" '(std::cout|std::cerr|fmt::print|[^f]printf\()' 'src/ist/base/assert\.h' "$library src/answers"
only "a sum whose order depends on the platform's vectors (base/ordered_vector.h has one order)" '\.(dot|norm|squaredNorm|normalized|normalize|stableNorm|inverse)\(' 'none' "src/ist/base src/ist/mesh src/ist/voxel src/ist/tree src/ist/query src/ist/constraint src/ist/measure src/sweep simd"
only "what a processor or a system decides" '__x86_64__|__aarch64__|__linux__|_mm_|prctl' 'src/ist/base/platform/.*' "$library"
only "a function of libm, whose bits depend on the platform" 'std::(sin|cos|tan|asin|acos|atan2?|sinh|cosh|tanh|exp2?|log(2|10|1p)?|pow|cbrt|hypot|fma|erf|tgamma)f?\(' 'none' "src/ist/base src/ist/mesh src/models src/ist/voxel src/ist/tree src/ist/query src/ist/constraint src/ist/measure src/sweep simd"
only "a root of several numbers at once, whose bits depend on the processor (Eigen's is an estimate)" '\.r?sqrt\(\)' 'none' "src simd"
# A test of sizes alone does not show it: padding can hide the difference.
never "a member whose alignment depends on the instruction set of who includes it" '^ +(const )?Eigen::(Isometry3|Affine3|Projective3|Transform|Matrix4|Vector4|Quaternion)[^&*()]* [a-z_]+( = [^;]*|\{[^;]*\})?;' "$library --include=*.h"

twice=$(find src simd -name '*.h' -o -name '*.cpp' | xargs -n1 basename | sort | uniq -d)
[ -z "$twice" ] || breach "two sources or headers share a name: $twice"
never "a result names a folder of the machine that it was made on" '[ ="]/[a-zA-Z]+/[^" ]*' perf/results
headers=$(($(grep -c '^ist/' src/package/public_headers.txt) + $(find src/{c,loop,models}/include -name '*.h' | wc -l)))
[ "$headers" -le 38 ] || breach "$headers headers are installed: 38 are the most"
exit $failed
