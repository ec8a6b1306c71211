#!/bin/sh
# sh tests/demo.sh BUILD_DIR: checks BUILD_DIR/facet-demo from outside. RUN: what runs it, such as an emulator.
# FACET_SLOW=1: an emulator or a sanitizer slows it down, and the time limit is skipped.
set -u

if [ $# -ne 1 ] || [ ! -f "$1/facet-demo" ]; then
    echo "usage: sh tests/demo.sh BUILD_DIR, with BUILD_DIR/facet-demo built" >&2
    exit 2
fi
binary=$(cd "$1" && pwd)/facet-demo
scratch=$1/tests/demo
rm -rf "$scratch"
mkdir -p "$scratch/directory.obj" && cd "$scratch" || exit 2

failed=0
ok()   { echo "ok demo: $1"; }
fail() { echo "FAIL demo: $1: $2"; failed=1; }
skip() { echo "skip demo: $1: $2"; }

demo() { ${RUN:-} "$binary" "$@"; }
small() { demo --time 0 --size 48x40 "$@" > out.txt 2> err.txt; }

# verdict NAME WHY: ok where WHY is empty.
verdict() { if [ -z "$2" ]; then ok "$1"; else fail "$1" "$2"; fi; }

# same NAME FILE FILE, and its opposite
same() { if cmp -s "$2" "$3"; then ok "$1"; else fail "$1" "$2 and $3 differ"; fi; }
differ() { if cmp -s "$2" "$3"; then fail "$1" "$2 and $3 are the same"; else ok "$1"; fi; }

# renders NAME ARGUMENTS...
renders() {
    name=$1
    shift
    if small "$@" -o picture.png; then ok "$name"; else fail "$name" "$(cat err.txt)"; fi
}

# ---- Refusals --------------------------------------------------------------------------------------------------------

# Address space that is plenty for the demo, in KiB; an emulator or a sanitizer may not start in it.
limit=1000000
bounded=1
(ulimit -v $limit && demo --help) > out.txt 2>&1 || bounded=0

# refused NAME PATTERN ARGUMENTS...: exit status 1, one line on stderr that matches PATTERN, and no picture.
refused() {
    name=$1 pattern=$2 why=
    shift 2
    rm -f refused.png
    (
        [ $bounded -eq 0 ] || ulimit -v $limit
        demo --time 0 --size 48x40 -o refused.png "$@"
    ) < "${input:-/dev/null}" > out.txt 2> err.txt
    status=$?
    [ $status -eq 1 ] || why="exit status $status"
    [ "$(wc -l < err.txt)" -eq 1 ] || why="$why $(wc -l < err.txt) lines on stderr"
    grep -q "^facet-demo: .*$pattern" err.txt || why="$why says: $(head -n 1 err.txt)"
    [ ! -s out.txt ] || why="$why output on stdout"
    [ ! -e refused.png ] || why="$why wrote a picture"
    verdict "$name" "$why"
}

triangle='v 0 0 0\nv 1 0 0\nv 0 1 0\n'
: > empty.obj
printf "$triangle" > no-faces.obj
printf "${triangle}f 1 2 3\nv 0 0" > cut-number.obj
printf "${triangle}f 1 2" > cut-face.obj
printf "${triangle}f 1 2 4\n" > above.obj
printf "${triangle}f 1 2 -4\n" > below.obj
printf "${triangle}f 1 2 0\n" > zero.obj
printf "${triangle}f 1 2 99999999999999999999\n" > overflow.obj
printf "${triangle}vn 0 0 1\nf 1//1 2//1 3//2\n" > normal.obj
printf "${triangle}f 1/1 2/1 3/1\n" > texture.obj
printf "${triangle}f 1 2 x\n" > word.obj
printf "${triangle}f 1//// 2 3\n" > slashes.obj
printf 'v 0 nan 0\n' > nan.obj
printf "${triangle}vn 0 0 inf\n" > infinity.obj
printf 'v 0 1e39 0\n' > range.obj
printf 'v 1 1 1\nf 1 1 1\n' > point.obj
printf "${triangle}f 1 2 3\n\001\002\003\n" > control.obj
{ printf "${triangle}#"; awk 'BEGIN { while (i++ < 70000) printf "x" }'; printf '\nf 1 2 3\n'; } > long.obj
{ printf "${triangle}f 1"; awk 'BEGIN { while (i++ < 40000) printf " 2" }'; printf '\n'; } > long-face.obj
head -c 65536 "$binary" > binary.obj

refused "missing file" 'missing.obj: No such file' missing.obj
refused "directory" 'directory.obj:1: Is a directory' directory.obj
refused "empty file" 'empty.obj:1: ' empty.obj
refused "no faces" 'no-faces.obj:4: ' no-faces.obj
refused "truncated in a number" 'cut-number.obj:5: ' cut-number.obj
refused "truncated in a face" 'cut-face.obj:4: ' cut-face.obj
refused "index above the last" 'above.obj:4: vertex 4 ' above.obj
refused "index below the first" 'below.obj:4: vertex -4 ' below.obj
refused "index 0" 'zero.obj:4: vertex 0 ' zero.obj
refused "index beyond any integer" 'overflow.obj:4: vertex ' overflow.obj
refused "normal out of range" 'normal.obj:5: normal 2 ' normal.obj
refused "texture coordinate out of range" 'texture.obj:4: texture coordinate 1 ' texture.obj
refused "word for an index" 'word.obj:4: ' word.obj
refused "too many slashes" 'slashes.obj:4: ' slashes.obj
refused "NaN coordinate" 'nan.obj:1: ' nan.obj
refused "infinite normal" 'infinity.obj:4: ' infinity.obj
refused "coordinate beyond float" 'range.obj:1: ' range.obj
refused "one point" 'point.obj: ' point.obj
refused "control characters" 'control.obj:5: ' control.obj
refused "line of 70000 bytes" 'long.obj:4: ' long.obj
refused "face of 80000 bytes" 'long-face.obj:4: ' long-face.obj
refused "binary file" 'binary.obj:[0-9]*: ' binary.obj

if [ -r /dev/stdin ] && [ -z "${FACET_SLOW:-}" ]; then
    mkfifo endless
    input=endless
    yes 'v 1 2 3' > endless 2> yes.txt &
    refused "endless vertices" 'stdin:8388609: ' /dev/stdin
    { printf "$triangle"; yes 'f 1 2 3'; } > endless 2> yes.txt &
    refused "endless faces" 'stdin:8388612: ' /dev/stdin
    input=
    wait
else
    skip "endless vertices" "too slow here, or no /dev/stdin"
    skip "endless faces" "too slow here, or no /dev/stdin"
fi

if [ $bounded -eq 1 ]; then ok "bad files within $limit KiB of address space"
else skip "bad files within $limit KiB of address space" "the program does not start in it (emulator or sanitizer)"; fi

# ---- Options ---------------------------------------------------------------------------------------------------------

refused "unknown option" 'no such option; --help' --nonsense
refused "unknown short option" 'no such option; --help' -x
refused "two meshes" 'one mesh is allowed' teapot sphere
refused "a mesh for balls" 'have balls of their own' --metals teapot
refused "panels of balls" '--grid: .* no panels' --grid --metals
refused "option without its value" 'needs a value' --albedo
refused "switch with a value" 'takes no value' --grid=3
refused "light without direction" 'allowed: ' --light 0,0,0
refused "light without irradiance" 'allowed: ' --light 0,0,1/0
refused "65 lights" 'at most 64 lights' $(i=0; while [ $i -lt 65 ]; do echo --light 0,0,1; i=$(( i + 1 )); done)
refused "picture too large" 'samples or pixels' --size 8192x8192
refused "sigma beyond the model's domain" 'SIGMA from 0 to 1$' --diffuse fujii:1.5
refused "a model without its numbers" 'phong needs its numbers: phong:EXPONENT' --specular phong
refused "a conductor without a metal" 'needs its numbers: conductor:ETA/K.* or conductor:METAL' --fresnel conductor
refused "no such metal" 'conductor:METAL.*: .*, gold, ' --fresnel conductor:brass
refused "a surface without an albedo" 'lambert needs --albedo' --preset gold --diffuse lambert
refused "a masking of other distributions" 'allowed with ggx: ' --masking smith-exact
refused "a number that a convention has" 'stands in' --convention metallic-roughness:1/0/1 --albedo 1
refused "a spot light inside out" 'INNER' --light spot:0,0,3/0,0,-1/20,10
refused "picture that cannot be written" 'No such file' -o nowhere/picture.png
refused "picture that is a directory" 'Is a directory' -o directory.obj

for case in diffuse:phong diffuse:fujii: diffuse:lambert:1 specular:velvet specular:ggx:2 specular:ggx:0 \
            specular:ggx:-1 specular:ggx:nan specular:ggx:1x specular:ggx-anisotropic:0.1,0.2,0.3 \
            specular:phong:0.5 specular:none:1 masking:none masking:smith:1 fresnel:exact fresnel:schlick:x \
            fresnel:schlick:0.1/-1 fresnel:one:1 fresnel:schlick-f82:0.5 fresnel:dielectric:0 \
            fresnel:conductor:gold/0 fresnel:conductor:1 scale:0 polarisation:-2 convention:metallic-roughness:1/0 \
            convention:specular-glossiness:2 arch:z80 tier:slow preset:teapot rig:none size:12 size:0x1 \
            size:1x99999 size:-1x5 samples:3 albedo:1,2 albedo:0,0,1.5 emission:-1 ambient:inf sh:1/2/3 light:1,2 \
            light:x light:area:0,0,1 light:point:0,0,1/1/0 exposure:-1 background:blue fov:0 distance:0 \
            elevation:91 time:-1 threads:0 threads:-1 threads:1.5 threads:2x threads:257 \
            threads:18446744073709551617; do
    refused "--${case%%:*} ${case#*:}" "--${case%%:*} .*allowed: " "--${case%%:*}" "${case#*:}"
done

why=
demo --help > help.txt 2> err.txt && [ ! -s err.txt ] || why="status or stderr"
for word in --preset --metals --grazing --grid --compare --rig --size --samples --background --pfm --two-sided \
            --threads --list --help --diffuse --albedo --specular --masking --scale --fresnel --polarisation \
            --convention --coupled --emission --light --ambient --sh --arch --tier; do
    grep -q -- "$word" help.txt || why="$why lacks $word"
done
verdict "--help" "$why"

why=
demo --list > list.txt 2> err.txt && [ ! -s err.txt ] || why="status or stderr"
for kind in diffuse specular masking fresnel metal convention light arch tier rig preset; do
    grep -q "^$kind " list.txt || why="$why lacks $kind"
done
verdict "--list" "$why"

# form WORD TEXT: the word and its numbers, as the list has them in TEXT, with numbers in place of names.
form() {
    case $2 in
    "$1:"*)
        echo "${2%% *}" | sed 's/,$//; s/\[.*//; s/X,Y,Z/-1,2,2/; s/AXIS/1,-2,-2/; s/INNER,OUTER/20,30/; s/EXPONENT/5/
                               s/\([:,/]\)[A-Z][A-Z0-9_]*/\10.5/g' ;;
    *) echo "$1" ;;
    esac
}

