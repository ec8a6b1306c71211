# What the test scripts share: how a test reports, and how jobs run side by side. Sourced at the top of the tree, with
# $suite and $build, the build directory, set.

make=${MAKE:-make} cc=${CC:-cc}
unset MAKE MAKEFLAGS MFLAGS MAKELEVEL
processors=$(nproc 2>/dev/null || echo 1)
failures=0
mkdir -p "$build/tests"

fail() {
    echo "FAIL $suite: $1: $2"
    failures=$((failures + 1))
}

skip() {
    echo "skip $suite: $1: $2"
}

# check NAME FUNCTION WORD...: a test. It fails where a command of the function fails; what was printed says why.
check() {
    check_name=$1
    shift
    why=$(set -e; "$@" 2>&1 </dev/null)
    status=$?
    if [ $status = 0 ]; then
        echo "ok $suite: $check_name"
    else
        fail "$check_name" "$(echo "${why:-exit status $status}" | tail -n 3 | paste -sd' ' | cut -c 1-400)"
    fi
}

# none WHAT LIST: fails where the list is not empty.
none() {
    [ -z "$2" ] || { echo "$1:" $2; return 1; }
}

have() {
    command -v "$1" >/dev/null 2>&1
}

# make_in DIR WORD...: builds in DIR.
make_in() {
    make_dir=$1
    shift
    "$make" -s -j"$processors" BUILD="$make_dir" "$@"
}

# program LABEL NAME COMMAND...: a test program or script; LABEL goes before its suites. To die is to fail, and so is
# to test nothing.
program() {
    label=${1:+$1 } program_name=$2
    shift 2
    log=$(mktemp "$build/tests/log.XXXXXX") started=$(date +%s)
    "$@" >"$log" 2>&1 </dev/null
    status=$?
    sed -E "s/^(ok|FAIL|skip) /&$label/" "$log"

    why=
    if [ $status -gt 128 ]; then
        why="died of signal $((status - 128))"
    elif [ $status != 0 ] && ! grep -q '^FAIL ' "$log"; then
        why="exit status $status"
    elif ! grep -qE '^(ok|FAIL|skip) ' "$log"; then
        why="tested nothing"
    fi
    [ -z "$why" ] || echo "FAIL $label$program_name: runs: $why; it said last: $(tail -n 1 "$log" | cut -c 1-200)"
    [ $status = 0 ] && [ -z "$why" ] || failures=$((failures + 1))
    rm -f "$log"
    echo "$label$program_name took $(($(date +%s) - started)) s"
}

# jobs_begin; job FUNCTION WORD...; jobs_end: as many side by side as there are processors; each one's output stays in
# one piece, in the order of the calls.
jobs_begin() {
    jobs_dir=$(mktemp -d "$build/tests/jobs.XXXXXX")
    mkfifo "$jobs_dir/slots"
    exec 9<>"$jobs_dir/slots"
    for slot in $(seq "$processors"); do echo "$slot" >&9; done
    jobs_begun=0 jobs_shown=0
    trap 'trap - INT; kill 0' INT
}

job() {
    read -r slot <&9
    jobs_show
    jobs_begun=$((jobs_begun + 1))
    (
        trap - INT
        failures=0
        "$@" >"$jobs_dir/$jobs_begun" 2>&1
        echo $failures >"$jobs_dir/$jobs_begun.failures"
        echo "$slot" >&9
    ) &
    eval "job_$jobs_begun=$!"
}

# Shows the jobs that have ended, up to the first that has not.
jobs_show() {
    while [ -s "$jobs_dir/$((jobs_shown + 1)).failures" ]; do
        jobs_shown=$((jobs_shown + 1))
        cat "$jobs_dir/$jobs_shown"
        failures=$((failures + $(cat "$jobs_dir/$jobs_shown.failures")))
    done
}

jobs_end() {
    while [ $jobs_shown -lt $jobs_begun ]; do
        eval "wait \$job_$((jobs_shown + 1))"
        [ -s "$jobs_dir/$((jobs_shown + 1)).failures" ] || { fail "job $((jobs_shown + 1))" "was killed"; break; }
        jobs_show
    done
    exec 9>&-
    rm -rf "$jobs_dir"
}
