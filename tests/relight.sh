#!/bin/sh
# sh tests/relight.sh BUILD: shades the G-buffers of tests/data with BUILD/relight and compares them with their
# renderer's own light; reads many kinds of EXR file; and refuses what is wrong. RUN: what runs it, such as an emulator.
cd "$(dirname "$0")/.." || exit 1
build=${1:-build} suite=relight
. tests/report.sh
scratch=$build/tests/relight
data=tests/data

if [ ! -x "$build/relight" ]; then
    if pkg-config --exists OpenEXR 2>/dev/null; then
        fail "everything" "$build/relight is not built"
        exit 1
    fi
    skip "everything" "OpenEXR not installed"
    exit 0
fi
rm -rf "$scratch"
mkdir -p "$scratch" || exit 1

tool() {
    ${RUN:-} "$build/relight" "$@"
}

# words KIND PATTERN: the words of a kind whose availability matches.
words() {
    tool --list | awk -v kind="$1" -v pattern="$2" '
        $1 == kind { word = $2; $1 = $2 = ""; if ($0 ~ pattern) print word }'
}

archs=$(words arch '^ *available' | grep -v '^best$')
tiers=$(words tier '^ *available')

# ---- Agreement with the renderer -------------------------------------------------------------------------------------

# The scene of a G-buffer as options; its model and the layer that has its light.
scene() {
    awk '{ at[$1] = $2 "," $3 "," $4; energy[$1] = $2 }
         END { print "--eye", at["eye"], "--light", at["light"] "/" energy["sun_energy"] }' "$data/$1.txt"
}

# Of the cone, what lies below a radiance of 1e-5 is left out: Beckmann falls to 1e-33 there, and an exponent that is
# rounded to float, in the renderer too, moves exp(-x) by x roundings. 1e-5 is the least power of ten at which the
# textbook's formula in double agrees with the picture as the test wants it: to 4.4e-5 for 99.9 % of the values, and to
# 6.4e-5 at 1e-6.
model() {
    case $1 in
    ico_*) echo "--diffuse fujii:0.3 --specular none --against DiffDir" ;;
    knot_*) echo "--diffuse none --specular ggx:0.2 --masking smith --fresnel one --against GlossDir" ;;
    cone_*)
        echo "--diffuse none --specular beckmann:0.25 --masking smith --fresnel one --against GlossDir --floor 1e-5"
        ;;
    esac
}

# bounds NAME: of p50 and p99.9, and the least number of values that are compared.
bounds() {
    case $1 in
    ico_*) echo "1e-6 2e-5 22000" ;;
    knot_*) echo "1e-6 2e-5 29000" ;;
    cone_*) echo "3e-6 5e-5 4100" ;;
    esac
}

# shade NAME OUT WORD...: leaves the errors in $scratch/errors. Of the options, the last one holds.
shade() {
    shade_name=$1 out=$2
    shift 2
    tool "$data/$shade_name.exr" "$scratch/$out" $(scene "$shade_name") $(model "$shade_name") "$@" >"$scratch/errors"
}

# error PERCENTILE COMPARISON BOUND: whether it holds, for a number that was printed; `compared` is one too.
error() {
    awk -v name="$1" -v comparison="$2" -v bound="$3" '
        $1 == name && $2 ~ (name == "compared" ? "^[0-9]+$" : "^[0-9.]+e[-+][0-9]+$") { found++; value = $2 }
        END {
            if (found != 1) { print name " is not printed"; exit 1 }
            holds = comparison == "<=" ? value + 0 <= bound + 0 : value + 0 >= bound + 0
            if (!holds) print name " " value " is not " comparison " " bound
            exit !holds
        }' "$scratch/errors"
}

# agrees NAME ARCH TIER BOUND...: a constant that is off by more than the renderer's rounding moves every pixel, and the
# median tells.
agrees() {
    shade "$1" "$1.$2.$3.exr" --arch "$2" --tier "$3"
    error p50 "<=" "$4"
    error p99.9 "<=" "$5"
    error compared ">=" "$6"
}

same_bytes() {
    for arch in $archs; do cmp "$scratch/$1.scalar.strict.exr" "$scratch/$1.$arch.strict.exr"; done
}