# Every listed word is an option's value, with the numbers that the list asks for; what is not available is refused.
while read -r kind word state text; do
    case $kind:$state in
    preset:* | rig:*) renders "--$kind $word" --$kind "$word" ;;
    metal:available*) renders "--fresnel conductor:$word" --fresnel "conductor:$word" ;;
    masking:available:*)
        under=${text##*; with }
        renders "--masking $word" --specular "${under%%,*}:0.3" --masking "$word" ;;
    convention:available:*)
        specular=ggx:0.3
        [ "$(form "$word" "$text")" = "$word" ] || specular=ggx
        renders "--convention $word" --preset chalk --fresnel schlick:0.04 --convention "$(form "$word" "$text")" \
            --specular $specular ;;
    *:available*) renders "--$kind $(form "$word" "$text")" --$kind "$(form "$word" "$text")" ;;
    metal:*) refused "--fresnel conductor:$word is refused" 'allowed: ' --fresnel "conductor:$word" ;;
    *) refused "--$kind $word is refused" 'allowed: ' --$kind "$word" ;;
    esac
done < list.txt

# ---- Pictures --------------------------------------------------------------------------------------------------------

# One byte a line.
bytes() { od -An -v -tu1 "$1" | tr -s ' \n' '\n\n' | sed '/^$/d'; }

