#!/usr/bin/env bash
# Makes a folder with the arm64 packages that a cross build needs, for cmake/toolchains/aarch64-linux-gnu.cmake:
#
#     tools/aarch64_sysroot.sh [FOLDER]        (default: build/aarch64-sysroot)
#
# Packages come from the machine's own Debian sources, by name, through a private apt state: nothing is installed, and the
# host's dpkg keeps its one architecture. The package scripts do not run. Needs apt and dpkg, but not root.
set -euo pipefail

repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
sysroot=${1:-$repository/build/aarch64-sysroot}
packages=(libc6-dev libstdc++-12-dev linux-libc-dev libtbb-dev libopenexr-dev libpng-dev libjpeg-dev libxxhash-dev
          libfmt-dev rapidjson-dev libcli11-dev libwebp-dev libmeshoptimizer-dev libdraco-dev libgtest-dev librapidcheck-dev)
stamp=$sysroot/.complete
wanted="${packages[*]}"

if [ -f "$stamp" ] && [ "$(cat "$stamp")" = "$wanted" ]; then
    echo "aarch64 sysroot: $sysroot"
    exit 0
fi
command -v apt-get >/dev/null && command -v dpkg >/dev/null || {
    echo "aarch64_sysroot: needs apt and dpkg (Debian or Ubuntu)" >&2
    exit 1
}

rm -rf "$sysroot"
mkdir -p "$sysroot"
sysroot=$(cd "$sysroot" && pwd)
state=$(mktemp -d)
trap 'rm -rf "$state"' EXIT
mkdir -p "$state"/{state/lists/partial,cache/archives/partial,log}
touch "$state/status"

# apt reads its settings from a file here because option values on the command line may not contain every character.
cat >"$state/apt.conf" <<CONF
APT::Architecture "arm64";
APT::Architectures { "arm64"; };
APT::Install-Recommends "false";
APT::Sandbox::User "";
Dir::State "$state/state";
Dir::State::status "$state/status";
Dir::Cache "$state/cache";
Dir::Log "$state/log";
Debug::NoLocking "true";
Acquire::Retries "3";
CONF
export APT_CONFIG=$state/apt.conf

echo "aarch64 sysroot: fetching package lists"
# Sources of other vendors on the host may have no arm64 packages; what counts is whether the packages are found below.
apt-get -q=2 update >"$state/update.log" 2>&1 || cat "$state/update.log" >&2
echo "aarch64 sysroot: fetching packages"
apt-get -q=2 --yes --download-only install "${packages[@]}" >"$state/download.log" 2>&1 || {
    cat "$state/download.log" >&2
    echo "aarch64_sysroot: the packages could not be fetched" >&2
    exit 1
}
for archive in "$state"/cache/archives/*.deb; do
    dpkg -x "$archive" "$sysroot"
done

# Absolute links would lead out of the sysroot, into the host's own files.
find "$sysroot" -type l -lname '/*' -print0 | while IFS= read -r -d '' link; do
    ln -sfn "$(realpath --canonicalize-missing --relative-to="$(dirname "$link")" "$sysroot$(readlink "$link")")" "$link"
done

printf '%s' "$wanted" >"$stamp"
echo "aarch64 sysroot: $sysroot"
