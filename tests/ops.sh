#!/bin/sh
# sh tests/ops.sh BUILD: compares the vector layers with tests/ops.def. Every header defines every operation of the list
# and no other vf_ or vm_ function; what it has besides is its own, and the library does not use it. So an operation
# without a test is not possible; nor is a function of src/elementary.tmpl.h that tests/elementary.c does not measure.
cd "$(dirname "$0")/.." || exit 1
build=${1:-build} suite=ops
. tests/report.sh
listed=$build/tests/ops.listed
found=$build/tests/ops.found

# Names that stand on one side alone, as "-name" where the list has them and "+name" where it has not.
differences() {
    comm -23 "$listed" "$found" | sed 's/^/-/'
    comm -13 "$listed" "$found" | sed 's/^/+/'
}

listed_once() {
    none "twice in tests/ops.def" "$(uniq -d "$listed")"
    [ -s "$listed" ]
}

# A header, and the vector layer that it includes.
header_files() {
    echo "$1" $(sed -nE 's|^#include "(.*\.h)"|arch/\1|p' "$1")
}

# The functions of files.
defined() {
    sed -nE 's/^OP [^(]*[ *]([A-Za-z0-9_]*)\(.*/\1/p' "$@" | sort -u
}

defines_all() {
    defined $(header_files "$1") | grep -E '^v[fm]_' >"$found"
    none "- not here, + not in tests/ops.def" "$(differences)"
    none "hidden from the comparison" "$(grep -nE '^(static|inline)|^OP [^(]*$|^#define v[fm]_' $(header_files "$1"))"
}

uses_listed() {
    cat src/*.tmpl.h src/*.c | grep -oE '\<v[fm]_[a-z0-9_]+' | sort -u >"$found"
    none "not in tests/ops.def" "$(comm -13 "$listed" "$found")"
    cat src/*.tmpl.h src/*.c | grep -oE '\<[A-Za-z0-9_]+\(' | tr -d '(' | sort -u >"$found"
    none "a header's own" "$(defined arch/*.h tests/lint.h | comm -23 - "$listed" | comm -12 - "$found")"
}

measures_all() {
    sed -nE 's/^ *(ONE|TWO)\(([a-z0-9_]*),.*/\2/p' tests/elementary.h | sort >"$listed"
    defined src/elementary.tmpl.h | grep -vx -e splat -e square >"$found"
    none "- not in src/elementary.tmpl.h, + not in tests/elementary.h" "$(differences)"
    [ -s "$listed" ]
}

# What takes no operands has no outcome and no row: a row's shape calls it.
{
    sed -nE 's/^(OPERATION|MOVE|FUSABLE|NEAR|LOOSE)\((v[fm]_[a-z0-9_]*),.*/\2/p' tests/ops.def
    sed -nE 's/^    (v[fm]_[a-z0-9_]*)\(\);$/\1/p' tests/ops_arch.c
} | sort >"$listed"
check "tests/ops.def lists every operation once" listed_once
for header in arch/*.h tests/lint.h; do
    case $header in arch/environment.h | arch/op.h) continue ;; esac
    check "$header defines the operations of tests/ops.def" defines_all "$header"
done
check "src uses operations of tests/ops.def alone" uses_listed
check "tests/elementary.h lists every function of src/elementary.tmpl.h" measures_all
[ $failures = 0 ]