has_archs() {
    [ "$(echo "$archs" | wc -w)" -ge 1 ] && [ "$(echo "$tiers" | wc -w)" -ge 1 ]
}

check "an arch and a tier are available" has_archs
for arch in $(words arch 'not on this CPU'); do skip "$arch" "not on this CPU"; done
for name in ico_diffuse_fujii_0.3 knot_ggx_0.2 cone_beckmann_0.25; do
    set -- $(bounds $name)
    for tier in $tiers; do
        for arch in $archs; do
            check "$name $arch $tier agrees with Cycles: p50 <= $1, p99.9 <= $2 of $3 values and more" \
                agrees $name "$arch" "$tier" "$@"
        done
    done
    case "$(echo $archs) in $(echo $tiers)" in
    "scalar "*" in "*strict*) check "$name strict: the same file on every arch" same_bytes $name ;;
    *) skip "$name strict: the same file on every arch" "this build has one arch, or no strict tier" ;;
    esac
done

# ---- What the comparison notices -------------------------------------------------------------------------------------

# sun NAME SHARE: a part of its sun.
sun() {
    scene "$1" | awk -v CONVFMT=%.9g -v share="$2" '
        { split($4, l, "/"); print "--light", l[1] "/" l[2] * share }'
}

# two_suns SHARE PERCENTILE COMPARISON BOUND: half of the sun, and SHARE of it.
two_suns() {
    name=ico_diffuse_fujii_0.3
    tool "$data/$name.exr" "$scratch/suns.exr" --eye "$(scene $name | cut -d' ' -f2)" $(sun $name 0.5) \
        $(sun $name "$1") $(model $name) >"$scratch/errors"
    error "$2" "$3" "$4"
}

other_alpha() {
    shade knot_ggx_0.2 alpha.exr --specular ggx:0.2002
    error p50 ">=" 1e-4
}

other_distribution() {
    shade cone_beckmann_0.25 cone.exr --specular ggx:0.25
    error p50 ">=" 1e-2
}

other_masking() {
    shade "$1" masking.exr --masking "$2"
    error p99 ">=" 1e-3
}

# An anisotropic model of one alpha is the isotropic one, whatever the tangents are.
isotropic() {
    shade "$1" tangent.exr --specular "$2" --tangent "$3"
    error p99.9 "<=" "$4"
}

# The sun from a place far away: the directions differ by what its distance leaves.
distant() {
    name=ico_diffuse_fujii_0.3
    scene $name | awk -v CONVFMT=%.9g -v kind="$1" -v more="$2" '{
        split($4, l, "[,/]"); d = 2e5
        print "--light", kind ":" l[1] * d "," l[2] * d "," l[3] * d more "/" l[4] * d * d }' >"$scratch/light"
    tool "$data/$name.exr" "$scratch/distant.exr" --eye "$(scene $name | cut -d' ' -f2)" $(cat "$scratch/light") \
        $(model $name) >"$scratch/errors"
    error p50 "<=" 1e-4
    error p99.9 "<=" 2e-3
}

other_channel() {
    shade ico_diffuse_fujii_0.3 albedo.exr --albedo 1,1,0.999
    error p50 "<=" 1e-5
    error p99 ">=" 9e-4
}

check "two suns of half the strength agree" two_suns 0.5 p99.9 "<=" 2e-5
check "1e-4 of the light is noticed" two_suns 0.4999 p50 ">=" 9e-5
check "0.1 % of alpha is noticed" other_alpha
check "GGX is not Beckmann" other_distribution
check "the correlated Smith is not the separable one" other_masking knot_ggx_0.2 smith-correlated
check "V-cavities are not Smith" other_masking cone_beckmann_0.25 v-cavity
for axis in 0,0,1 1,-2,3; do
    check "ggx-anisotropic:0.2 along $axis is ggx:0.2" isotropic knot_ggx_0.2 ggx-anisotropic:0.2 $axis 2e-5
    check "beckmann-anisotropic:0.25 along $axis is beckmann:0.25" \
        isotropic cone_beckmann_0.25 beckmann-anisotropic:0.25 $axis 5e-5
done
check "a point light far away is a sun" distant point ""
check "a spot light far away is a sun" distant spot /0,1,0/179,180
check "one channel's error is noticed" other_channel

