#!/usr/bin/env bash
# Builds the coverage preset, runs the tests and prints how much of include/ and src/ they reach; the page with the
# source lines is build/coverage/report/index.html. Needs the packages clang, libclang-rt-dev and llvm.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
cd "$repository"

step 'Configure coverage' configure coverage
step 'Build coverage' build coverage
rm -rf build/coverage/profiles
export LLVM_PROFILE_FILE=$repository/build/coverage/profiles/%p-%m.profraw
step 'Tests, coverage' ctest --preset coverage --parallel "$(jobs)" || true # what failed is in the log; the figures count all the same

find build/coverage/profiles -name '*.profraw' >build/coverage/profiles.txt
llvm-profdata merge --sparse --input-files build/coverage/profiles.txt -o build/coverage/merged.profdata
programs=()
while IFS= read -r program; do programs+=(--object "$program"); done < <(
    find build/coverage -type f -executable \( -name 'test_*' -o -name steradian \) -not -path '*/consume/*')
sources=(-instr-profile build/coverage/merged.profdata "${programs[@]}" -ignore-filename-regex '(/usr/|tests/)')
llvm-cov report "${sources[@]}"
llvm-cov show "${sources[@]}" -format=html -output-dir build/coverage/report >/dev/null