# chunks FILE: "type offset size" of the data of each.
chunks() {
    bytes "$1" | awk '{ b[NR - 1] = $1 } END {
        for (at = 8; at < NR; at += 12 + size) {
            size = ((b[at] * 256 + b[at + 1]) * 256 + b[at + 2]) * 256 + b[at + 3]
            printf "%c%c%c%c %d %d\n", b[at + 4], b[at + 5], b[at + 6], b[at + 7], at + 8, size
        } }'
}

# slice FILE OFFSET SIZE
slice() { tail -c +$(( $2 + 1 )) "$1" | head -c "$3"; }

# hex: standard input's bytes
hex() { od -An -v -tx1 | tr -d ' \n'; }

# png_text FILE: "width height channels", then a pixel a line, undone from the deflate stream by gzip and from its
# filters here. The zlib stream becomes gzip's by another header; gzip then misses its own trailer, which is expected.
png_text() {
    slice "$1" 16 10 > header.bin
    set -- "$1" $(bytes header.bin) $(chunks "$1" | sed -n 's/^IDAT //p')
    channels=$(( ${11} == 6 ? 4 : 3 ))
    echo "$(( $4 * 256 + $5 )) $(( $8 * 256 + $9 )) $channels"
    { printf '\037\213\010\0\0\0\0\0\0\003'; slice "$1" $(( ${12} + 2 )) $(( ${13} - 6 )); } |
        gzip -dc 2> gzip.txt > rows.bin
    bytes rows.bin | awk -v width=$(( $4 * 256 + $5 )) -v channels=$channels '
        function abs(x) { return x < 0 ? -x : x }
        function paeth(a, b, c) {
            pa = abs(b - c); pb = abs(a - c); pc = abs(a + b - 2 * c)
            return pa <= pb && pa <= pc ? a : pb <= pc ? b : c
        }
        at == 0 { filter = $1; at = 1; next }
        {
            i = at - 1
            a = i >= channels ? row[i - channels] : 0; b = up[i] + 0; c = i >= channels ? up[i - channels] + 0 : 0
            guess[0] = 0; guess[1] = a; guess[2] = b; guess[3] = int((a + b) / 2); guess[4] = paeth(a, b, c)
            row[i] = ($1 + guess[filter]) % 256
            printf "%d%s", row[i], at % channels ? " " : "\n"
            if (at++ == width * channels) { at = 0; for (k in row) up[k] = row[k] }
        }'
}