# ---- Kinds of files --------------------------------------------------------------------------------------------------

variants=$scratch/exr_variants

# With a directional light along z that is red 1, green 2, blue 4.
white() {
    tool "$1" "$2" --eye 0,-4,40 --light 0,0,3/1,2,4 --diffuse lambert
}

builds_variants() {
    $cc -std=gnu11 $(pkg-config --cflags OpenEXR) tests/exr_variants.c tests/exr.c -o "$variants" \
        $(pkg-config --libs OpenEXR) -lm
    "$variants" make "$data/knot_ggx_0.2.exr" "$scratch" >"$scratch/names"
    [ -s "$scratch/names" ]
}

reads_variant() {
    white "$scratch/$1.exr" "$scratch/$1.out.exr"
    "$variants" check "$scratch/$1.exr" "$scratch/$1.out.exr"
}

check "exr_variants builds and writes" builds_variants
for name in $(cat "$scratch/names"); do check "EXR file of the kind $name" reads_variant "$name"; done

same_variants() {
    for name in $(grep -v -e below -e above "$scratch/names"); do
        cmp "$scratch/plain.out.exr" "$scratch/$name.out.exr"
    done
}

replaces_input() {
    cp "$scratch/plain.exr" "$scratch/replaced.exr"
    white "$scratch/replaced.exr" "$scratch/replaced.exr"
    cmp "$scratch/plain.out.exr" "$scratch/replaced.exr"
}

keeps_link() {
    cp "$scratch/plain.exr" "$scratch/target.exr"
    ln -s target.exr "$scratch/link.exr"
    white "$scratch/plain.exr" "$scratch/link.exr"
    [ -h "$scratch/link.exr" ]
    cmp "$scratch/plain.out.exr" "$scratch/target.exr"
}

check "the same values in any kind of file give the same picture" same_variants
check "the output may be the input" replaces_input
check "an output that is a link stays one" keeps_link

# ---- Options ---------------------------------------------------------------------------------------------------------

good=$data/knot_ggx_0.2.exr
sunlit=$(scene knot_ggx_0.2)

# form KIND WORD: the word's numbers, as --list has them, with numbers in place of names; nothing where it has none.
form() {
    tool --list | awk -v kind="$1" -v word="$2" '$1 == kind && $2 == word && index($4, word ":") == 1 { print $4 }' |
        sed 's/,$//; s/\[.*//; s/^[^:]*//; s/X,Y,Z/0,-1,2/; s/AXIS/0,1,-2/; s/INNER,OUTER/10,20/; s/EXPONENT/5/
            s/[A-Z][A-Z0-9_]*/0.5/g'
}

# A distribution that a masking goes under, from --list.
distribution() {
    tool --list | awk -v word="$1" '$1 == "masking" && $2 == word { sub(/.*; with /, ""); sub(/,.*/, ""); print }'
}

# takes_word KIND WORD: with or without numbers, whichever it has; not both.
takes_word() {
    bare=0 with=0 numbers=$(form "$1" "$2") specular=ggx:0.3
    case $1:$2 in
    specular:*) specular=none ;;
    masking:*) specular=$(distribution "$2"):0.3 ;;
    convention:direct) ;;
    convention:*) specular=ggx ;;
    esac
    tool "$good" "$scratch/word.exr" $sunlit --tangent 0,0,1 --specular $specular "--$1" "$2" \
        2>"$scratch/bare" || bare=1
    tool "$good" "$scratch/word.exr" $sunlit --tangent 0,0,1 --specular $specular "--$1" "$2${numbers:-:0.5}" \
        2>"$scratch/with" || with=1
    if [ -n "$numbers" ]; then takes="1 0"; else takes="0 1"; fi
    [ "$bare $with" = "$takes" ] || { cat "$scratch/bare" "$scratch/with"; return 1; }
}

lists_words() {
    for kind in $kinds; do
        [ -n "$(words $kind '^ *available')" ] || { echo "no $kind"; return 1; }
    done
}

helps() {
    tool --help >"$scratch/help"
    for option in --eye --tangent --against --floor --list --diffuse --albedo --specular --masking --scale --fresnel \
        --polarisation --convention --coupled --emission --light --ambient --sh --arch --tier; do
        grep -q -e "^  $option" "$scratch/help" || { echo "lacks $option"; return 1; }
    done
}

