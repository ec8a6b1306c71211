#!/bin/sh
# sh tests/cost.sh BUILD [update]: what a sample costs, in numbers that no neighbour on the machine can move: the
# instructions of every case, counted by valgrind, and the cycles of the special rows' loops, computed by llvm-mca.
# Fails where one is more than 3 % above tests/cost.tsv; with "update", writes that file. $CC and $CFLAGS: the build's.
cd "$(dirname "$0")/.." || exit 1
build=${1:-build} mode=${2:-check} suite=cost
. tests/report.sh
cflags=${CFLAGS:--O3} table=tests/cost.tsv neon_cc=aarch64-linux-gnu-gcc
status_of_none=$([ "$mode" = check ] && echo 0 || echo 1)
if [ -n "${RUN:-}" ]; then
    skip "everything" "not under an emulator"
    exit $status_of_none
fi
if [ -n "${MODELS:-}" ]; then
    skip "everything" "not a build of all models"
    exit $status_of_none
fi
work=$build/tests/cost
rm -rf "$work"
mkdir -p "$work" || exit 1
: >"$work/measured"

# left_out WHAT WHY: not measured here. No table is written without it.
left_out() {
    if [ "$mode" = update ]; then fail "$@"; else skip "$@"; fi
}

# The table's "# WORD" line.
said() {
    sed -n "s/^# $1	//p" "$table" 2>/dev/null
}

# compiler CC: "gcc 12.2.0 -O3".
compiler() {
    set -- $(echo __clang_major__ __GNUC__ __GNUC_MINOR__ __GNUC_PATCHLEVEL__ | "$1" -E -P - 2>/dev/null)
    case $1 in
    __clang_major__) echo "gcc $2.$3.$4 $cflags" ;;
    *) echo "clang ${1:-unknown} $cflags" ;;
    esac
}

# comparable WHAT CC: whether the table's numbers are of this compiler.
comparable() {
    [ "$mode" = update ] || [ "$(compiler "$2")" = "$(said compiler)" ] ||
        { skip "$1" "the table is for $(said compiler), this is $(compiler "$2")"; return 1; }
}

# ---- Instructions: batches of two sizes tell what a sample costs, and what a call does -------------------------------

# Lines "CASE TIER ARCH SAMPLES" and, beside them, the instructions of these calls.
rows_of_calls() {
    awk -v OFS='\t' '
        NR % 2 { few = $4; least = $5; next }
        {
            sample = ($5 - least) / ($4 - few)
            print "count", $1, $2, $3, sprintf("%.2f", sample), sprintf("%.0f", least - few * sample)
        }'
}

count_instructions() {
    valgrind -q --tool=callgrind --callgrind-out-file="$work/callgrind" --combine-dumps=yes \
        --toggle-collect=facet_shade_sized --dump-after=facet_shade_sized "$build/facet-cost" >"$work/calls"
    # A part for each call, and one for what follows the last.
    sed -n 's/^totals: //p' "$work/callgrind" | sed '$d' >"$work/totals"
    [ -s "$work/calls" ] && [ "$(wc -l <"$work/calls")" = "$(wc -l <"$work/totals")" ] ||
        { echo "$(wc -l <"$work/calls") calls, $(wc -l <"$work/totals") counts"; return 1; }
    paste -d' ' "$work/calls" "$work/totals" | rows_of_calls >>"$work/measured"
}

instructions() {
    case $("$cc" -dumpmachine) in
    x86_64-*) ;;
    *) left_out "instructions" "not an x86-64 machine"; return ;;
    esac
    have valgrind || { left_out "instructions" "no valgrind (package valgrind)"; return; }
    comparable "instructions" "$cc" || return
    check "instructions counted" count_instructions
    for a in scalar sse2 sse41 avx2; do
        for t in fast strict; do
            grep -q "^count.*	$t	$a	" "$work/measured" ||
                left_out "instructions, $a $t" "not in this build, or not on this CPU"
        done
    done
}

# ---- Cycles: the loop over whole groups, every stream per sample, by itself ------------------------------------------

# vectors_of ARCH LANES: "NAME VECTORS" of each row of src/special.def, VECTORS side by side.
vectors_of() {
    awk -F '[(,)]' -v lanes="$2" -v most="$(sed -n 's/^#define VF_INTERLEAVE_WIDE //p' "arch/$1.h")" '
        /^FACET_SPECIAL/ {
            vectors = 1
            n = split($(NF - 1), wide, "|")
            for (i = 1; i <= n; i++) if (wide[i] + 0 == lanes && most) vectors = most
            print $2, vectors
        }' src/special.def
}