# pfm_text FILE: "width height 3", then the radiance of a pixel a line, the top row first.
pfm_text() {
    set -- "$1" $(head -n 2 "$1" | tail -n 1)
    echo "$2 $3 3"
    tail -c +$(( $(head -n 3 "$1" | wc -c) + 1 )) "$1" > floats.bin
    bytes floats.bin | awk -v width="$2" '
        function value(b0, b1, b2, b3,   e, m) {
            e = (b3 % 128) * 2 + int(b2 / 128); m = (b2 % 128 * 256 + b1) * 256 + b0
            return e ? (1 + m / 8388608) * 2 ^ (e - 127) : m / 8388608 * 2 ^ -126
        }
        { b[(NR - 1) % 12] = $1 }
        NR % 12 == 0 {
            pixel[count++] = sprintf("%.9g %.9g %.9g", value(b[0], b[1], b[2], b[3]), value(b[4], b[5], b[6], b[7]),
                                     value(b[8], b[9], b[10], b[11]))
        }
        END { for (y = count / width - 1; y >= 0; y--) for (x = 0; x < width; x++) print pixel[y * width + x] }'
}

# srgb_text: radiance from pfm_text as the bytes of IEC 61966-2-1.
srgb_text() {
    awk 'function srgb(x) {
            x = x > 1 ? 1 : x
            return int(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ^ (1 / 2.4) - 0.055) + 0.5)
        }
        NR == 1 { print } NR > 1 { print srgb($1), srgb($2), srgb($3) }'
}

# crcs FILE: "found computed" of each chunk; gzip computes them, and stores them with the low byte first.
crcs() {
    chunks "$1" | while read -r type from size; do
        echo "$(slice "$1" $(( from + size )) 4 | hex)" \
            "$(slice "$1" $(( from - 4 )) $(( size + 4 )) | gzip -nc | tail -c 8 | head -c 4 | hex |
                sed 's/\(..\)\(..\)\(..\)\(..\)/\4\3\2\1/')"
    done
}

adler() {
    bytes "$1" | awk 'BEGIN { a = 1 } { a = (a + $1) % 65521; b = (b + a) % 65521 }
        END { printf "%02x%02x%02x%02x\n", int(b / 256), b % 256, int(a / 256), a % 256 }'
}

small -o picture.png --pfm picture.pfm
verdict "stderr stays empty" "$(cat err.txt)"
signature=$(head -c 8 picture.png | hex)
[ "$signature" = 89504e470d0a1a0a ] && why= || why=$signature
verdict "PNG signature" "$why"
[ "$(wc -c < picture.pfm)" -eq $(( 3 + 6 + 5 + 48 * 40 * 12 )) ] && why= || why="$(wc -c < picture.pfm) bytes"
verdict "PFM size" "$why"
size=$(wc -c < picture.png)
[ "$size" -gt 1000 ] && [ "$size" -lt $(( 48 * 40 * 3 )) ] && why= || why="$size bytes"
verdict "PNG size" "$why"