equal_sign() {
    tool --eye=0,-4,40 --light=0,0,3/1,2,4 --diffuse=lambert "$scratch/plain.exr" "$scratch/equal.exr"
    cmp "$scratch/plain.out.exr" "$scratch/equal.exr"
}

# same WORDS WORDS: both lists of options give one picture, in the strict tier. differ: they do not.
picture() {
    tool "$good" "$scratch/$1" $sunlit --tier strict --tangent 0,0,1 $2
}

same() {
    picture first.exr "$1"
    picture second.exr "$2"
    cmp "$scratch/first.exr" "$scratch/second.exr"
}

differ() {
    picture first.exr "$1"
    picture second.exr "$2"
    ! cmp -s "$scratch/first.exr" "$scratch/second.exr" || { echo "the same picture"; return 1; }
}

kinds='diffuse specular masking fresnel convention light arch tier'
check "--help" helps
check "--list" lists_words
check "--NAME=VALUE, options before files" equal_sign
for kind in $kinds; do
    for word in $(words $kind '^ *available'); do check "--$kind $word" takes_word $kind "$word"; done
done

ggx='--diffuse none --specular ggx:0.25'
before='--fresnel schlick:0.04'
for metal in $(words metal '^ *available'); do
    check "--fresnel conductor:$metal differs" differ "$ggx $before" "$ggx --fresnel conductor:$metal"
    before="--fresnel conductor:$metal"
done
gold="$ggx --fresnel conductor:gold"
check "a metal in water differs" differ "$gold" "$gold/1.33"
check "polarisation differs" differ "$gold" "$gold --polarisation 1"
check "exact Fresnel and Schlick's differ" differ "$gold" "$ggx --fresnel schlick:gold"
check "a word alone keeps the numbers" same "$gold --fresnel schlick" "$ggx --fresnel schlick:gold"
check "numbers replace the numbers before" same "$gold --fresnel schlick:0.5" "$ggx --fresnel schlick:0.5"
check "one number is three" same "$ggx --fresnel conductor:0.5/3" "$ggx --fresnel conductor:0.5,0.5,0.5/3,3,3"
check "F90 differs" differ "$ggx --fresnel schlick:0.04" "$ggx --fresnel schlick:0.04/0"
check "F82 differs" differ "$ggx --fresnel schlick-f82:0.9/0.8" "$ggx --fresnel schlick-f82:0.9/0.7"
check "a dielectric under water differs" differ "$ggx --fresnel dielectric:1.5" "$ggx --fresnel dielectric:1.5/1.33"
check "--scale pi is 4/pi" same "$ggx --scale pi" "$ggx --scale 1.27323954"
check "--scale 1981 is 4" same "$ggx --scale 1981" "$ggx --scale 4"
check "--scale differs" differ "$ggx" "$ggx --scale 1981"
check "the tangent differs" differ "$ggx --specular ggx-anisotropic:0.1,0.4" \
    "$ggx --specular ggx-anisotropic:0.1,0.4 --tangent 1,0,0"
check "a tangent has no length and no sign" same "$ggx --specular ggx-anisotropic:0.1,0.4" \
    "$ggx --specular ggx-anisotropic:0.1,0.4 --tangent 0,0,-8"
check "along and across differ" differ "$ggx --specular beckmann-anisotropic:0.1,0.4" \
    "$ggx --specular beckmann-anisotropic:0.4,0.1"
check "--convention metallic-roughness" same \
    "--diffuse lambert --albedo 0.5 --specular ggx:0.25 --fresnel schlick:0.04" \
    "--diffuse lambert --specular ggx --fresnel schlick --convention metallic-roughness:0.5/0/0.5/0.5"
check "a specular level of 0 reflects nothing" same "--diffuse lambert --albedo 0.5" \
    "--diffuse lambert --specular ggx --fresnel constant --convention metallic-roughness:0.5/0/0.5/0"
check "--convention specular-glossiness" same "$gold" "$gold --specular ggx --convention specular-glossiness:0.5"
check "--coupled differs" differ "--specular ggx:0.25 --fresnel schlick:0.5" \
    "--specular ggx:0.25 --fresnel schlick:0.5 --coupled"