# loops DIR VECTORS: from objdump's text on stdin, to DIR/NAME.s for each plain_NAME: of the backward jumps' spans in
# which as many vectors of each channel are stored as the file VECTORS says, the one in which most is divided: a loop
# that has numbers in place of streams divides less. Of several the shortest, and where nothing is divided, the shortest
# in which something is multiplied. Prints "NAME VECTORS INSTRUCTIONS", 0 instructions where none is.
loops() {
    awk -F'\t' -v dir="$1" -v table="$2" '
        function store(text) {
            return text ~ /^v?movups +%[xyz]mm[0-9]+,.*\)$/ && text !~ /\(%rsp/ || text ~ /^str +q/ && text !~ /\[sp/
        }
        # Sets where it begins; returns its length.
        function busiest(work, counts,  i, j, n, here, most, least) {
            most = least = 0
            for (i = 1; i <= count; i++) {
                j = to[i] in place ? place[to[i]] : count
                n = i - j + 1
                here = work[i] - work[j - 1]
                if (j >= i || !here || stores[i] - stores[j - 1] != 3 * vectors[name]) continue
                if (least && counts && here < most) continue
                if (least && !(counts && here > most) && least <= n) continue
                most = here
                from = j
                least = n
            }
            return least
        }
        function end_function(  i, least) {
            least = busiest(divisions, 1)
            if (!least) least = busiest(products, 0)
            if (name) print name, vectors[name], least
            if (least) print "loop:" >(dir "/" name ".s")
            for (i = from; i < from + least; i++) print code[i] >(dir "/" name ".s")
            if (least) close(dir "/" name ".s")
            name = ""
            count = 0
            split("", place)
        }
        BEGIN {
            while ((getline row <table) > 0) {
                split(row, word, " ")
                vectors[word[1]] = word[2]
            }
        }
        / <[^>]*>:$/ {
            end_function()
            if (match($0, /<plain_[a-z0-9_]*[>.]/) && $0 !~ /\.cold/) name = substr($0, RSTART + 7, RLENGTH - 8)
        }
        name && NF > 1 {
            address = $1
            gsub(/[ :]/, "", address)
            text = $0
            sub(/^[^\t]*\t/, "", text)
            gsub(/\t/, " ", text)
            sub(/ +\/\/.*$/, "", text)                      # comments
            sub(/ +# [0-9a-f]+ <.*$/, "", text)
            sub(/ +$/, "", text)
            place[address] = ++count
            to[count] = ""
            if (match(text, / [0-9a-f]+ <[^>]*>$/)) {
                to[count] = substr(text, RSTART + 1)
                sub(/ .*/, "", to[count])
                text = substr(text, 1, RSTART) "loop"
            }
            code[count] = text
            divisions[count] = divisions[count - 1] + (text ~ /^(v?div|v?sqrt|fdiv|fsqrt|frecpe)/)
            products[count] = products[count - 1] + (text ~ /^(v?mul|fmul)/)
            stores[count] = stores[count - 1] + store(text)
        }
        END { end_function() }'
}

# What llvm-mca is told: an architecture lanes, its triple and CPUs of it; scalar loops are not looked at.
mca_of() {
    case $1 in
    sse2 | sse41) echo 4 x86_64 x86-64 ;;
    avx2) echo 8 x86_64 znver4 ;;
    avx512) echo 16 x86_64 znver4 ;;
    neon) echo 4 aarch64 cortex-a72 neoverse-n1 ;;
    esac
}

# row_of_loop NAME TIER ARCH CPU SAMPLES: of llvm-mca's summary, "Block RThroughput" being the resource bound.
row_of_loop() {
    awk -v OFS='\t' -v id="$1 $2 $3 $4" -v samples="$5" '
        /^Iterations:/ { n = $2 }
        /^Instructions:/ { instructions = $2 / n }
        /^Total Cycles:/ { cycles = $3 / n }
        /^Block RThroughput:/ { bound = $3 }
        END {
            gsub(/ /, OFS, id)
            if (!bound) exit 1
            printf "loop\t%s\t%.2f\t%.2f\t%.2f\n", id, instructions / samples, cycles / samples, bound / samples
        }'
}

# loops_of OBJDUMP OBJECT ARCH TIER
loops_of() {
    dir=$work/$3_$4
    mkdir -p "$dir"
    "$1" -d --no-show-raw-insn "$2" >"$dir/all"
    set -- "$3" "$4" $(mca_of "$3")
    arch=$1 tier=$2 lanes=$3 triple=$4
    shift 4
    vectors_of "$arch" "$lanes" >"$dir/vectors"
    loops "$dir" "$dir/vectors" <"$dir/all" >"$dir/found"
    [ -s "$dir/found" ]
    none "no loop with stores and products" "$(awk '!$3 { print $1 }' "$dir/found")"
    for cpu in "$@"; do
        while read -r name vectors length; do
            "$mca" -mtriple="$triple" -mcpu="$cpu" -iterations=500 -instruction-info=0 -resource-pressure=0 \
                "$dir/$name.s" 2>"$dir/$name.error" |
                row_of_loop "$name" "$tier" "$arch" "$cpu" $((lanes * vectors)) >>"$work/measured" ||
                { head -n 3 "$dir/$name.error"; return 1; }
        done <"$dir/found"
    done
}

