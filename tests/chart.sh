#!/bin/sh
# sh tests/chart.sh BUILD: facet-chart and model-errors: what is drawn of a small file, what is refused.
cd "$(dirname "$0")/.." || exit 1
build=${1:-build} suite=chart
. tests/report.sh
if [ -n "${RUN:-}" ]; then
    skip "everything" "not under an emulator"
    exit 0
fi
work=$build/tests/chart
rm -rf "$work"
mkdir -p "$work"
charts='rounding models kernels arches failures'

# ---- What is drawn ---------------------------------------------------------------------------------------------------

# Lines with tabs for spaces: numbers that were made up. head CPU COMPILER; row CASE TIER ARCH NS X_LITERAL ERROR P999.
head_lines() {
    printf '# facet-bench\t1\n# date\t2026-01-01\n# cpu\t%s\n# compiler\t%s\n# command\tmade up\n' "$1" "$2"
    printf 'peak\tfma_512\t1.2e11\tlanes/s\n'
}

row() {
    printf 'kernel\t%s\t%s\t%s\t256\tstaggered\t%s\t0.01\t-\t64\t%s\t-\t-\t-\t-\t%s\t%s\n' "$@"
}

# What a machine with two architectures may have measured, FACTOR times as slow.
made_up() {
    head_lines "$1" "$2"
    for workload in tile frame; do
        row $workload baseline literal $((900 * $3)) 1 inf 1e-5
        row $workload baseline clang-256 $((9 * $3)) 100 0.02 1e-5
    done
    slowness=1
    for kernel in tile frame lambert oren-nayar oren-nayar-full ggx/smith-correlated/schlick \
        ggx/smith-correlated/schlick-f82 ggx/smith-correlated/conductor packed; do
        slowness=$((slowness + 1))
        for tier in fast strict; do
            row $kernel $tier scalar $((20 * slowness * $3)) - 2e-4 1e-5
            row $kernel $tier avx2 $((4 * slowness * $3)) 50 2.5e-4 -
        done
    done
    row unknown fast avx2 3 - - -
}

draw() {
    mkdir -p "$1"
    "$build/facet-chart" --errors "$work/errors.tsv" -o "$@"
}

computes_errors() {
    "$build/model-errors" >"$work/errors.tsv"
    "$build/model-errors" | cmp - "$work/errors.tsv"
    [ "$(grep -c '^ladder' "$work/errors.tsv")" = 2 ]
    [ "$(grep -c '^panel' "$work/errors.tsv")" = 4 ]
    none "no numbers" "$(grep -E '^(model|point)' "$work/errors.tsv" | grep -iE 'nan|inf')"
}

draws() {
    made_up "one machine" "a compiler" 1 >"$work/a.tsv"
    draw "$work/one" "$work/a.tsv"
    for chart in $charts; do
        [ -s "$work/one/$chart.svg" ]
        [ -s "$work/one/$chart-narrow.svg" ]
    done
    [ -s "$work/one/index.html" ]
}

# marked CHART PATTERN: the rows that match, in the chart for wide screens and in that for narrow ones.
marked() {
    grep '^kernel' "$work/a.tsv" | cut -f 2-4 | tr '\t' ' ' | grep -E "$2" | sort >"$work/rows"
    [ -s "$work/rows" ]
    for ending in .svg -narrow.svg; do
        sed -n 's/.* data-of="\([^"]*\)".*/\1/p' "$work/one/$1$ending" | sort -u >"$work/marks"
        none "without a mark in $1" "$(comm -23 "$work/rows" "$work/marks")"
    done
}

marks_all() {
    marked rounding '^tile '
    marked kernels ' (fast|strict) '
    marked arches '^(tile|frame|packed) '
    marked models '^(lambert|oren-nayar|oren-nayar-full|ggx/smith-correlated/.*) '
}

tabulates_all() {
    [ "$(grep -c '<td class="w">staggered</td>' "$work/one/index.html")" = "$(grep -c '^kernel' "$work/a.tsv")" ]
}

