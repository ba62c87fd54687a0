#!/usr/bin/env bash
# Installs what is missing for a purpose, by package name:
#
#     tools/setup.sh build     to build the program
#     tools/setup.sh test      and the quick tests
#     tools/setup.sh all       and everything that ./test.sh --all does
#
# On Debian and Ubuntu with apt, and with sudo when not root; elsewhere it says what is needed. Installs nothing when
# everything is there, and then needs no network and no rights.
set -euo pipefail

build_packages=(g++ cmake ninja-build libtbb-dev libopenexr-dev libpng-dev libjpeg-dev libxxhash-dev libfmt-dev
                rapidjson-dev libcli11-dev libwebp-dev libmeshoptimizer-dev libdraco-dev)
test_packages=(libgtest-dev)
all_packages=(clang libclang-rt-dev llvm qemu-user g++-aarch64-linux-gnu)

purpose=${1:-build}
case $purpose in
build) packages=("${build_packages[@]}") ;;
test) packages=("${build_packages[@]}" "${test_packages[@]}") ;;
all) packages=("${build_packages[@]}" "${test_packages[@]}" "${all_packages[@]}") ;;
*)
    echo "usage: tools/setup.sh [build|test|all]" >&2
    exit 2
    ;;
esac

fail() {
    printf 'setup: %s\n' "$@" >&2
    exit 1
}

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
    for tool in cmake ninja; do
        command -v "$tool" >/dev/null && continue
        fail "this is not Debian or Ubuntu, so nothing is installed by itself, and '$tool' is missing." \
            "Steradian needs a C++20 compiler (g++ 12 or clang 14, or newer), CMake 3.25, Ninja, and the libraries" \
            "oneTBB 2021, OpenEXR 3, libpng, libjpeg-turbo, libwebp, meshoptimizer, Draco 1.5, xxHash, fmt 9, RapidJSON" \
            "and CLI11 2 with their headers;" \
            "for the tests GoogleTest. On Debian these are: ${packages[*]}"
    done
    exit 0
fi

missing=()
for package in "${packages[@]}"; do
    status=$(dpkg-query --show --showformat='${db:Status-Abbrev}' "$package" 2>/dev/null || true)
    [[ $status == ?i* ]] || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null ||
        fail "these packages are missing: ${missing[*]}" "Neither root nor sudo is at hand. As root, run:" \
            "    apt-get update && apt-get install --no-install-recommends ${missing[*]}"
    as_root=(sudo)
    [ -t 0 ] || as_root+=(--non-interactive)
fi

apt() {
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o Acquire::Retries=3 \
        -o DPkg::Lock::Timeout=300 "$@" </dev/null
}
install_missing() { apt install --no-install-recommends "${missing[@]}"; }

echo "setup: installing ${missing[*]}"
# Lists that are missing or stale are the usual reason for a failure, so fetch them only then, and try once more.
if ! apt-cache show "${missing[@]}" >/dev/null 2>&1 || ! install_missing; then
    apt update || fail "apt-get update failed; is there a network?"
    install_missing || fail "apt-get could not install: ${missing[*]}"
fi
