#!/usr/bin/env bash
# I script: from the wheel to ten lines of Python, and a sweep of 100,000 poses on dask, of which a worker is killed.
#
#   script.sh [--without-root] [--keep]
#
# --keep leaves the root as the door left it.
# shellcheck source=tests/doors/door.sh
source "$(dirname "$0")/door.sh"
door script "$@"
needs_here python:numpy python:venv python:dask python:distributed
passed+=(IST_DASK_POSES IST_DASK_TABLE)

wheel_made() {
  cd "$source"
  scripts/python_packages.sh || lacks "needs the wheel, and scripts/python_packages.sh makes none: $install"
  cp build/python/ist-*.whl "$walk"
}
step "the wheel, by scripts/python_packages.sh, $outside" wheel_made
installs "what a wheel takes on Debian, as docs/python.md says" "$(block docs/python.md line 'apt-get install python3-venv')"
venv=$(block docs/python.md line '-m venv')
types "an environment" "$venv"
types "the wheel, installed without a network" ". venv/bin/activate
$(block docs/python.md line 'pip install --no-index')"

ten_lines() {
  block docs/python.md block 'query = ist.Query(upper, lower) ' >"$walk/ten.py"
  typed ". venv/bin/activate && cat ten.py && python ten.py >printed"
  block docs/python.md compare 'query = ist.Query(upper, lower) ' "$walk/printed"
}
step "the ten lines of docs/python.md" ten_lines
cp "$source/src/python/README.md" "$walk"
types "the examples of the wheel's own page" ". venv/bin/activate && python -m doctest README.md && echo they hold"

installs "dask, as docs/python.md names it" "apt-get install python3-dask python3-distributed"
mkdir "$walk/engines"
cp "$source"/tests/engines/{dask_test,support}.py "$walk/engines"
export IST_DASK_POSES=100000 IST_DASK_TABLE=rows.npy
types "100,000 poses on dask, a worker killed, the table that of one process" ". venv/bin/activate
cd engines && python -B dask_test.py -v Dask.test_a_worker_is_killed_and_the_table_is_that_of_one_process"
types "the table has 100,000 rows" ". venv/bin/activate
python -c '
import ist, numpy as np
rows = np.load(\"engines/rows.npy\", mmap_mode=\"r\")
assert len(rows) == 100_000 and (rows[\"index\"] == np.arange(len(rows))).all() and (rows[\"status\"] == 0).all()
intersect = (rows[\"intersects\"] == ist.YES).mean()
assert 0 < intersect < 1
print(f\"{len(rows)} rows, {intersect:.0%} intersect\")'"
end_door
