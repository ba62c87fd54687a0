#!/usr/bin/env bash
# Renders the cases of cases.txt in many ways and compares the pictures' hashes with golden.txt:
#
#     matrix.sh [--full] [--update] [--only NAME] COMMAND...
#
# COMMAND... runs the program: its path, or an emulator and its path. The ways: 1, 2 and 7 threads, three tile sizes, both
# builders of the hierarchy and both of its layouts (a covering part of the combinations, with --full more of them), and a
# crop against the same part of the whole picture (but not with a target for the error). --update writes the hashes of this
# run to golden.txt instead, with --only in the place of that one.
# The last line is "N passed, N failed". Needs a shell and the usual small tools only.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
full=no update=no only=
while [ $# -gt 0 ]; do
    case $1 in
    --full) full=yes ;;
    --update) update=yes ;;
    --only) only=$2 && shift ;;
    *) break ;;
    esac
    shift
done
[ $# -gt 0 ] || { sed -n '2,/^set /{/^set /d;s/^# \{0,1\}//;p}' "${BASH_SOURCE[0]}" >&2 && exit 2; }
program=("$@")
case ${STERADIAN_TEST_ALL:-0} in '' | 0) ;; *) full=yes ;; esac

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# The instruction sets that the program can use here, as it says itself when asked for one that does not exist.
isas=$({ STERADIAN_ISA=? "${program[@]}" render "$root/tests/matrix/one_of_everything.json" -o "$work/none.pfm" || true; } 2>&1 |
    sed -n 's/.*this machine has //p' | tr -d ,)
[[ $isas == *scalar* ]] || { echo "matrix.sh: the program does not say which instruction sets it has" >&2 && exit 2; }

if [ "$full" = yes ]; then
    combinations=()
    for threads in 1 2 7; do for tile in 5 16 64; do for bvh in sah median fast high-quality; do
        combinations+=("$threads $tile $bvh auto")
    done; done; done
    for isa in $isas; do combinations+=("2 16 sah $isa" "2 16 sah $isa compact" "2 16 median $isa compact"); done
else
    combinations=('1 16 sah auto' '2 5 median auto' '7 5 sah scalar' '7 16 fast auto' '2 16 high-quality auto'
                  '2 16 sah auto compact')
    for isa in $isas; do combinations+=("1 64 median $isa"); done
fi

# render OUTPUT SCENE ARGUMENT...: leaves the JSON statistics in $work/json; on failure says why and returns its status.
render() {
    local output=$1 scene=$2
    shift 2
    "${program[@]}" render "$root/$scene" "$@" --json --quiet -o "$output" >"$work/json" 2>"$work/errors" </dev/null || {
        local status=$?
        echo "    exit status $status: $*"
        sed 's/^/    /' "$work/errors"
        return "$status"
    }
}
json_text() { sed -n "s/.*\"$1\": *\"\([^\"]*\)\".*/\1/p" "$work/json" | head -n 1; }
json_number() { sed -n "s/.*\"$1\": *\([0-9][0-9]*\).*/\1/p" "$work/json" | head -n 1; }

# crop_of PFM X0 Y0 X1 Y1: that part of an RGB PFM, as a PFM (bottom row first).
crop_of() {
    local file=$1 x0=$2 y0=$3 x1=$4 y1=$5 width height header y
    read -r width height < <(sed -n 2p "$file" | tr -d '\0')
    header=$(head -n 3 "$file" | wc -c)
    printf 'PF\n%d %d\n' $((x1 - x0)) $((y1 - y0))
    sed -n 3p "$file" | tr -d '\0'
    for ((y = y1 - 1; y >= y0; --y)); do
        tail -c +$((header + 1 + ((height - 1 - y) * width + x0) * 12)) "$file" | head -c $(((x1 - x0) * 12)) || true
    done
}

# One case; prints what is wrong and returns 1, or leaves the hash in $hash.
run_case() {
    local name=$1 scene=$2 golden threads tile bvh isa layout seen most=0
    shift 2
    golden=$(sed -n "s/^$name \([0-9a-f]\{32\}\)\$/\1/p" "$here/golden.txt")
    hash=
    for combination in "${combinations[@]}"; do
        read -r threads tile bvh isa layout <<<"$combination"
        render "$work/picture.pfm" "$scene" "$@" --threads "$threads" --tile-size "$tile" --bvh "$bvh" \
            --isa "$isa" --bvh-layout "${layout:-full}" || return 1
        seen=$(json_text hash)
        [[ $seen =~ ^[0-9a-f]{32}$ ]] || { echo "    no hash in the statistics" && return 1; }
        [ -n "$hash" ] || hash=$seen
        [ "$update" = yes ] || hash=$golden
        if [ "$seen" != "$hash" ]; then
            echo "    $seen instead of ${hash:-a hash in golden.txt}: $threads threads, tile size $tile, $bvh, $isa, ${layout:-full}"
            return 1
        fi
        [ "$(json_number threads)" -le "$most" ] || most=$(json_number threads)
    done
    # Small pictures may be done before the last worker has woken up; one case is large enough and says so.
    if [ "$name" = all_threads ] && [ "$most" -ne 7 ]; then
        echo "    only $most of 7 threads took part"
        return 1
    fi
    # A crop has an error of its own, and so other samples.
    [[ " $* " != *' --target-error '* ]] || return 0
    render "$work/whole.pfm" "$scene" "$@" || return 1
    render "$work/crop.pfm" "$scene" "$@" --crop 7,5,22,18 --threads 2 --tile-size 5 || return 1
    crop_of "$work/whole.pfm" 7 5 22 18 >"$work/part.pfm"
    cmp -s "$work/part.pfm" "$work/crop.pfm" || { echo "    the crop differs from the whole picture" && return 1; }
}

passed=0 failed=0
: >"$work/golden"
while read -r name scene options; do
    [[ $name != '' && $name != \#* ]] || continue
    [ -z "$only" ] || [ "$only" = "$name" ] || continue
    read -ra options <<<"$options"
    if message=$(run_case "$name" "$scene" "${options[@]}" && echo "$name $hash" >>"$work/golden"); then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        printf 'FAILED %s\n%s\n' "$name" "$message"
    fi
done <"$here/cases.txt"
if [ "$update" = yes ] && [ "$failed" -eq 0 ]; then
    if [ -z "$only" ]; then cp "$work/golden" "$here/golden.txt"; else sed -i "s/^$only .*/$(cat "$work/golden")/" "$here/golden.txt"; fi
fi
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
