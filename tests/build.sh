#!/bin/sh
# sh tests/build.sh BUILD: what is built and installed: symbols and sections, filtered and freestanding builds, install
# and uninstall; and rules of the source that no compiler checks.
cd "$(dirname "$0")/.." || exit 1
build=${1:-build} suite=build
. tests/report.sh
if [ -n "${RUN:-}" ]; then
    skip "everything" "not under an emulator"
    exit 0
fi
work=$build/tests/build
rm -rf "$work"
mkdir -p "$work" && work=$(cd "$work" && pwd) || exit 1
strict_flags='-O2 -Wall -Wextra -Werror'

# ---- Symbols and sections --------------------------------------------------------------------------------------------

undefined() {
    nm -A "$build/libfacet.a" | awk '
        $(NF - 1) == "U" { undefined[$NF] = $1 }
        $(NF - 1) ~ /^[A-TV-Z]$/ { defined[$NF] = 1 }
        END { for (s in undefined) if (!(s in defined)) print s " in " undefined[s] }' >"$work/undefined"
    [ -s "$build/libfacet.a" ]
    none "undefined in the static library" "$(cat "$work/undefined")"
    none "undefined in the shared library" \
        "$(nm -D --undefined-only "$build/libfacet.so" | awk '$1 == "U" { print $2 }')"
}

prefixed() {
    none "without the prefix" \
        "$(nm --defined-only --extern-only "$build/libfacet.a" | awk 'NF == 3 && $3 !~ /^facet_/ { print $3 }')"
}

exported() {
    tr '\n' ' ' <src/facet.h | grep -oE 'FACET_API [^(;]*[ *]facet_[a-z0-9_]*\(' | grep -oE 'facet_[a-z0-9_]*\($' |
        tr -d '(' | sort >"$work/declared"
    nm -D --defined-only "$build/libfacet.so" | awk '{ print $3 }' | sort >"$work/exported"
    [ -s "$work/declared" ]
    diff "$work/declared" "$work/exported"
}

no_variables() {
    objdump -h "$build/libfacet.a" >"$work/sections"
    grep -q ' \.text' "$work/sections"
    none "writable" "$(awk '/file format/ { o = $1 }
        $2 ~ /^\.(data|bss|tdata|tbss)/ && $2 !~ /^\.data\.rel\.ro/ && $3 !~ /^0+$/ { print o, $2 }' "$work/sections")"
}

check "nothing undefined: the library calls itself alone" undefined
check "every global symbol begins with facet_" prefixed
check "the shared library exports what facet.h declares" exported
check "no variables, only constant tables" no_variables

# ---- Builds ----------------------------------------------------------------------------------------------------------

# No header but the compiler's own, no library at all.
freestanding() {
    include=$("$cc" -print-file-name=include)
    make_in "$work/freestanding" CPPFLAGS="-nostdinc -isystem $include" CFLAGS='-O2 -Werror' ARCHES=scalar \
        "$work/freestanding/libfacet.a"
    "$cc" -shared -nostdlib -Wl,--no-undefined -o "$work/freestanding/alone.so" \
        -Wl,--whole-archive "$work/freestanding/libfacet.a"
}

full() {
    "$cc" $strict_flags -Isrc -o "$work/filtered" tests/filtered.c "$build/libfacet.a"
    "$work/filtered" >"$work/results"
}

# filtered DIR WORD...: a build of these models holds them and refuses the others, and gives the full build's bytes.
filtered() {
    dir=$work/$1
    shift
    make_in "$dir" CFLAGS='-O2 -Werror' MODELS="$*" ARCHES=scalar TIERS=strict all
    "$cc" $strict_flags -Isrc -o "$dir/filtered" tests/filtered.c "$dir/libfacet.a"
    "$dir/filtered" "$@" >"$dir/results" || { grep -v '^[0-9]' "$dir/results"; return 1; }
    [ -s "$dir/results" ]
    none "not as in the full build" "$(grep -vxFf "$work/results" "$dir/results")"
}

stripped_size() {
    strip -o "$work/stripped.so" "$work/lambert/libfacet.so" && wc -c <"$work/stripped.so"
}

# A copy of the tree elsewhere, built outside itself: nothing in it is touched, and the libraries are this build's.
reproducible() {
    mkdir -p "$work/copy/tree"
    cp -R Makefile src arch bench tests "$work/copy/tree"
    touch "$work/copied"
    "$make" -s -C "$work/copy/tree" -j"$processors" BUILD="$work/copy/build" all "$work/copy/build/facet-demo"
    none "written" "$(find "$work/copy/tree" -newer "$work/copied")"
    for file in libfacet.a libfacet.so facet-demo; do cmp "$build/$file" "$work/copy/build/$file"; done
}

limit=61440
check "compiles and links without libc and its headers" freestanding
check "the full build holds every model" full
check "MODELS=lambert holds Lambert alone" filtered lambert lambert
size=$(stripped_size)
check "MODELS=lambert is ${size:-unknown} bytes, $limit allowed" [ "${size:-$((limit + 1))}" -le $limit ]
check "MODELS='lambert ggx smith-correlated schlick packed' holds these alone" \
    filtered common lambert ggx smith-correlated schlick packed
