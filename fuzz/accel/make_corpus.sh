#!/usr/bin/env bash
# Makes the committed corpus anew, after a change to what the bytes mean: of random inputs and of those that a minute of
# fuzzing finds, some that together reach everything that all of them reach, and of these the hundred smallest. Expects
# the fuzz preset to be built.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

inputs=$(mktemp -d)
trap 'rm -rf "$inputs"' EXIT
mkdir "$inputs/random" "$inputs/found" "$inputs/corpus"
python3 - "$inputs/random" <<'PYTHON'
import random, sys
random.seed(1)
for i in range(500):
    with open(f'{sys.argv[1]}/{i:04}', 'wb') as file:
        file.write(random.randbytes(random.randrange(20, 1000)))
PYTHON
fuzz=build/fuzz/fuzz/accel/fuzz_accel
"$fuzz" -max_total_time=60 -max_len=1000 -artifact_prefix="$inputs/" "$inputs/found" "$inputs/random"
"$fuzz" -set_cover_merge=1 -max_len=1000 "$inputs/corpus" "$inputs/random" "$inputs/found"
rm -f fuzz/corpus/accel/*
mkdir -p fuzz/corpus/accel
n=0
while IFS= read -r file && [ "$n" -lt 100 ]; do
    cp "$inputs/corpus/$file" "fuzz/corpus/accel/$(printf '%03d' $n)"
    n=$((n + 1))
done < <(ls -rS "$inputs/corpus")
echo "$n files"