if command -v gzip > /dev/null; then
    crcs picture.png > crcs.txt
    [ "$(wc -l < crcs.txt)" -ge 3 ] && awk '$1 != $2 { exit 1 }' crcs.txt && why= || why="$(cat crcs.txt)"
    verdict "PNG chunk CRCs" "$why"
    png_text picture.png > png.txt
    [ "$(wc -c < rows.bin)" -eq $(( 40 * (1 + 3 * 48) )) ] && why= || why="$(wc -c < rows.bin) bytes of rows"
    verdict "PNG deflate stream" "$why"
    found=$(tail -c 20 picture.png | head -c 4 | hex)
    [ "$found" = "$(adler rows.bin)" ] && why= || why="$found, and the rows have $(adler rows.bin)"
    verdict "PNG Adler checksum" "$why"
    pfm_text picture.pfm | srgb_text > pfm.txt
    same "PNG holds the sRGB bytes of the PFM" png.txt pfm.txt

    small sphere --background none -o picture.png
    png_text picture.png > png.txt
    awk 'NR == 1 && $3 != 4 || NR == 2 && $4 != 0 || NR == 2 + 20 * 48 + 24 && $4 != 255 { exit 1 }' png.txt && why= ||
        why="$(awk 'NR <= 2 || NR == 2 + 20 * 48 + 24' png.txt)"
    verdict "--background none: opaque inside, transparent outside" "$why"

    small --compare --preset clay -o picture.png && png_text picture.png > png.txt
    small --preset clay --diffuse lambert -o left.png && png_text left.png > left.txt
    small --preset clay -o right.png && png_text right.png > right.txt
    awk 'NR == 1 { print 48, $2, $3 } NR > 1 && (NR - 2) % 96 < 48' png.txt > left-half.txt
    awk 'NR == 1 { print 48, $2, $3 } NR > 1 && (NR - 2) % 96 >= 48' png.txt > right-half.txt
    same "--compare: Lambert on the left" left.txt left-half.txt
    same "--compare: Oren-Nayar on the right" right.txt right-half.txt
    differ "--compare: one half and the other" left.txt right.txt

    small --grid --size 12x10 -o picture.png && png_text picture.png > png.txt
    [ "$(head -n 1 png.txt)" = "72 40 3" ] && why= || why="$(head -n 1 png.txt)"
    verdict "--grid: 6 by 4 panels" "$why"

    # More than deflate's window of 32768 bytes, and much of it repeats.
    small --grid --size 48x48 -o picture.png && png_text picture.png > png.txt
    found=$(tail -c 20 picture.png | head -c 4 | hex)
    [ "$found" = "$(adler rows.bin)" ] && why= || why="$found, and the rows have $(adler rows.bin)"
    verdict "PNG beyond the window" "$why"
else
    for name in "PNG chunk CRCs" "PNG deflate stream" "PNG Adler checksum" "PNG holds the sRGB bytes of the PFM" \
                "--background none" "--compare" "--grid" "PNG beyond the window"; do
        skip "$name" "no gzip here"
    done
fi

# ---- Rasterizing -----------------------------------------------------------------------------------------------------

