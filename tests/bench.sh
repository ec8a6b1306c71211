#!/bin/sh
# sh tests/bench.sh BUILD: checks BUILD/facet-bench from outside: its command line, and that what it writes is whole.
# How fast anything is, is not tested.
cd "$(dirname "$0")/.." || exit 1
build=${1:-build} suite=bench
. tests/report.sh
work=$build/tests/bench
rm -rf "$work"
mkdir -p "$work"
errors=tests/accuracy.tsv,$build/baselines.tsv

bench() {
    "$build/facet-bench" --errors "$errors" --seconds 0 "$@"
}

# ---- The command line ------------------------------------------------------------------------------------------------

helps() {
    bench --help >"$work/help" 2>"$work/err"
    none "on stderr" "$(cat "$work/err")"
    for word in --filter --all --arch --size --seconds --tsv --compare --errors tile diffuse metal plastic lights full \
        frame packed-pixels literal Bounds Errors 'x frame'; do
        grep -q -- "$word" "$work/help" || { echo "lacks $word"; return 1; }
    done
}

# fails STATUS PATTERN WORD...: exits so, with one line on stderr that matches, and prints nothing.
fails() {
    expected=$1 pattern=$2 got=0
    shift 2
    bench "$@" >"$work/out" 2>"$work/err" || got=$?
    [ $got = "$expected" ] || { echo "exit status $got"; return 1; }
    none "on stdout" "$(cat "$work/out")"
    [ "$(wc -l <"$work/err")" = 1 ] || { echo "lines on stderr: $(wc -l <"$work/err")"; return 1; }
    grep -q "^facet-bench: .*$pattern" "$work/err" || { cat "$work/err"; return 1; }
}

check "--help has every option and workload" helps
check "an unknown option" fails 2 'no such option; --help' --nonsense
check "an option without its value" fails 2 'needs a value' --size
check "a switch with a value" fails 2 'takes no value' --all=1
check "a size that is none of the four" fails 2 "--size '256,17': allowed: 16, 256, 4096, 4M" --size 256,17
check "an empty size in a list" fails 2 'allowed: 16' --size 16,
check "an unknown architecture" fails 2 "--arch 'x86': allowed: best" --arch x86
check "no number of seconds" fails 2 'a number from 0' --seconds -1
check "a table without one to compare with" fails 2 'nothing to compare with' new.tsv
check "two tables" fails 2 'one table is allowed' --compare old.tsv new.tsv other.tsv
check "a filter that nothing passes" fails 1 "no workload or kernel of that name" --filter nothing
check "a table that is not there" fails 1 'none.tsv: No such file' --compare "$work/none.tsv" "$work/none.tsv"
check "a table that cannot be written" fails 1 'none/x.tsv: No such file' --tsv "$work/none/x.tsv"
check "an old table that is not there" fails 1 'none.tsv: No such file' --compare "$work/none.tsv"
printf '# facet-bench\t1\nkernel\ttile\tfast\n' >"$work/cut.tsv"
check "a table with a row cut short" fails 1 'cut.tsv:2: not a row' --compare "$work/cut.tsv" "$work/cut.tsv"
printf 'bound\tlambert\tfast\t1\n' >"$work/errors.tsv"
check "a table of errors that is none" fails 1 'errors.tsv:1: not a row' --errors "$work/errors.tsv"

# ---- Runs ------------------------------------------------------------------------------------------------------------

# run TABLE WORD...
run() {
    table=$1
    shift
    bench "$@" --tsv "$table" >"$work/out" 2>"$work/err"
    none "on stderr" "$(cat "$work/err")"
    [ -s "$work/out" ]
}

# Fields that are not what bench_results.h says: numbers above 0, or a dash where they may be unknown.
bad_rows() {
    awk -F '\t' '
        function number(text) { return text ~ /^[0-9.]+(e[-+][0-9]+)?$/ }
        function known(text) { return number(text) && text + 0 > 0 }
        /^# / && NF == 2 { next }
        $1 == "peak" && NF == 4 && known($3) && $4 ~ /^(lanes|bytes|cycles)\/s$/ { next }
        $1 != "kernel" || NF != 17 { print FILENAME ":" FNR ": no row"; next }
        $3 !~ /^(fast|strict|baseline)$/ || $5 !~ /^(16|256|4096|4194304)$/ || $6 !~ /^(staggered|aligned)$/ ||
        !known($7) || !number($8) || !known($9) || !known($10) { print FILENAME ":" FNR ": " $0 }
        { for (i = 11; i <= 17; i++) if (i != 15 && $i != "-" && !known($i)) print FILENAME ":" FNR ": " $i }
        $15 !~ /^(fma|divide|sqrt|load|store|memory|-)$/ { print FILENAME ":" FNR ": by " $15 }
    ' "$1"
}

# lacking TABLE CASE SIZE: what does not stand there, twice (staggered and aligned) and with its ratio to the textbook's
# shader and its errors: both tiers of the best architecture, and the baselines that were built.
lacking() {
    {
        printf '%s\t%s\n' fast "$best" strict "$best"
        sed -n 's/^BASELINE(\(.*\))/\1/p' "$build/bench/built.def" | tr _ - | sed 's/^/baseline\t/'
    } | while IFS='	' read -r tier arch; do
        rows=$(awk -F '\t' -v OFS='\t' -v what="$2" -v size="$3" -v tier="$tier" -v arch="$arch" \
            '$2 == what && $3 == tier && $4 == arch && $5 == size && $11 + 0 > 0 && $16 + 0 > 0 && $17 + 0 > 0' \
            "$1" | wc -l)
        [ "$rows" = 2 ] || [ "$arch" = ispc ] || echo "$2 $3 $tier $arch ($rows)"
    done
}