check "--emission differs" differ "$ggx" "$ggx --emission 0,0,0.1"
check "--ambient differs" differ "--diffuse lambert" "--diffuse lambert --ambient 0.1"
check "--sh differs" differ "--diffuse lambert" "--diffuse lambert --sh 0.1/0/0/0"
check "--sh has a direction" differ "--diffuse lambert --sh 0.1/0.1/0/0" "--diffuse lambert --sh 0.1/0/0.1/0"
check "a point light differs with its place" differ "--light point:0,-3,3/9" "--light point:0,-3,4/9"
check "a point light's range differs" differ "--light point:0,-3,3/9" "--light point:0,-3,3/9/5"
check "a spot light of 180 degrees is a point light" same "--light point:0,-3,3/9" \
    "--light spot:0,-3,3/0,1,-1/180,180/9"
check "a spot light's cone differs" differ "--light spot:0,-3,3/0,1,-1/5,10/9" "--light spot:0,-3,3/0,1,-1/5,12/9"

# ---- Refusals --------------------------------------------------------------------------------------------------------

# is_refused PATTERN WORD...: exit status 1, one line on stderr that matches, and nothing written.
is_refused() {
    pattern=$1
    shift
    refused_status=0
    mkdir "$scratch/refused"
    tool "$@" >"$scratch/stdout" 2>"$scratch/stderr" || refused_status=$?
    left=$(ls -A "$scratch/refused")
    rm -rf "$scratch/refused"
    cat "$scratch/stderr"
    [ $refused_status = 1 ] || { echo "exit status $refused_status"; return 1; }
    [ "$(wc -l <"$scratch/stderr")" -eq 1 ] || { echo "not one line on stderr"; return 1; }
    grep -q "^relight: .*$pattern" "$scratch/stderr" || { echo "does not say: $pattern"; return 1; }
    [ ! -s "$scratch/stdout" ] || { echo "output on stdout"; return 1; }
    none "left behind" "$left"
}

refused() {
    refused_name=$1
    shift
    check "refuses $refused_name" is_refused "$@"
}

out=$scratch/refused/out.exr

refused_file() {
    refused "$1" "$2" "$3" "$out" $sunlit --specular ggx:0.2
}

# patched NAME OFFSET OCTAL...: the good file with other bytes.
patched() {
    patched=$scratch/patched.$1.exr offset=$2
    shift 2
    cp "$good" "$patched"
    printf "$(printf '\\%s' "$@")" | dd of="$patched" bs=1 seek="$offset" conv=notrunc 2>/dev/null
}

# after TEXT: the offset of the byte behind its first occurrence.
after() {
    LC_ALL=C grep -abo "$1" "$good" | awk -F: -v length_="${#1}" 'NR == 1 { print $1 + length_ }'
}

size=$(wc -c <"$good")
for length in 0 3 8 100 800 1600 4000 $((size / 2)) $((size - 1)); do
    head -c "$length" "$good" >"$scratch/cut.$length.exr"
    refused_file "a file cut after $length bytes" "cut.$length.exr: ." "$scratch/cut.$length.exr"
done

