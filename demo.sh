#!/usr/bin/env bash
# From a fresh clone to pictures: installs what is missing, builds the program and renders the demonstration scenes into
# out/. About a minute of rendering on two cores.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/tools/common.sh"

case ${1:-} in
'') ;;
-h | --help)
    echo "usage: ./demo.sh      build Steradian and render the demonstration scenes into out/"
    exit 0
    ;;
*)
    echo "demo.sh: unknown argument '$1' (see ./demo.sh --help)" >&2
    exit 2
    ;;
esac

give_up() {
    printf 'demo: %s\n' "$1" >&2
    exit 1
}

step 'Install missing packages' "$repository/tools/setup.sh" build || give_up 'the packages could not be installed'
step 'Configure' configure release -DSTERADIAN_BUILD_TESTS=OFF || give_up 'the build could not be configured'
step 'Build' build release || give_up 'the build failed'

steradian=$repository/build/release/bin/steradian
out=$repository/out
mkdir -p "$out"

render() { # SCENE SIZE SAMPLES [ARGUMENT...]
    local scene=$1 size=$2 samples=$3
    shift 3
    step "Render $scene ($size, $samples samples a pixel)" "$steradian" render "$repository/scenes/$scene.json" \
        --size "$size" --spp "$samples" -o "$out/$scene.exr" -o "$out/$scene.png" "$@" ||
        give_up "rendering scenes/$scene.json failed"
}

render cornell_point 512x512 64
render cornell_refraction 512x512 64
render cornell_area 512x512 64
render furnace_sphere 256x256 16
render sun_sphere 512x512 32
render hero 960x540 64

printf '\nThe pictures, as PNG to look at and as EXR to work with:\n'
for picture in "$out"/*.png; do
    printf '    %s\n' "$picture"
done
printf '\nYour own scene: %s render scene.json -o picture.png\n' "$steradian"
