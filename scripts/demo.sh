#!/usr/bin/env bash
# Sets up, builds, and runs the main job on two built-in jaws. Arguments go to `ist demo`.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh >&2
cmake --preset release >/dev/null
cmake --build --preset release >&2
exec build/release/ist demo "$@"