patched magic 0 0
refused_file "a wrong magic number" "patched.magic.exr: ." "$patched"
patched version 4 177
refused_file "a version of the future" "patched.version.exr: ." "$patched"
patched flags 5 377
refused_file "unknown flags" "patched.flags.exr: ." "$patched"
patched channels $(($(after channels) - 1)) 170
refused_file "a header without channels" "patched.channels.exr: .*channels" "$patched"
patched list $(($(after chlist) + 4)) 177
refused_file "a channel list beyond the file" "patched.list.exr: ." "$patched"
patched window $(($(after dataWindow) + 22)) 177
refused_file "a data window beyond the file format's" "patched.window.exr: .*data window" "$patched"
patched pixels $(($(after dataWindow) + 21)) 177
refused_file "a data window of too many pixels" "8323200 x 128 is more than" "$patched"
patched empty $(($(after dataWindow) + 19)) 377 377 377 377
refused_file "an empty data window" "patched.empty.exr: .*data window" "$patched"
patched compression $(($(after 'compression.compression') + 5)) 143
refused_file "an unknown compression" "patched.compression.exr: .*compression" "$patched"
patched b44 $(($(after 'compression.compression') + 5)) 6
refused_file "B44 with float channels" "B44" "$patched"
patched sampling $(($(after 'Position.Y') + 9)) 2
refused_file "a subsampled channel" "Position.Y is subsampled" "$patched"
patched type $(($(after 'Position.Y') + 1)) 7
refused_file "an unknown type of pixels" "patched.type.exr: .*type" "$patched"
patched table $(($(after 'screenWindowWidth.float') + 10)) 377 377 377 377 377 377 377 177
refused_file "a chunk beyond the file" "patched.table.exr: ." "$patched"
patched data $((size - 2000)) 0 0 0 0 377 377 377 377
refused_file "damaged pixels" "patched.data.exr: ." "$patched"
patched missing $(($(after 'Position.Y') - 1)) 121
refused_file "a missing channel" "no channel ends in Position.Y" "$patched"
patched twice $(($(after 'ViewLayer.Norma') - 15)) 132
refused_file "a layer torn apart" "no part has all of Normal, Position" "$patched"

echo "not an EXR file" >"$scratch/text.exr"
refused_file "a text" "text.exr: ." "$scratch/text.exr"
refused_file "a file that is not there" "none.exr: No such file" "$scratch/none.exr"
refused_file "a directory as input" "not a regular file" "$scratch"
refused_file "radiance as a G-buffer" "no channel ends in Normal.X" "$scratch/plain.out.exr"

refused_output() {
    refused "$1" "$2" "$good" "$3" $sunlit --specular ggx:0.2
}

refused_output "an output in no directory" "No such file" "$scratch/none/out.exr"
refused_output "an output that is a directory" "Is a directory" "$scratch"
refused_output "an output under a file" "Not a directory" "$scratch/text.exr/out.exr"
if [ -c /dev/full ]; then
    refused_output "an output without space" "No space" /dev/full
else
    skip "refuses an output without space" "no /dev/full here"
fi

cut_short() {
    trap '' XFSZ
    ulimit -f 20
    is_refused "File too large" "$good" "$out" $sunlit --specular ggx:0.2
}

check "refuses an output that is cut short" cut_short

keeps_output() {
    echo precious >"$scratch/precious.exr"
    ! tool "$scratch/text.exr" "$scratch/precious.exr" $sunlit 2>/dev/null
    ! tool "$good" "$scratch/precious.exr" $sunlit --against None 2>/dev/null
    [ "$(cat "$scratch/precious.exr")" = precious ]
}

check "an output that is there survives a refusal" keeps_output

refused "no files" "IN.exr is missing"
refused "no output" "OUT.exr is missing" "$good" $sunlit
refused "no eye" "--eye X,Y,Z is missing" "$good" "$out" --light 0,0,1/1
refused "no light" "--light X,Y,Z/E is missing" "$good" "$out" --eye 0,0,1
refused "three files" "third.exr" "$good" "$out" third.exr $sunlit
refused "an unknown option" "--colour: no such option" "$good" "$out" $sunlit --colour red
refused "an option without its value" "--diffuse needs a value" "$good" "$out" $sunlit --diffuse

refused "an anisotropic model without --tangent" "--tangent X,Y,Z is missing" "$good" "$out" $sunlit \
    --specular ggx-anisotropic:0.1,0.4
refused "a masking of other distributions" "allowed with ggx: .*smith-correlated" "$good" "$out" $sunlit \
    --specular ggx:0.2 --masking smith-exact
refused "a number that a convention has" "--specular: --convention metallic-roughness stands in" "$good" "$out" \
    $sunlit --convention metallic-roughness:0.5/0/0.5 --specular ggx:0.2
refused "the light of 65" "at most 64 lights" "$good" "$out" --eye 0,0,1 \
    $(for i in 1 2 3 4 5 6 7 8 9 10 11 12 13; do echo --light 0,0,1 --light 0,1,1 --light 1,0,1 --light 1,1,1 \
        --light point:0,0,1; done)