check "a copy gives the same bytes and writes nothing into its tree" reproducible

# ---- Install and uninstall -------------------------------------------------------------------------------------------

# From the copy, which was built for the default PREFIX.
root=$work/root
version=$(sed -n 's/.*FACET_VERSION_[MP][A-Z]* //p' src/facet.h | paste -sd.)

made() {
    "$make" -s -C "$work/copy/tree" BUILD="$work/copy/build" DESTDIR="$root" "$@"
}

# What stands under $root is what was there before, and these files.
holds() {
    printf '%s\n' ./opt/lib/libother.a "$@" | sort >"$work/expected"
    (cd "$root" && find . ! -type d | sort) | diff "$work/expected" -
}

installed_files() {
    printf "./$1/%s\n" include/facet.h lib/libfacet.a lib/libfacet.so lib/libfacet.so."${version%%.*}" \
        lib/libfacet.so."$version" lib/pkgconfig/facet.pc
}

installs() {
    mkdir -p "$root/opt/lib"
    echo other >"$root/opt/lib/libother.a"
    made install PREFIX=/opt
    holds $(installed_files opt)
    cmp src/facet.h "$root/opt/include/facet.h"
    [ "$(readlink "$root/opt/lib/libfacet.so")" = "libfacet.so.${version%%.*}" ]
}

snapshot() {
    (cd "$1" && find . -type f -exec cksum {} + | sort -k 3)
}

installs_again() {
    snapshot "$root" >"$work/before"
    made install PREFIX=/opt
    snapshot "$root" >"$work/after"
    diff "$work/before" "$work/after"
}

found() {
    PKG_CONFIG_LIBDIR=$root/opt/lib/pkgconfig PKG_CONFIG_SYSROOT_DIR=$root pkg-config "$@" facet
}

# used LINK COMPILER FLAG...: a program that knows the library through pkg-config.
used() {
    link=$1
    shift
    "$@" -Wall -Wextra -pedantic -Werror $(found --cflags) -o "$work/consumer" tests/consumer.c \
        $([ "$link" = shared ] || echo -static) $(found --libs)
    needed=$(objdump -p "$work/consumer" | awk '$1 == "NEEDED" && $2 ~ /^libfacet/ { print $2 }')
    [ "$needed" = "$([ "$link" = static ] || echo "libfacet.so.${version%%.*}")" ] ||
        { echo "needs $needed"; return 1; }
    [ "$(LD_LIBRARY_PATH=$root/opt/lib "$work/consumer")" = "facet $version" ]
    [ "$(found --modversion)" = "$version" ]
}

uninstalls() {
    made uninstall PREFIX=/opt
    holds
}

check "install DESTDIR PREFIX" installs
check "install a second time" installs_again
if have pkg-config; then
    for link in static shared; do
        check "pkg-config, $link, C" used $link "$cc" -std=c99
        for standard in c++11 c++17; do
            if have g++; then check "pkg-config, $link, $standard" used $link g++ -std=$standard -x c++
            else skip "pkg-config, $link, $standard" "no g++ (package g++)"; fi
        done
    done
else
    skip "pkg-config" "no pkg-config (package pkgconf)"
fi
check "uninstall removes what install put there" uninstalls

# ---- Rules of the source ---------------------------------------------------------------------------------------------

sources=$(find src bench tests -name '*.[ch]' -o -name '*.def')

lines() {
    none "$1" "$(grep -nE "$2" $3 /dev/null)"
}

headers='(arm_neon|[a-z]*mmintrin)\.h'
x86='_mm(256|512)?_[a-z]+_'
neon='\<v(ld|st|add|sub|mul|fma|dup|max|min|abs|bsl|c[lg][te])[0-9a-z]*_[fsu](16|32)'

# But for a guard against a second inclusion.
conditionals() {
    none "found" \
        "$(awk '/^# *ifndef [A-Z_]+_H$/ { next } /^ *# *(if|el)/ { print FILENAME ":" FNR ":" $0 }' src/*.tmpl.h)"
}

# Every phony target is one that `make help` shows.
helpful() {
    "$make" help | awk 'NF > 1 && !/=/ { print $1 }' | sort >"$work/helped"
    "$make" -pn help | sed -n 's/^\.PHONY: *//p' | tr ' ' '\n' | grep -vx FORCE | sort -u >"$work/phony"
    [ -s "$work/phony" ]
    diff "$work/phony" "$work/helped"
}

check "no intrinsics outside arch" lines found "$headers|$x86|$neon" "$sources"
check "no conditional inside a template" conditionals
check "the library does not allocate" lines found '\<(malloc|calloc|realloc|free|alloca) *\(' "$(find src arch -type f)"
check "make help lists every target" helpful
exit $((failures > 0))