stands_alone() {
    none "from elsewhere" "$(grep -ohE '(https?:)?//[a-z][^" <]*|(src|href)=|@import|url\(' "$1"/*.svg "$1/index.html" |
        grep -vx 'http://www.w3.org/2000/svg')"
    for file in "$1"/*.svg; do
        grep -q '<svg [^>]*xmlns="http://www.w3.org/2000/svg"' "$file"
        grep -q '<title>' "$file"
        grep -q 'prefers-color-scheme:dark' "$file"
    done
}

well_formed() {
    xmllint --noout "$1"/*.svg
    sed -n '/^<svg/,/^<\/svg>/p' "$1/index.html" | { echo '<page>'; cat; echo '</page>'; } | xmllint --noout -
}

says_it() {
    grep -q 'avx2 fast: 50 times as fast as the textbook' "$work/one/rounding.svg"
    grep -q '2026-01-01 · one machine · a compiler · made up' "$work/one/rounding.svg"
    grep -q 'Lambert is 1.5 times as fast as' "$work/one/models.svg"
    grep -q 'NaN or infinite' "$work/one/rounding.svg"
    grep -q 'error not known' "$work/one/kernels.svg"
}

# Two that differ in the compiler alone, and one of another CPU.
merges() {
    made_up "one machine" "another compiler" 2 >"$work/b.tsv"
    made_up "second machine" "a compiler" 3 >"$work/c.tsv"
    draw "$work/three" "$work/a.tsv" "$work/b.tsv" "$work/c.tsv"
    for name in 'one machine, a compiler' 'one machine, another compiler' 'second machine'; do
        for chart in rounding models kernels arches; do grep -q ">$name<" "$work/three/$chart.svg"; done
        grep -q "Speeds and errors: $name" "$work/three/index.html"
    done
}

same_again() {
    draw "$work/again" "$work/a.tsv"
    for file in "$work"/one/*; do cmp "$file" "$work/again/$(basename "$file")"; done
}

# Of sizes and layouts one is drawn; all are in the table.
one_of_sizes() {
    {
        head_lines a b
        row tile fast avx2 1 - 1e-4 - | sed 's/256/16/'
        row tile fast avx2 2 - 1e-4 - | sed 's/staggered/aligned/'
        row tile fast avx2 3 - 1e-4 -
        row tile fast avx2 4 - 1e-4 - | sed 's/256/4096/'
    } >"$work/sizes.tsv"
    draw "$work/sizes" "$work/sizes.tsv"
    [ "$(grep -c 'data-of="tile fast avx2"' "$work/sizes/rounding.svg")" = 1 ]
    grep -q '3 ns a sample' "$work/sizes/rounding.svg"
    [ "$(grep -c '<td class="w">tile</td>' "$work/sizes/index.html")" = 4 ]
}

# A file without errors, baselines and workloads; line ends of another system.
little() {
    mkdir -p "$work/little"
    { head_lines little none; row lambert fast scalar 3 - - -; } | sed 's/$/\r/' >"$work/little.tsv"
    "$build/facet-chart" -o "$work/little" "$work/little.tsv"
    grep -q 'data-of="lambert fast scalar"' "$work/little/rounding.svg"
}

# Words that mean something in XML, and bytes that mean nothing.
escapes() {
    { head_lines "$(printf '<b>"&\377\300\257\001')" ']]>'; row "<'\"&>" fast 'a<b' 3 - 1e-4 -; } >"$work/odd.tsv"
    draw "$work/odd" "$work/odd.tsv"
    grep -q '&lt;b&gt;&quot;&amp;????' "$work/odd/rounding.svg"
}

check "builds" make_in "$build" "$build/facet-chart" "$build/model-errors"
[ $failures = 0 ] || exit 1
check "model-errors prints the same numbers again" computes_errors
check "draws every chart, wide and narrow, and a page" draws
check "every row has a mark" marks_all
check "every row is in the page's table" tabulates_all
check "nothing comes from elsewhere" stands_alone "$work/one"
check "titles, bands and sources say what the numbers say" says_it
check "several machines, with a name each" merges
check "the same input gives the same bytes" same_again
check "of sizes and layouts, 256 samples, staggered" one_of_sizes
check "a file with one kernel" little
check "odd words and bytes" escapes
if have xmllint; then
    for directory in one three little odd; do check "well-formed: $directory" well_formed "$work/$directory"; done
else
    skip "well-formed" "no xmllint (package libxml2-utils)"
fi

# ---- What is refused -------------------------------------------------------------------------------------------------

# refused NAME PATTERN FILE: exit status 2, one line on stderr that matches, and nothing is drawn.
refused() {
    rm -rf "$work/refused"
    mkdir -p "$work/refused"
    status=0
    "$build/facet-chart" -o "$work/refused" "$2" >"$work/out" 2>"$work/err" || status=$?
    [ $status = 2 ] || { echo "exit status $status"; return 1; }
    grep -q "^facet-chart: .*$1" "$work/err" || { cat "$work/err"; return 1; }
    [ "$(wc -l <"$work/err")" = 1 ]
    none "drawn" "$(ls "$work/refused")"
}

# bad NAME PATTERN LINE: after a good head.
bad() {
    { head_lines a b; printf "$3\n"; } >"$work/$1.tsv"
    check "refuses: $1" refused "$1.tsv:$2" "$work/$1.tsv"
}

good='kernel\ttile\tfast\tavx2\t256\tstaggered\t3\t0.01\t-\t64\t-\t-\t-\t-\t-\t2e-4\t1e-5'
changed() { printf '%s\n' "$good" | sed "$1"; }

bad unknown-line "7: 'core' is neither" 'core\ttile'
bad few-fields '7: 16 fields, not 17' "$(changed 's/.t1e-5//')"
bad many-fields '7: 18 fields, not 17' "$good\t1"
bad far-too-many '7: more than 24 fields' "$good\t1\t1\t1\t1\t1\t1\t1\t1"
bad tier "7: the tier is 'quick'" "$(changed s/fast/quick/)"
bad no-time '7: no time' "$(changed 's/t3/t-/')"
bad time "7: ns is '3x'" "$(changed 's/t3/t3x/')"
bad zero-time "7: ns is '0'" "$(changed 's/t3/t0/')"
bad size "7: the size is '2k'" "$(changed 's/256/2k/')"
bad negative "7: the error is '-2e-4'" "$(changed 's/2e-4/-2e-4/')"
bad empty-word '7: field 2 is empty' "$(changed s/tile//)"
bad long-word '7: field 2 is longer' "$(changed "s/tile/$(printf 'x%.0s' $(seq 201))/")"
bad second-line '8: 1 fields, not 17' "$good\nkernel"

printf '# facet-bench\t2\n' >"$work/format.tsv"
check "refuses: another format" refused 'format.tsv:1: format 2' "$work/format.tsv"
printf "$good\n" >"$work/headless.tsv"
check "refuses: no head" refused 'headless.tsv:1: not what facet-bench' "$work/headless.tsv"
head_lines a b >"$work/no-kernel.tsv"
check "refuses: no kernel" refused 'no-kernel.tsv: no kernel' "$work/no-kernel.tsv"
: >"$work/empty.tsv"
check "refuses: an empty file" refused 'empty.tsv: no kernel' "$work/empty.tsv"
printf 'a\0b' >"$work/zero.tsv"
check "refuses: a zero byte" refused 'zero.tsv: a zero byte' "$work/zero.tsv"
check "refuses: no such file" refused 'missing.tsv: No such file' "$work/missing.tsv"
check "refuses: a directory" refused 'refused: Is a directory' "$work/refused"
check "refuses: an unknown option" refused 'no such option' --colour
exit $((failures > 0))
