#!/bin/sh
# sh tests/cross.sh BUILD: the same results elsewhere: on other architectures (emulated), from other compilers and
# optimisation levels, on older CPUs. tests/run.sh reads this file to run it among its own jobs.
alone=
if [ "${0##*/}" = cross.sh ]; then
    cd "$(dirname "$0")/.." || exit 1
    alone=1 build=${1:-build}
    . tests/report.sh
    jobs_begin
fi
suite=cross

# compiles LABEL DIR WORD...: what `make WORD...` builds compiles without a warning.
compiles() {
    suite="$1 build" dir=$2
    shift 2
    check "no warnings" make_in "$dir" "$@"
    [ $failures = 0 ]
}

# emulated LABEL TRIPLET EMULATOR PACKAGES SUITE...: these suites or all, in a static program.
emulated() {
    label=$1 compiler=$2-gcc emulator=$3 packages=$4 dir=$build/cross/$1
    shift 4
    if ! have "$emulator"; then
        skip "$label" "no $emulator (package qemu-user)"
    elif ! echo 'int main(void) { return 0; }' | "$compiler" -static -x c -o "$build/tests/$label" - 2>/dev/null; then
        skip "$label" "no $compiler that links (packages $packages)"
    else
        compiles "$label" "$dir" CC="$compiler" CFLAGS='-O2 -Werror' LDFLAGS=-static "$dir/facet-check" &&
            program "$label" facet-check "$emulator" "$dir/facet-check" --slow "$@"
    fi
}

# compiled COMPILER LEVEL ARCH...: everything compiles without a warning; strict results are the committed ones.
compiled() {
    compiler=$1 level=$2
    shift 2
    dir=$build/cross/$compiler$level
    compiles "$compiler $level" "$dir" CC="$compiler" CFLAGS="$level -Werror" ARCHES="$*" \
        all "$dir/facet-check" "$dir/facet-demo" "$dir/facet-bench" &&
        program "$compiler $level" facet-check "$dir/facet-check" --slow golden conversions metals
}

# The scalar kernel over vectors of one lane, where a cast or a comparison meant for floats does not compile.
linted() {
    dir=$build/cross/lint-$1
    compiles "lint $1" "$dir" CC="$1" CFLAGS='-O2 -Werror' HEADER.scalar=../tests/lint.h ARCHES=scalar \
        "$dir/facet-check" &&
        program "lint $1" facet-check "$dir/facet-check" --slow golden conversions metals
}

# old_cpu MODEL ARCH...: runs these architectures and refuses the others, without an illegal instruction.
old_cpu() {
    model=$1 suite="$1 agreement"
    shift
    check "runs $*, no other" offers "$model" "$*"
    # What the model lacks is skipped as it should be.
    program "$model" facet-check qemu-x86_64 -cpu "$model" "$build/facet-check" --slow agreement | grep -v '^skip '
}

offers() {
    offered=$(qemu-x86_64 -cpu "$1" "$build/facet-demo" --list 2>/dev/null |
        awk '$1 == "arch" && $2 != "best" && $3 == "available:" { print $2 }')
    [ "$(echo $offered)" = "$2" ] || { echo "has $offered"; return 1; }
}

with_compiler() {
    if have "$2"; then job "$@"; else job skip "$*" "no $2 (package $2)"; fi
}

cross_jobs() {
    job emulated aarch64 aarch64-linux-gnu   qemu-aarch64 "gcc-aarch64-linux-gnu libc6-dev-arm64-cross"
    # Scalar alone, and that has the bytes of x86 where it does not fuse, of aarch64 where it does: how exact it is is
    # measured there.
    bytes="ops elementary fits api encode conversions metals stability agreement packed golden environment"
    job emulated armv7   arm-linux-gnueabihf qemu-arm     "gcc-arm-linux-gnueabihf libc6-dev-armhf-cross" $bytes
    job emulated s390x   s390x-linux-gnu     qemu-s390x   "gcc-s390x-linux-gnu libc6-dev-s390x-cross" $bytes
    job emulated riscv64 riscv64-linux-gnu   qemu-riscv64 "gcc-riscv64-linux-gnu libc6-dev-riscv64-cross" $bytes

    # Each compiler has every architecture once, each level a gcc and a clang; what else there is, is built by gcc-12 at
    # -O3.
    case $("$cc" -dumpmachine) in
    x86_64*) some="scalar sse41 avx2" others="sse2 avx512" ;;
    aarch64*) some=scalar others=neon ;;
    *) some=scalar others=scalar ;;
    esac
    with_compiler compiled gcc-12 -O0 $some
    with_compiler compiled gcc-12 -O2 $others
    with_compiler compiled gcc-11 -O1 $others
    with_compiler compiled gcc-11 -O3 $some
    with_compiler compiled clang-14 -O0 $others
    with_compiler compiled clang-14 -O3 $some
    with_compiler compiled clang-19 -O1 $some
    with_compiler compiled clang-19 -O2 $others
    with_compiler linted gcc-12
    with_compiler linted clang-19

    case $("$cc" -dumpmachine) in x86_64*) ;; *) job skip "old CPUs" "the machine is no x86_64"; return ;; esac
    if ! have qemu-x86_64; then job skip "old CPUs" "no qemu-x86_64 (package qemu-user)"; return; fi
    job old_cpu Conroe      scalar sse2
    job old_cpu Penryn      scalar sse2 sse41
    job old_cpu SandyBridge scalar sse2 sse41
    job old_cpu Haswell     scalar sse2 sse41 avx2
}

if [ -n "${RUN:-}" ]; then
    job skip "everything" "not under an emulator"
else
    cross_jobs
fi

if [ -n "$alone" ]; then
    jobs_end
    exit $((failures > 0))
fi
