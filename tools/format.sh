#!/usr/bin/env bash
# Whether every C++ file is formatted as .clang-format says:
#
#     tools/format.sh            names the files that are not, and fails
#     tools/format.sh --fix      formats them
#
# Needs clang-format 14 (package clang-format-14): other versions format some things differently.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

formatter=$(command -v clang-format-14 || command -v clang-format || true)
[ -n "$formatter" ] || { echo "format: clang-format is not installed (package clang-format-14)" >&2 && exit 1; }
case ${1:-} in
'') action=(--dry-run --Werror) ;;
--fix) action=(-i) ;;
*) sed -n '2,/^set /{/^set /d;s/^# \{0,1\}//;p}' "${BASH_SOURCE[0]}" >&2 && exit 2 ;;
esac

failed=0
while IFS= read -r -d '' file; do
    "$formatter" --style=file "${action[@]}" "$file" >/dev/null 2>&1 || { echo "not formatted: $file" && failed=1; }
done < <(git ls-files -z -- '*.h' '*.inl' '*.cpp')
exit "$failed"
