#!/usr/bin/env bash
# Prints the version, which project() of CMakeLists.txt has.
sed -n 's/^project(.*VERSION \([0-9.]*\).*/\1/p' "$(dirname "$0")/../CMakeLists.txt"
