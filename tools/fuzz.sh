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
count=0 failed=0
while IFS= read -r target; do
    name=${target##*/fuzz_}
    corpus=fuzz/corpus/$name
    [ -d "$corpus" ] || { echo "$name: no corpus in $corpus" && failed=1 && continue; }
    count=$((count + 1))
    echo "== $name"
    "$target" -runs=0 -artifact_prefix="$artifacts/$name-" "$corpus" </dev/null || failed=1
    [ "$seconds" -eq 0 ] && continue
    # New inputs go into a folder of their own; the committed corpus stays as it is.
    found=build/fuzz/found/$name
    mkdir -p "$found"
    "$target" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=4096 -artifact_prefix="$artifacts/$name-" \
        "$found" "$corpus" </dev/null || failed=1
done < <(find build/fuzz/fuzz -type f -name 'fuzz_*' -executable | sort)
echo "$count fuzz targets"
[ "$count" -gt 0 ] && [ "$failed" -eq 0 ]
