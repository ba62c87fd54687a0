#!/usr/bin/env bash
# The fuzz targets: replays every committed corpus, then looks for new faults for a while:
#
#     tools/fuzz.sh [SECONDS]        (per target; default 20, 0 only replays)
#
# Expects the fuzz preset to be built. What makes a target fail is left in build/fuzz/artifacts.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
cd "$repository"

seconds=${1:-20}
artifacts=build/fuzz/artifacts
mkdir -p "$artifacts"
passed=0 failed=0
dictionary=()
fuzz() { "$target" "${dictionary[@]}" -timeout=20 -rss_limit_mb=4096 -artifact_prefix="$artifacts/$name-" "$@" </dev/null; }
while IFS= read -r target; do
    name=${target##*/fuzz_}
    corpus=fuzz/corpus/$name
    echo "== $name"
    dictionary=()
    [ -f "fuzz/dictionaries/$name" ] && dictionary=(-dict="fuzz/dictionaries/$name")
    # New inputs go into a folder of their own; the committed corpus stays as it is.
    found=build/fuzz/found/$name
    mkdir -p "$found"
    if [ -d "$corpus" ] && fuzz -runs=0 "$corpus" && { [ "$seconds" -eq 0 ] || fuzz -max_total_time="$seconds" "$found" "$corpus"; }; then
        passed=$((passed + 1))
    else
        echo "FAILED $name"
        failed=$((failed + 1))
    fi
done < <(find build/fuzz/fuzz -type f -name 'fuzz_*' -executable | sort)
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