# built OBJECT: whether it is there, and of this build, not left by one before.
built() {
    if [ "$obj" = "$build/obj" ]; then ar t "$build/libfacet.a" | grep -qx "${1##*/}"; else [ -e "$1" ]; fi
}

# objects OBJDUMP DIR ARCH...
objects() {
    dump=$1 obj=$2
    shift 2
    for a in "$@"; do
        for t in fast strict; do
            object=$obj/f32_${a}_$t.o
            if built "$object"; then check "loops of $a $t" loops_of "$dump" "$object" "$a" "$t"
            else left_out "cycles, $a $t" "not in this build"; fi
        done
    done
}

# The llvm-mca that the table is of, or, for a new one, the first; its version.
find_mca() {
    for mca in llvm-mca-19 llvm-mca; do
        mca_version=$("$mca" --version 2>/dev/null | sed -n 's/.*LLVM version //p')
        if [ "$mode" = update ]; then wanted=$mca_version; else wanted=$(said llvm-mca); fi
        [ -n "$mca_version" ] && [ "$mca_version" = "$wanted" ] && return
    done
    return 1
}

neon_objects() {
    make_in "$build/cost" CC="$neon_cc" CFLAGS="$cflags" ARCHES="scalar neon" \
        "$build/cost/obj/f32_neon_fast.o" "$build/cost/obj/f32_neon_strict.o"
}

cycles() {
    if ! find_mca; then
        version=$(said llvm-mca)
        left_out "cycles" "no llvm-mca${version:+ $version} (package llvm-19)"
        return
    fi
    if comparable "cycles" "$cc"; then objects objdump "$build/obj" sse2 sse41 avx2 avx512; fi
    if ! have "$neon_cc"; then left_out "cycles, neon" "no $neon_cc (package gcc-aarch64-linux-gnu)"
    elif comparable "cycles, neon" "$neon_cc"; then
        check "neon kernels build" neon_objects
        objects "${neon_cc%gcc}objdump" "$build/cost/obj" neon
    fi
}

# ---- The table -------------------------------------------------------------------------------------------------------

write_table() {
    printf '# %s\n' \
        "What a sample costs: written by \`make update-cost\`, compared by \`make check-cost\`." \
        "count: instructions of facet_shade, as valgrind counts them, a sample and a call: slope and intercept of" \
        "    plain batches of 256 and 512 samples, one light, every stream per sample. AVX-512 is not counted." \
        "loop: the special row's loop over plain batches by itself: its instructions, the cycles that llvm-mca" \
        "    computes for that CPU, and the bound that its resources set (Block RThroughput), each a sample." \
        "compiler	$(compiler "$cc")" "llvm-mca	$mca_version" \
        "count	case	tier	arch	sample	call" "loop	row	tier	arch	cpu	instructions	cycles	bound"
    cat "$work/measured"
}

# A line for each row: the table's, then those that it lacks. A target that was not measured has been skipped.
compare() {
    awk -F'\t' -v more=1.03 '
        function id(  i, key) {
            key = $2
            for (i = 3; i <= keys[$1]; i++) key = key " " $i
            return key ": " ($1 == "count" ? "instructions" : "loop")
        }
        BEGIN {
            keys["count"] = 4
            keys["loop"] = 5
            split("instructions a sample,instructions a call", of_count, ",")
            split("instructions a sample,cycles a sample,cycles of the bound a sample", of_loop, ",")
        }
        /^#/ { next }
        FILENAME == ARGV[1] {
            new[id()] = $0
            measured[$1, $3, $4] = 1
            next
        }
        { key = id(); known[key] = 1 }
        !(($1, $3, $4) in measured) { next }
        !(key in new) { print "FAIL cost: " key ": is gone; `make update-cost` if it should be"; next }
        {
            split(new[key], now, FS)
            worse = better = ""
            for (i = keys[$1] + 1; i <= NF; i++) {
                what = $1 == "count" ? of_count[i - keys[$1]] : of_loop[i - keys[$1]]
                change = sprintf("%s %s, not %s", now[i], what, $i)
                if (now[i] > $i * more) worse = worse (worse ? "; " : "") change
                if (now[i] * more < $i) better = better (better ? "; " : "") change
            }
            print (worse ? "FAIL" : "ok") " cost: " key (worse ? ": " worse : "")
            if (better) print "note cost: " key ": less: " better "; `make update-cost` keeps it"
        }
        END {
            for (key in new) if (!(key in known)) print "FAIL cost: " key ": not in the table; `make update-cost`"
        }' "$work/measured" "$table"
}

instructions
cycles
if [ "$mode" = update ]; then
    [ $failures = 0 ] || { echo "$table is as it was"; exit 1; }
    write_table >"$work/table" && cp "$work/table" "$table"
    exit
fi
compare >"$work/compared"
cat "$work/compared"
[ $failures = 0 ] && ! grep -q '^FAIL ' "$work/compared"
