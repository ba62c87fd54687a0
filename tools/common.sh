# Shared by the scripts of the project; source it. Defines $repository, and the functions below.
# Every step runs with its output in a file of its own, which is shown when the step fails.

repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
logs=$repository/build/logs
mkdir -p "$logs"

# Compiling takes up to about 1.5 GB a job.
jobs() {
    local cores memory
    cores=$(nproc)
    memory=$(awk '/^MemAvailable:/ { print int($2 / 1500000) }' /proc/meminfo)
    [ "$memory" -ge 1 ] || memory=1
    echo $((cores < memory ? cores : memory))
}

log_of() { echo "$logs/$(printf '%s' "$1" | tr -c 'A-Za-z0-9\n' '-').log"; }

# step NAME COMMAND...: runs the command, prints the name, how it ended and how long it took; returns its status.
step() {
    local name=$1 log start status=0
    shift
    log=$(log_of "$name")
    start=$(date +%s)
    printf '%-60s ' "$name"
    "$@" >"$log" 2>&1 </dev/null || status=$?
    if [ "$status" -eq 0 ]; then
        printf 'ok      %4d s\n' $(($(date +%s) - start))
    else
        printf 'FAILED  %4d s (exit status %d)\n' $(($(date +%s) - start)) "$status"
        printf -- '--- the end of %s\n' "${log#"$repository"/}"
        tail -n "${STEP_LOG_LINES:-80}" "$log"
        printf -- '---\n'
    fi
    return "$status"
}

# configure PRESET [ARGUMENT...]: with ccache where it is installed.
configure() {
    local preset=$1 launcher=()
    shift
    command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
    (cd "$repository" && cmake --preset "$preset" "${launcher[@]}" "$@")
}

# build PRESET [TARGET...]
build() {
    local preset=$1 targets=()
    shift
    [ $# -eq 0 ] || targets=(--target "$@")
    (cd "$repository" && cmake --build "build/$preset" --parallel "$(jobs)" "${targets[@]}")
}