workloads() {
    run "$work/all.tsv" --size 16,256
    none "malformed" "$(bad_rows "$work/all.tsv")"
    best=$(awk -F '\t' '$3 == "fast" { arch = $4 } END { print arch }' "$work/all.tsv")
    for what in tile diffuse metal plastic lights full; do
        none "lacks" "$(lacking "$work/all.tsv" $what 16)$(lacking "$work/all.tsv" $what 256)"
    done
}

frame() {
    run "$work/frame.tsv" --filter frame --arch best
    none "malformed" "$(bad_rows "$work/frame.tsv")"
    best=$(awk -F '\t' '$3 == "fast" { arch = $4 } END { print arch }' "$work/frame.tsv")
    none "lacks" "$(lacking "$work/frame.tsv" frame 4194304)"
    grep -q '^peak	copy_memory	' "$work/frame.tsv"
}

# Packed streams have no baselines: a row for each tier and layout, with errors, and a ratio to frame's, which comes
# along.
packed() {
    run "$work/packed.tsv" --filter packed --arch best
    none "malformed" "$(bad_rows "$work/packed.tsv")"
    awk -F '\t' '$2 ~ /^packed/ { print $2, $3, $5, $10, $11 }' "$work/packed.tsv" | sort | uniq -c |
        sed 's/^ *//' >"$work/rows"
    for row in 'packed fast 4194304 18' 'packed strict 4194304 18' 'packed-pixels fast 4194304 16' \
        'packed-pixels strict 4194304 16'; do
        echo "2 $row -"
    done | diff "$work/rows" -
    none "without an error" "$(awk -F '\t' '$2 ~ /^packed/ && !($16 > 0 && $17 > 0)' "$work/packed.tsv")"
    [ "$(awk -F '\t' '$2 == "frame" && $3 == "fast"' "$work/packed.tsv" | wc -l)" = 2 ]
    [ "$(grep -c ' x frame ' "$work/out")" = 2 ]
    awk '/^[a-z-]*:/ { beside = /^packed/ } beside && /fast|strict/ && NF > 9 && $8 > 0' "$work/out" >"$work/ratios"
    [ "$(wc -l <"$work/ratios")" = 4 ]
}

kernels() {
    run "$work/kernels.tsv" --all --size 16 --arch scalar
    none "malformed" "$(bad_rows "$work/kernels.tsv")"
    cut -f 2 tests/accuracy.tsv | grep -v -e '^#' -e '^case$' | sort -u >"$work/listed"
    awk -F '\t' '$11 == "-" && $16 + 0 > 0 { print $2 }' "$work/kernels.tsv" | sort -u >"$work/timed"
    [ -s "$work/listed" ]
    diff "$work/listed" "$work/timed"
}

# Whatever it is slower than: they compute the same function.
baselines_agree() {
    [ "$(grep -c '^baseline' "$build/baselines.tsv")" -ge 6 ]
    none "far from the reference" "$(awk -F '\t' '/^[bk]/ && !($(NF - 1) < 5e-3 && $NF < 5e-4)' "$build/baselines.tsv")"
    # Where products are fused.
    none "less accurate than the fast tier is" "$(awk -F '\t' '
        $1 == "kernel" && $2 != "packed" && $3 == "fast" && $4 ~ /^(avx|neon)/ && !($5 <= 2e-4 && $6 <= 2e-5)' \
        "$build/baselines.tsv")"
}

# Each architecture's own, of every row that baselines.tsv has of floats.
own_errors() {
    awk -F '\t' '$1 == "kernel" && $2 != "packed" { print $2, $3, $4, $5, $6 }' "$build/baselines.tsv" |
        sort -u >"$work/own"
    awk -F '\t' '$1 == "kernel" { print $2, $3, $4, $16, $17 }' "$work/all.tsv" | sort -u >"$work/shown"
    [ -s "$work/own" ]
    none "not shown" "$(comm -23 "$work/own" "$work/shown")"
}

same() {
    bench --compare "$work/all.tsv" "$work/all.tsv" >"$work/out"
    grep -qx "no change in $(grep -c '^kernel' "$work/all.tsv") rows" "$work/out"
}

# The fast tier's times halved, and a row less.
other() {
    awk -F '\t' -v OFS='\t' '$3 == "fast" { $7 /= 2; $8 = 0.001 } $2 != "tile" || $5 != 16' "$work/all.tsv" \
        >"$work/other.tsv"
    bench --compare "$work/all.tsv" "$work/other.tsv" >"$work/out"
    grep -q '2.000 times as fast' "$work/out"
    grep -q 'rows of the old table have no counterpart' "$work/out"
    none "no such change" "$(grep -E 'times as (fast|slow)' "$work/out" | grep -v ' fast .* 2.000 times as fast')"
}

against_old() {
    bench --size 16 --filter diffuse --compare "$work/all.tsv" >"$work/out"
    grep -q "^compared with $work/all.tsv" "$work/out"
}

without_errors() {
    "$build/facet-bench" --seconds 0 --filter diffuse --size 16 --errors "$work/none.tsv" --tsv "$work/unknown.tsv" \
        >"$work/out" 2>"$work/err"
    grep -q 'none.tsv: No such file or directory: its errors are not known' "$work/err"
    none "known" "$(awk -F '\t' '$1 == "kernel" && ($16 != "-" || $17 != "-")' "$work/unknown.tsv")"
}

check "every workload, by every baseline and the library" workloads
check "a frame from memory" frame
check "packed streams beside a frame" packed
check "every kernel of the table" kernels
check "the baselines compute the same functions" baselines_agree
check "errors of workloads are each architecture's own" own_errors
check "a table is like itself" same
check "what is faster in another table" other
check "a run beside a table" against_old
check "without a table of errors they are unknown" without_errors
[ $failures = 0 ]