# A Lambertian sphere of radius 1 under one light of 3 (at 1:2:3, of 30, where it is a point or a spot light): radiance
# = nl E / pi where the ray through the pixel meets it. Pixels across its outline or the shadow's are left out.
sphere_radiance() {
    samples=$1 light=$2
    small sphere --diffuse lambert --albedo 1 --specular none --ambient 0 --light "$light" --distance 3 --fov 40 \
        --samples $samples --background 0.5 -o picture.png --pfm picture.pfm
    why=$(pfm_text picture.pfm | awk -v kind="${light%%:*}" '
      NR == 1 { width = $1; height = $2; pi = atan2(0, -1); next } {
        x = (NR - 2) % width + 0.5 - width / 2; y = height / 2 - int((NR - 2) / width) - 0.5
        z = -height / 2 / (sin(pi / 9) / cos(pi / 9))
        size = sqrt(x * x + y * y + z * z); x /= size; y /= size; z /= size
        inside = 9 * z * z - 8; nl = -1; E = 3
        if (inside > 0) {
            t = -3 * z - sqrt(inside); nx = x * t; ny = y * t; nz = z * t + 3
            lx = 1; ly = 2; lz = 3
            if (kind == "point" || kind == "spot") { lx -= nx; ly -= ny; lz -= nz }
            far = sqrt(lx ^ 2 + ly ^ 2 + lz ^ 2); nl = (nx * lx + ny * ly + nz * lz) / far
            if (kind == "point" || kind == "spot") E = 30 / far ^ 2
            if (kind == "spot") {
                c = (lx + 2 * ly + 3 * lz) / sqrt(14) / far
                u = (c - cos(pi / 15)) / (cos(pi / 45) - cos(pi / 15)); u = u < 0 ? 0 : u > 1 ? 1 : u
                E *= u * u * (3 - 2 * u)
            }
        }
        if (inside > -0.1 && inside < 0.1 || nl > -0.15 && nl < 0.15) next
        want = inside < 0 ? 0.5 : nl > 0 ? nl * E / pi : 0
        if (($1 - want) ^ 2 > (0.003 + 0.01 * (kind == "spot")) ^ 2) bad = bad " " NR ": " $1 " not " want
        lit += nl > 0 && E > 0
    } END { print bad (lit < 200 ? " only " lit " pixels lit" : "") }')
    verdict "a sphere's radiance, $samples samples a pixel, --light $light" "$(echo $why)"
}

for samples in 1 4 16; do sphere_radiance $samples 1,2,3/3; done
sphere_radiance 1 point:1,2,3/30
sphere_radiance 1 spot:1,2,3/-1,-2,-3/4,12/30

# covered FACES...: the samples that these faces of corners.obj cover; all corners count for the fit.
covered() {
    { cat corners.obj; awk '$1 == "v" { n++; print "f", n, n, n }' corners.obj; cat "$@"; } > part.obj
    demo --time 0 --size 49x41 --samples 1 --azimuth 0 --elevation "$elevation" --distance "$distance" \
        --emission 1 --background 0 part.obj -o part.png | sed -n 's/.* \([0-9]*\) samples covered$/\1/p'
}

# partition NAME LEAST: the faces cover so many samples, and each of them once.
partition() {
    sum=0 count=0
    while read -r face; do
        echo "$face" > face.obj
        sum=$(( sum + $(covered face.obj) )) count=$(( count + 1 ))
    done < faces.obj
    all=$(covered faces.obj)
    [ "$all" -ge "$2" ] && [ "$sum" -eq "$all" ] && why= || why="$all samples, and $sum by $count faces one by one"
    verdict "each sample belongs to one triangle: $1" "$why"
}

# Edges through the middles of samples: the middle of an odd picture is one.
printf 'v 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nv -9 9 0\nv -9 0 0\nv -9 -9 0\nv 0 -9 0\nv 9 -9 0\n' > corners.obj
printf 'f 1 2 3\nf 3 4 1\nf 1 4 5\nf 1 5 6\nf 7 1 6\nf 1 7 8\nf 8 9 1\nf 1 9 2\n' > faces.obj
elevation=0 distance=0.5
partition "a star" $(( 49 * 41 ))
awk 'BEGIN {
    srand(1); n = 4
    for (j = 0; j <= n; j++) for (i = 0; i <= n; i++)
        printf "v %.4f %.4f 0\n", i - n / 2 + (i % n ? rand() * 0.8 : 0), j - n / 2 + (j % n ? rand() * 0.8 : 0)
}' > corners.obj
awk 'BEGIN { n = 4; for (j = 0; j < n; j++) for (i = 1; i <= n; i++) {
    a = j * (n + 1) + i
    printf "f %d %d %d\nf %d %d %d\n", a, a + 1, a + n + 2, a, a + n + 2, a + n + 1
} }' > faces.obj
elevation=10 distance=1
partition "an uneven sheet" $(( 49 * 41 ))
elevation=85 distance=0.05
partition "a sheet from before the eye to behind it" 1000
renders "eye inside the mesh" teapot --distance 0.01 --fov 150

# ---- Meshes: the same solid in every notation ------------------------------------------------------------------------

solid='v 1 1 1\nv 1 -1 -1\nv -1 1 -1\nv -1 -1 1\n'
printf "${solid}f 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n" > plain.obj
printf "# solid\r\no s\r\n${solid}vt 0 0\r\nf 1/1 2/1 3/1\r\nf 1 3 4\nf 1 4 2\ns off\nf 2 4 3" > textured.obj
printf "${solid}f -4 -3 -2\nf -4 -2 -1\nf -4 -1 \\\\\n-3\n\t f  2 4 3 # last\n" > negative.obj
printf "${solid}f 1 2 3 4\nf 1 4 2\nf 2 4 3\n" > fan.obj
small plain.obj -o plain.png
for mesh in textured negative fan; do
    small $mesh.obj -o $mesh.png
    same "OBJ: $mesh is the plain solid" plain.png $mesh.png
