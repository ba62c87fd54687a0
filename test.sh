#!/usr/bin/env bash
# The tests, from a fresh clone: installs what is missing, builds, runs.
#
#     ./test.sh          the quick tier: all tests, and a part of them under the address and undefined-behaviour sanitizers
#     ./test.sh --all    everything: the long versions, all sanitizers, Clang, every row of the determinism matrix, fuzzing
#
# The last line is "N passed, N failed, N skipped", over everything that ran; a part that could not run counts as failed.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/tools/common.sh"

tier=quick
case ${1:-} in
'') ;;
--all) tier=all ;;
-h | --help)
    sed -n '2,/^set /{/^set /d;s/^# \{0,1\}//;p}' "${BASH_SOURCE[0]}"
    exit 0
    ;;
*)
    echo "test.sh: unknown argument '$1' (see ./test.sh --help)" >&2
    exit 2
    ;;
esac

passed=0 failed=0 skipped=0
finish() {
    local status=$?
    [ "$failed" -gt 0 ] || [ "$status" -eq 0 ] || failed=1
    echo "$passed passed, $failed failed, $skipped skipped"
    [ "$failed" -eq 0 ] || exit 1
}
trap finish EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

# A part that is not made of tests counts only when it fails.
part() {
    step "$@" && return
    failed=$((failed + 1))
    return 1
}
# A part that prints lines "N passed, N failed" of its own.
counted() {
    local status=0 good bad
    step "$@" || status=$?
    read -r good bad < <(sed -n 's/^\([0-9]*\) passed, \([0-9]*\) failed$/\1 \2/p' "$(log_of "$1")" |
        awk '{ good += $1; bad += $2 } END { print good + 0, bad + 0 }')
    if [ "$status" -ne 0 ] && [ "$bad" -eq 0 ]; then bad=1; fi # it did not get to its end
    passed=$((passed + good)) failed=$((failed + bad))
    echo "    $good passed, $bad failed"
}

# run_tests NAME PRESET [CTEST-ARGUMENT...]: runs CTest and adds up what its report says.
run_tests() {
    local name=$1 preset=$2 report=$logs/$2-report.xml status=0 total bad missed
    shift 2
    rm -f "$report"
    step "$name" ctest_in_repository --preset "$preset" --parallel "$(jobs)" --output-junit "$report" "$@" || status=$?
    count() { sed -n "s/^[[:space:]]*$1=\"\([0-9]*\)\".*/\1/p;T;q" "$report" 2>/dev/null; }
    total=$(count tests) bad=$(count failures) missed=$(($(count skipped) + $(count disabled)))
    if [ -z "$total" ] || { [ "$status" -ne 0 ] && [ "$bad" -eq 0 ]; }; then
        failed=$((failed + 1)) # CTest itself did not get to its end
    else
        passed=$((passed + total - bad - missed)) failed=$((failed + bad)) skipped=$((skipped + missed))
        echo "    $((total - bad - missed)) passed, $bad failed, $missed skipped"
    fi
}
# The thread sanitizer of GCC 12 does not cope with the address layouts of newer kernels.
without_random_addresses=()
setarch -R true 2>/dev/null && without_random_addresses=(setarch -R)
ctest_in_repository() { (cd "$repository" && "${without_random_addresses[@]}" ctest "$@"); }

quick() {
    part 'Install missing packages' "$repository/tools/setup.sh" test || return 0
    part 'Configure' configure test || return 0
    part 'Build, warnings as errors' build test || return 0
    run_tests 'Tests' test

    part 'Configure with address and undefined-behaviour checks' configure asan || return 0
    part 'Build parsers and kernels with these checks' build asan "${sanitized_quickly[@]/#/test_}" || return 0
    run_tests 'Tests of parsers and kernels with these checks' asan --tests-regex "^($(IFS='|' && echo "${sanitized_quickly[*]}"))\\."
}
# The layers that read foreign bytes, what they stand on, and the ray kernels, which look at memory in many ways.
sanitized_quickly=(base math image formats gltf meshes accel)

all() {
    part 'Install missing packages' "$repository/tools/setup.sh" all || return 0
    # The long versions once; the other compiler and the sanitizers, which slow a program down up to 20 times, run every
    # test with the quick tier's counts.
    local preset
    for preset in test test-clang asan tsan; do
        part "Configure $preset" configure "$preset" || continue
        part "Build $preset" build "$preset" || continue
        [ "$preset" = test ] && export STERADIAN_TEST_ALL=1
        run_tests "Tests, $preset" "$preset"
        unset STERADIAN_TEST_ALL
    done
    counted 'Determinism over compilers, optimisation and machines' "$repository/tools/matrix.sh"
    part 'Configure fuzz' configure fuzz && part 'Build fuzz' build fuzz && counted 'Fuzzing' "$repository/tools/fuzz.sh"
    return 0
}

"$tier"
