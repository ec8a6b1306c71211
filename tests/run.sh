#!/bin/sh
# sh tests/run.sh BUILD: every test that this machine can run; with $RUN, an emulator, what runs there. Prints a line
# for a suite's passed tests, every failure and every skipped test; BUILD/check.log has all. The last line counts.
cd "$(dirname "$0")/.." || exit 1
build=${1:-build} suite=programs
. tests/report.sh
log=$build/check.log
export RUN FACET_SLOW=${RUN:+1}

relight() {
    if [ -n "$RUN" ]; then
        skip "relight" "not under an emulator"
        return
    fi
    if pkg-config --exists OpenEXR 2>/dev/null; then check "relight builds" make_in "$build" "$build/relight"; fi
    program "" relight sh tests/relight.sh "$build"
}

bench() {
    if [ -n "$RUN" ]; then
        skip "bench" "not under an emulator"
        return
    fi
    check "bench builds" make_in "$build" "$build/facet-bench" "$build/baselines.tsv"
    program "" bench sh tests/bench.sh "$build"
}

# Each sanitizer has a build of its own: together, gcc takes five minutes and 5 GB for each kernel. What address looks
# for is where a group ends, which differs with the lanes and with the vectors side by side; what undefined looks for
# does not depend on either.
sanitizers() {
    suite=sanitizers
    for sanitizer in address undefined; do
        flags="-O1 -fsanitize=$sanitizer -fno-sanitize-recover=all -fno-omit-frame-pointer" arches='scalar avx2 avx512'
        [ $sanitizer = address ] || arches='scalar avx2'
        case $("$cc" -dumpmachine) in x86_64*) ;; *) arches= ;; esac
        check "$sanitizer: builds" make_in "$build/$sanitizer" CFLAGS="$flags" ${arches:+ARCHES="$arches"} \
            "$build/$sanitizer/facet-check" "$build/$sanitizer/facet-demo"
        [ $failures = 0 ] || return
        # What takes too long or too much memory is skipped; without sanitizers it is tested, or skipped by name.
        {
            program sanitizers facet-check "$build/$sanitizer/facet-check" --slow
            program sanitizers demo env FACET_SLOW=1 sh tests/demo.sh "$build/$sanitizer"
        } | grep -v '^skip '
    done
}

everything() {
    check "library and programs build" make_in "$build" all "$build/facet-check" "$build/facet-demo"
    [ $failures = 0 ] || return

    jobs_begin
    job program "" facet-check $RUN "$build/facet-check" ${RUN:+--slow}
    job program "" ops sh tests/ops.sh "$build"
    job program "" demo sh tests/demo.sh "$build"
    job relight
    job bench
    job program "" readme sh tests/readme.sh "$build"
    job program "" build sh tests/build.sh "$build"
    job program "" chart sh tests/chart.sh "$build"
    if [ -n "$RUN" ]; then skip "sanitizers" "not under an emulator"; else job sanitizers; fi
    . tests/cross.sh
    jobs_end
}

# Of what everything prints: failures and skips as they are, passed tests counted by suite.
shorten() {
    suite_shown='' passed=0
    while IFS= read -r line; do
        echo "$line" >&3
        case $line in
        "ok "*)
            line=${line#ok } line=${line%%: *}
            [ "$line" = "$suite_shown" ] || passed_line
            suite_shown=$line passed=$((passed + 1))
            ;;
        "FAIL "* | "skip "*) echo "$line" ;;
        esac
    done 3>"$log"
    passed_line
}

passed_line() {
    [ $passed = 0 ] || echo "ok $suite_shown ($passed)"
    passed=0
}

counted() {
    grep -c "^$1 " "$log"
}

{ everything; echo "that was everything"; } 2>&1 | shorten
tail -n 1 "$log" | grep -qx "that was everything" ||
    echo "FAIL programs: run to the end: stopped half-way" | tee -a "$log"
echo "$(counted ok) passed, $(counted FAIL) failed, $(counted skip) skipped" | tee -a "$log"
[ "$(counted ok)" -gt 0 ] && [ "$(counted FAIL)" = 0 ]