done
printf "${triangle}vn 0 0 1\nf 1//1 2//1 3//1\n" > normals.obj
printf "${triangle}vt 0 0\nvn 0 0 5\nf 1/1/-1 2/1/-1 3/1/-1\n" > longer.obj
printf "${triangle}f 1 2 3\n" > front.obj
printf "${triangle}f 3 2 1\n" > back.obj
small normals.obj -o normals.png
small longer.obj -o longer.png
small front.obj -o front.png
small back.obj -o back.png
small back.obj --two-sided -o two-sided.png
same "OBJ: v/vt/vn as v//vn, of any length" normals.png longer.png
same "OBJ: a triangle's own normal where there is none" normals.png front.png
same "--two-sided lights a back as a front" front.png two-sided.png
differ "a back is not lit as a front" front.png back.png
small plain.obj --flat -o flat.png
differ "--flat and smooth" plain.png flat.png

# ---- Models and lights -----------------------------------------------------------------------------------------------

# changes NAME ARGUMENTS... -- ARGUMENTS...: two pictures that differ.
changes() {
    name=$1 first=
    shift
    while [ "$1" != -- ]; do first="$first $1"; shift; done
    shift
    small $first -o one.png --pfm one.pfm
    small "$@" -o other.png --pfm other.pfm
    differ "$name" one.pfm other.pfm
}

changes "--fresnel" --preset gold -- --preset gold --fresnel schlick
changes "--masking" --preset cook-torrance -- --preset cook-torrance --masking smith
changes "--scale" --preset cook-torrance -- --preset cook-torrance --scale 1981
changes "--polarisation" --preset enamel -- --preset enamel --polarisation -1
changes "a medium around" --preset obsidian -- --preset obsidian --fresnel dielectric:1.49/1.33
changes "along and across" --preset brushed -- --preset brushed --specular ggx-anisotropic:0.5,0.15
changes "--convention" --preset chalk -- --preset chalk --specular ggx --fresnel schlick \
    --convention metallic-roughness:0.85/0/0.5
changes "--rig" --preset gold -- --preset gold --rig boxes
changes "--sh" --preset chalk -- --preset chalk --sh 0.3/0.2/0/0
changes "--metals under another distribution" --metals -- --metals --specular beckmann:0.2
changes "--metals under Schlick's Fresnel" --metals -- --metals --fresnel schlick
changes "--grazing under another light" --grazing -- --grazing --light 0,0,1

# The picture's size stays what it was asked to be, wherever that stands.
demo --size 30x20 --metals --time 0 -o one.png > out.txt && demo --metals --time 0 --size 30x20 -o other.png > out.txt
same "--metals: an option before it and behind it" one.png other.png

# Beside ambient light alone, a sample without a tangent would be black.
for mesh in teapot sphere plain.obj "plain.obj --flat"; do
    small $mesh --diffuse lambert --albedo 1 --specular ggx-anisotropic:0.1,0.4 --ambient 3 --samples 1 --background 1 \
        -o picture.png --pfm picture.pfm
    why=$(pfm_text picture.pfm | awk 'NR > 1 && $1 < 0.9 { print NR ": " $1 }' | head -n 3)
    verdict "tangents everywhere: $mesh" "$(echo $why)"
    small $mesh --preset gold --samples 1 -o one.png --pfm one.pfm
    small $mesh --preset gold --samples 1 --specular ggx-anisotropic:0.35 -o other.png --pfm other.pfm
    pfm_text one.pfm > one.txt
    why=$(pfm_text other.pfm | paste - one.txt | awk '($1 - $4) ^ 2 > (1e-5 * $4) ^ 2 { print NR ": " $1 " not " $4 }' |
        head -n 3)
    verdict "one alpha along and across is isotropic: $mesh" "$(echo $why)"
done

