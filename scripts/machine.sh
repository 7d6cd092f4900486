# Sourced from the project's root: which machine this is, and what results on it are made with.
#   $model     the processor, $machine the processor and its cores as the name of a folder
#   $compiler  and $commit, which ends in + where files that are compiled are changed
#   $results   where raw results go
#   $context   of the benchmarks: each as name=value
model=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)
model=${model:-$(uname -m)}
machine=$(tr -cs 'A-Za-z0-9' '-' <<<"$model" | sed 's/-$//')-$(nproc)
compiler=$(g++ --version | head -n 1)
commit=$(git rev-parse --short HEAD 2>/dev/null || echo none)
git diff --quiet HEAD -- CMakeLists.txt CMakePresets.json src simd tests bench 2>/dev/null || commit+=+
results=perf/results/$machine
flags=$(grep -m 1 'triangle_search.cpp\.o ' build/bench/compile_commands.json 2>/dev/null |
  tr ' ' '\n' | grep -E '^-(O|f|m|std=|DNDEBUG)' | grep -v -- -prefix-map= | tr '\n' ' ' || true)
# Processors of one name differ: their family and model tell them apart.
number() { sed -n "s/^$1[[:space:]]*: //p" /proc/cpuinfo | head -n 1; }
kind=$(number 'cpu family') && kind=${kind:+ (family $kind, model $(number model))}
context=("processor=$model$kind" "compiler=$compiler" "flags=${flags% }" "commit=$commit")
