#!/bin/sh
# sh tests/readme.sh BUILD: what README.md says: its example runs, its tables are those of src/*.def, its commands are
# targets, the files that it names are there.
cd "$(dirname "$0")/.." || exit 1
build=${1:-build} suite=readme
. tests/report.sh
work=$build/tests/readme
rm -rf "$work"
mkdir -p "$work"

# The blocks of C code that include facet.h, a file each.
examples() {
    awk -v work="$work" '
        /^```c$/ { inside = 1; block = ""; next }
        /^```/ && inside && block ~ /#include [<"]facet\.h[>"]/ { printf "%s", block >(work "/example" ++n ".c") }
        /^```/ { inside = 0 }
        inside { block = block $0 "\n" }' README.md
}

# Compiles as the reader would, and under an emulator where this is a check of another machine.
example_runs() {
    "$cc" -O2 -Wall -Wextra -Werror ${RUN:+-static} -Isrc -o "$work/example" "$1" "$build/libfacet.a" -lm
    (cd "$work" && ${RUN:-} ./example)
}

tables() {
    cp README.md "$work/README.md"
    make_in "$build" README="$work/README.md" readme
    diff README.md "$work/README.md" || { echo "make readme mends it"; return 1; }
}

# Every `make WORD ...`, in lines of code and in `code`.
commands() {
    "$make" -pn help | sed -n 's/^\.PHONY: *//p' | tr ' ' '\n' >"$work/targets"
    awk '/^```/ { fenced = !fenced; next }
        fenced || /^    / { sub(/ # .*/, ""); print; next }
        { n = split($0, part, "`"); for (i = 2; i <= n; i += 2) print part[i] }' README.md |
        sed -nE 's/ +$//; s/^ *(make( .*)?)$/\1/p' >"$work/commands"
    grep -qx 'make demo' "$work/commands"
    grep -qx 'make deps check' "$work/commands"
    none "no such target" "$(sed -E 's/[A-Z]+=("[^"]*"|[^ ]*)//g' "$work/commands" | tr ' ' '\n' | grep -vxE 'make|' |
        grep -vxFf "$work/targets")"
}

# Links to files, and `paths` into the tree, where NAME is anything.
files() {
    { grep -oE '\]\([^)#]+' README.md | sed 's/^](//' | grep -vE '^[a-z]+:'
      grep -oE '`(src|arch|bench|tests)/[A-Za-z0-9_./*-]*`' README.md | tr -d '`'; } | sort -u >"$work/files"
    sed 's/NAME/*/' "$work/files" | while read -r file; do
        ls -d $file >/dev/null 2>&1 || echo "$file"
    done >"$work/missing"
    none "not there" "$(cat "$work/missing")"
}

if [ ! -f README.md ]; then
    fail "README.md" "is not there"
    exit 1
fi
examples
check "has an example in C" test -s "$work/example1.c"
for example in "$work"/example?.c; do
    [ -f "$example" ] && check "$(basename "$example" .c) compiles and runs" example_runs "$example"
done
check "tables are those of src/*.def" tables
check "commands are targets" commands
check "files that it names are there" files
exit $((failures > 0))