# Of the middle of a ball, in rows and columns of the scene: light is nearly white, and a metal's F0 tints it.
small --metals --size 96x66 -o picture.png --pfm picture.pfm
tint() {
    name=$1
    why=$(pfm_text picture.pfm | awk -v x="$2" -v y="$3" -v least="$4" -v most="$5" '
        NR == 1 { step = $2 / 2 * 0.4562 / (8 * 0.0874887); across = $1; down = $2; next } {
            dx = (NR - 2) % across + 0.5 - across / 2 - x * step
            dy = int((NR - 2) / across) + 0.5 - down / 2 + y * step
            if (dx * dx + dy * dy < step * step / 16) { red += $1; blue += $3 }
        } END { if (!(blue / red > least && blue / red < most)) print "blue is " blue / red " of red" }')
    verdict "--metals: the tint of $name" "$why"
}
tint gold -1 0 0.3 0.55
tint copper 1.5 0.866 0.45 0.7
tint silver -0.5 -0.866 0.9 1.1
grep -q '^  gold  *0.146  0.589  1.261 ' out.txt && why= || why="$(cat out.txt)"
verdict "--metals: the report has every metal's index" "$why"

# ---- Determinism -----------------------------------------------------------------------------------------------------

archs=$(awk '$1 == "arch" && $2 != "best" && $3 ~ /^available/ { print $2 }' list.txt)
strict=$(awk '$1 == "tier" && $2 == "strict" && $3 == "available"' list.txt)
first=${archs%%
*}
if [ -z "$strict" ] || [ "$archs" = "$first" ]; then
    skip "strict: the same bytes on every arch" "one arch here, or no strict tier"
else
    for look in "--preset porcelain" "--preset felt --specular ggx:0.2 --fresnel schlick:0.04 --masking smith" \
                "--preset brushed --rig boxes" "--preset enamel" "--preset cook-torrance" "--metals" "--grazing" \
                "--grid"; do
        for arch in $archs; do
            rm -f "$arch.png" "$arch.pfm"
            small $look --tier strict --arch "$arch" -o "$arch.png" --pfm "$arch.pfm"
            [ "$arch" = "$first" ] && continue
            same "strict $look: $arch.png is $first.png" "$arch.png" "$first.png"
            same "strict $look: $arch.pfm is $first.pfm" "$arch.pfm" "$first.pfm"
        done
    done
fi
small -o once.png --pfm once.pfm
small -o again.png --pfm again.pfm
same "the same picture twice" once.png again.png
same "the same radiance twice" once.pfm again.pfm

for look in "--size 203x150" "--grid" "--metals" "--background none --samples 16"; do
    for threads in 1 2 7; do small $look --threads $threads -o "$threads.png" --pfm "$threads.pfm"; done
    for threads in 2 7; do
        same "$look: the picture of $threads threads is that of one" 1.png $threads.png
        same "$look: the radiance of $threads threads is that of one" 1.pfm $threads.pfm
    done
done

name="threads for which there is no room"
if (ulimit -v 150000 && small --size 400x400 --threads 1 -o one.png); then
    (ulimit -v 150000 && small --size 400x400 --threads 256 -o few.png)
    grep -q ' on 256 threads' out.txt && why="$(cat out.txt)" || why=
    verdict "$name are not counted" "$why"
    same "$name are done without" one.png few.png
else
    skip "$name" "the program does not start where there is little (emulator or sanitizer)"
fi

# ---- The report ------------------------------------------------------------------------------------------------------

demo --size 96x96 --time 0.01 -o picture.png > report.txt 2> err.txt
for arch in $archs; do
    awk -v arch="$arch" '$1 == arch && $2 > 0 { found = 1 } END { exit !found }' report.txt && why= ||
        why="$(cat report.txt)"
    verdict "samples a second: $arch" "$why"
done
# A thread for every CPU that may be used, where there are as many tiles.
cpus=$(unset OMP_NUM_THREADS OMP_THREAD_LIMIT; nproc 2> /dev/null)
[ "${cpus:-99}" -le 72 ] || cpus='[0-9]*'
grep -q "^rasterize [0-9.]* ms, shade [0-9.]* ms.* on $cpus thread" report.txt && why= || why="$(cat report.txt)"
verdict "times of a frame" "$why"
for threads in 1 3; do
    demo --size 96x96 --time 0.01 --threads $threads -o picture.png > report.txt 2> err.txt
    awk -v threads=$threads '
        /^shaded and encoded by [a-z0-9]* [a-z]* on 3 threads: / && $10 + 0 > 0 && $11 + 0 > 0 { found++ }
        END { exit found != (threads == 3) }' report.txt && why= || why="$(cat report.txt)"
    verdict "samples shaded and encoded a second: --threads $threads" "$why"
done
grep -A 1 '^plan' report.txt | grep -q '^  [a-z]' && why= || why="$(cat report.txt)"
verdict "the plan in words" "$why"

name="1024x1024 teapot, scalar, within 2 s"
if [ -n "${FACET_SLOW:-}" ]; then
    skip "$name" "FACET_SLOW is set"
elif ! command -v timeout > /dev/null; then
    skip "$name" "no timeout command here"
else
    why="three attempts took longer"
    for attempt in 1 2 3; do
        timeout 2 ${RUN:-} "$binary" --arch scalar -o large.png > out.txt 2>&1 && why= && break
    done
    verdict "$name" "$why"
fi

exit $failed
