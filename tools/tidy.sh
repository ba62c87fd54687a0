#!/usr/bin/env bash
# clang-tidy over the sources that the dev preset compiles:
#
#     tools/tidy.sh [FILE...]        (default: everything in src, apps and examples)
#
# Needs the packages clang-tidy and, to configure, those of `tools/setup.sh test`.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
cd "$repository"

command -v clang-tidy >/dev/null || { echo "tidy: clang-tidy is not installed (package clang-tidy)" >&2 && exit 1; }
[ -f build/dev/compile_commands.json ] || configure dev >/dev/null
if [ $# -gt 0 ]; then printf '%s\0' "$@"; else git ls-files -z -- 'src/*.cpp' 'apps/*.cpp' 'examples/*.cpp'; fi |
    xargs -0 -n 1 -P "$(jobs)" clang-tidy -p build/dev --quiet
