#!/usr/bin/env bash
# The pictures of tests/matrix, rendered by builds with both compilers, with and without optimisation, and for aarch64 under
# emulation, against the committed hashes. Needs what `tools/setup.sh all` installs.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

failed=0
for preset in gcc-O1 gcc-O3 clang-O1 clang-O3 aarch64; do
    emulator=()
    if [ "$preset" = aarch64 ]; then
        "$repository/tools/aarch64_sysroot.sh" "$repository/build/aarch64-sysroot"
        emulator=(qemu-aarch64 -L "$repository/build/aarch64-sysroot")
    fi
    echo "== $preset"
    configure "$preset" && build "$preset" steradian || { failed=1 && continue; }
    "$repository/tests/matrix/matrix.sh" "$@" "${emulator[@]}" "$repository/build/$preset/bin/steradian" || failed=1
done
exit "$failed"
