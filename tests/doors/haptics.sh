#!/usr/bin/env bash
# I build a haptic loop: from the packages to the example of a loop, a scene of one's own, and a callback in C.
#
#   haptics.sh [--without-root] [--keep]
#
# --keep leaves the root as the door left it.
# shellcheck source=tests/doors/door.sh
source "$(dirname "$0")/door.sh"
door haptics "$@"
needs_here g++ cmake pkg-config python3
packages
installs "the packages and a compiler, as docs/building.md says" "$(block docs/building.md line ./libist-dev_)"
documents=/usr/share/doc/ist
[ "$way" = root ] || documents=$unpacked$documents

types "the examples, built as their CMakeLists.txt says" "cp -r $documents/examples . && cd examples
cmake -S . -B build && cmake --build build"
types "the example of a loop, run" "cd examples && build/loop probe.toml && build/loop probe.toml --paced"
pushes() { awk '/ N$/ {if ($1 > most) most = $1} END {print "at most " most " N"; exit !(most > 0.5)}' "$work/printed"; }
step "it pushes" pushes

# Whether a recording has forces: none before anything touches, some later.
cp "$here/forces.py" "$walk"
writes docs/haptics.md closing.toml
by_page_alone docs/haptics.md "ist run closing.toml --check"
installs "Python, to read a recording" "apt-get install python3"
types "the recording has forces" "python3 forces.py ticks.jsonl && python3 forces.py again.jsonl"
program() { block docs/haptics.md block "class MyDevice" | tee "$walk/yours.cpp"; }
step "the program of docs/haptics.md, written" program
types "the program, built as docs/building.md says" "$(block docs/building.md line 'pkg-config --cflags --libs ist_loop' | sed 's|$| -o yours|')"
types "the program, run" "./yours"

types "jaws of one's own" "ist demo --keep . >times.txt && ist build lower_jaw.stl -o lower.ist --voxel-size 0.3 --unit mm"
types "a scene of one's own, by docs/scene-reference.md" "cat >own.toml <<'end'
$(cat "$here/own.toml")
end
ist run own.toml --check && ist run own.toml --explain"
types "its run" "ist run own.toml --record own.jsonl --allow-missed 2000"
types "its recording has forces" "python3 forces.py own.jsonl"
types "its recording as a page" "ist view own.jsonl --scene own.toml -o own.html"

writes docs/c-api.md press.toml
writes docs/c-api.md hand.c
by_page docs/c-api.md "gcc -std=c11 hand.c"
end_door