# Option values: what stands before the colon is the option.
for value in diffuse:velvet diffuse: diffuse:fujii diffuse:fujii: diffuse:fujii:x diffuse:fujii:0.3x \
    diffuse:fujii:2 diffuse:fujii:-1 diffuse:fujii:nan diffuse:fujii:0.1,0.2,0.3 diffuse:lambert:0.5 \
    diffuse:LAMBERT diffuse:oren-nayar-full:1.6 diffuse:eon:1.1 diffuse:eon:0.5/1 specular:ggx specular:ggx:-1 \
    specular:ggx:inf specular:none:1 specular:beckmann specular:beckmann:0.2,0.3 \
    specular:ggx-anisotropic:0.1,0.2,0.3 specular:beckmann-anisotropic:0.1, specular:ggx-anisotropic \
    specular:phong specular:phong:0.5 specular:phong:1e5 specular:phong-modified: specular:blinn-phong:x \
    specular:blinn-phong-normalised:1/2 masking:smit masking:smith:1 masking:v-cavit fresnel:two fresnel:schlick \
    fresnel:schlick:2 fresnel:schlick:0.1,0.2 fresnel:schlick:0.1/2 fresnel:schlick:0.1/0.2/0.3 \
    fresnel:constant:-0.1 fresnel:constant:0.1/1 fresnel:one:0.5 fresnel:schlick-f82 fresnel:schlick-f82:0.5 \
    fresnel:schlick-f82:0.5/1.5 fresnel:dielectric fresnel:dielectric:0 fresnel:dielectric:gold \
    fresnel:dielectric:1.5/0 fresnel:conductor fresnel:conductor:brass fresnel:conductor:gold/ \
    fresnel:conductor:gold/0 fresnel:conductor:0.2 fresnel:conductor:0.2/-1 fresnel:conductor:0.2,0.3/1 \
    fresnel:conductor:/3 fresnel:conductor:nan/1 scale:0 scale:-1 scale:4x scale:1e7 polarisation:2 polarisation:x \
    convention:metallic convention:metallic-roughness convention:metallic-roughness:0.5/0 \
    convention:metallic-roughness:2/0/0.5 convention:metallic-roughness:0.5/0/0.5/0.5/0.5 \
    convention:specular-glossiness convention:specular-glossiness:1.5 convention:direct:1 emission:-1 ambient:x \
    sh:1/2/3 sh:1/2/3/4/5 sh:1,2/2/3/4 tangent:0,0,0 tangent:1,2 floor:-1 floor:x albedo:1,2 albedo:-1 \
    albedo:1,1,1,1 albedo:nan arch:vax tier:slow eye:1,2 eye:1,2,3,4 eye:1,2,inf eye:1,,2 eye:1,2,1e39 light:0,0 \
    light:0,0,0/1 light:0,0,1/nan light:0,0,1/1,2 light:0,0,1/-1 light:0,0,1,1 light:0,0,1/0 light:x,0,1/1 \
    light:0,0,1/1,2,3,4 light:area:0,0,1 light:point light:point: light:point:0,0 light:point:0,0,1/1/0 \
    light:directional:0,0,1/1/1 light:spot:0,0,1 light:spot:0,0,1/0,0,1 light:spot:0,0,1/0,0,0/10,20 \
    light:spot:0,0,1/0,0,1/20,10 light:spot:0,0,1/0,0,1/10 light:spot:0,0,1/0,0,1/10,190 against:Absent against:; do
    case $value in fresnel:* | masking:*) specular=ggx:0.2 ;; convention:*) specular=ggx ;; *) specular=none ;; esac
    refused "--${value%%:*} '${value#*:}'" . "$good" "$out" --eye 0,-4,1 --light 0,-1,1/3 --tangent 0,0,1 \
        --specular $specular "--${value%%:*}" "${value#*:}"
done
for arch in $(words arch '^ *not '); do refused "--arch $arch" "allowed: " "$good" "$out" $sunlit --arch "$arch"; done
refused "to compare nothing" "no pixel to compare" "$good" "$out" --eye 0,-4,1 --light 0,9,-1/1 --light 0,-9,1/1 \
    --against GlossDir
refused "to compare nothing above the floor" "no pixel to compare" "$good" "$out" $sunlit $(model knot_ggx_0.2) \
    --floor 1e30
refused "a file name with control characters" "a?b" "$(printf 'a\nb')" "$out" $sunlit

[ $failures = 0 ]
