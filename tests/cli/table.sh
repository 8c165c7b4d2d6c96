#!/usr/bin/env bash
# The command's contract as a table. Usage: table.sh LIMNER SOURCE GROUP CMAKE
set -u
limner=$1 source=$2 group=$3 cmake=$4
examples=$source/examples
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
unset DISPLAY WAYLAND_DISPLAY
rows=0 wrong=0
small="--size 64x64 --dpi 96"

complain() {
    printf 'limner %s\n  %s\n' "$row" "$1"
    sed 's/^/  stderr: /' "$folder/.stderr"
    wrong=$((wrong + 1))
}

# row STATUS STDERR FILES ARGUMENT…: runs the command; STDERR is an extended regular expression, empty for silence; FILES are
# those that it must make (and then they are removed), no others.
row() {
    local status=$1 pattern=$2 files=$3 got=0 made
    shift 3
    row="$*"
    rows=$((rows + 1))
    find . -mindepth 1 ! -name '.*' ! -name 'in-*' -delete
    "$limner" "$@" > .stdout 2> .stderr < /dev/null || got=$?
    [ "$got" = "$status" ] || complain "exit status $got, expected $status"
    if [ -z "$pattern" ]; then
        [ ! -s .stderr ] || complain "standard error is not empty"
    else
        grep -Eq -- "$pattern" .stderr || complain "standard error lacks: $pattern"
    fi
    made=$(find . -type f ! -path '*/.*' ! -name 'in-*' -printf '%P\n' | sort | tr '\n' ' ')
    [ "${made% }" = "$files" ] || complain "made '${made% }', expected '$files'"
}

# out PATTERN: the last row's standard output has it.
out() {
    grep -Eq -- "$1" .stdout || complain "standard output lacks: $1"
}

# documented FILE PAGE: well-formed JSON whose keys the page names.
documented() {
    "$cmake" -DFILE="$1" -DPAGE="$source/docs/reference/$2" -P "$source/tests/cli/check_keys.cmake" > .keys 2>&1 ||
        complain "$(cat .keys)"
}

# nested: an OBJ model of a cube in a cube.
nested() {
    local half at=0 name=outer x y z face
    for half in 2 1; do
        echo "o $name"
        for x in -$half $half; do for y in -$half $half; do for z in -$half $half; do echo "v $x $y $z"; done; done; done
        for face in '1 2 4 3' '5 7 8 6' '1 5 6 2' '3 4 8 7' '1 3 7 5' '2 6 8 4'; do
            set -- $face
            echo "f $(($1 + at)) $(($2 + at)) $(($3 + at)) $(($4 + at))"
        done
        at=8 name=inner
    done
}

is_png() {
    [ "$(head -c 8 "$1" | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ] || complain "$1 is no PNG"
}

# Width and height of a PNG: two numbers of four bytes each, behind signature and the first chunk's name.
has_size() {
    local width height
    read -r width height < <(od -An -j16 -N8 --endian=big -tu4 "$1")
    [ "$width $height" = "$2 $3" ] || complain "$1 has $width x $height pixels, expected $2 x $3"
}

same() {
    cmp -s "$1" "$2" || complain "$1 and $2 differ"
}

gear=$examples/gearbox.stl
box=$examples/box.glb

group_usage() {
    cp "$gear" in-own.stl && ln -s in-own.stl in-link.stl
    row 1 'no command is given' ''
    row 1 "did you mean 'limner draw'" '' drow
    row 1 'limner draw model.glb' '' model.glb
    row 0 '' '' --help; out '^  doctor'
    row 0 '' '' --version; out '^limner [0-9]+\.[0-9]+\.[0-9]+$'
    local command
    for command in draw info looks strokes bench doctor; do
        row 0 '' '' $command --help; out "^usage: limner $command"
        row 0 '' '' help $command; out "^usage: limner $command"
        row 1 "unknown option '--nosuch'" '' $command --nosuch
    done
    row 1 'no INPUT is given' '' draw
    row 1 'no INPUT is given' '' info
    row 1 'one argument too many' '' bench a.glb b.glb
    row 1 'one argument too many' '' doctor x
    row 1 "did you mean '--look'" '' draw "$gear" --loook edges
    row 1 '--look needs a value' '' draw "$gear" --look
    row 1 '--eye needs a value' '' draw "$gear" --eye --target 1,2,3
    row 1 '--ortho takes no value' '' draw "$gear" --ortho=yes
    row 1 "--size is '10'; allowed is WxH, each from 1 to 16384" '' draw "$gear" --size 10
    row 1 "--size is '0x5'" '' draw "$gear" --size 0x5
    row 1 "--size is '17000x5'" '' draw "$gear" --size=17000x5
    row 1 "--view is 'isso'; allowed is one of iso, front" '' draw "$gear" --view isso
    row 1 "--eye is '1,2'; allowed is three numbers" '' draw "$gear" --eye 1,2
    row 1 "--fov is '300'; allowed is a number from 1 to 170" '' draw "$gear" --fov 300
    row 1 "--fov is 'nan'" '' draw "$gear" --fov nan
    row 1 "--seed is '1.5'; allowed is a whole number" '' draw "$gear" --seed 1.5
    row 1 "--samples is '3'; allowed is a square number" '' draw "$gear" --samples 3
    row 1 "--up-axis is 'x'" '' draw "$gear" --up-axis x
    row 1 '--ortho and --fov exclude' '' draw "$gear" --ortho --fov 20
    row 1 '--camera excludes' '' draw "$gear" --camera a --view top
    row 1 '--target needs --eye' '' draw "$gear" --target 1,2,3
    row 1 "allowed is FIRST:LAST:FPS" '' draw "$gear" --frames 1-2
    row 1 "allowed is FIRST:LAST:FPS" '' draw "$gear" --frames 5:2:24
    row 1 "allowed is FIRST:LAST:FPS" '' draw "$gear" --frames 0:1:0
    row 1 'has \{frame\}, but there is no --frames' '' draw "$gear" -o 'x{frame}.png'
    row 1 'one file for all frames' '' draw "$gear" -o x.png --frames 0:1:2
    row 1 '--time and --frames exclude' '' draw "$gear" --time 1 --frames 0:1:2
    row 1 'picture and report cannot both' '' draw "$gear" -o - --report -
    row 1 'frames cannot go to standard output' '' draw "$gear" -o - --frames 0:1:2
    row 1 'one file for all inputs' '' draw "$gear" "$box" -o '{name}.png' --report r.json
    row 1 'another input has the same' '' draw a/x.stl b/x.stl -o '{name}.png'
    row 1 "cannot tell the format from '.bmp'" '' draw "$gear" -o x.bmp
    # Of two values one would be dropped in silence; so would a place in a name that stands for nothing.
    row 1 '^limner: --output is given twice' '' draw "$gear" -o a.png -o b.png
    row 1 '^limner: --look is given twice' '' draw "$gear" -l edges --look toon
    row 1 '^limner: --view is given twice' '' draw "$gear" --view top --view=top
    row 1 '^limner: --size is given twice' '' draw "$gear" --size 8x8 --size 9x9
    row 1 '^limner: --seed is given twice' '' draw "$gear" --seed 0 --seed 0
    row 1 '^limner: --eye is given twice' '' draw "$gear" --eye 1,2,3 --eye 1,2,3
    row 1 '^limner: --up-axis is given twice' '' info "$gear" --up-axis y --up-axis z
    row 1 '^limner: --set lines.width is given twice' '' draw "$gear" --set lines.width=2px --set lines.width=3px
    row 1 '^limner: --cut and --set scene.cut exclude' '' draw "$gear" --set scene.cut=y --cut x
    row 1 '^limner: --output has \{view\}' '' draw nosuch.stl -o 'a-{view}.png'
    row 1 '^limner: --output has \{stem\}, which stands for nothing' '' draw nosuch.stl -o 'a-{stem}.png'
    row 1 '^limner: --report has \{Name\}, which stands for nothing' '' draw nosuch.stl --report '{Name}.json'
    row 1 '^limner: --aov has \{frames\}, which stands for nothing' '' draw nosuch.stl --aov 'maps-{frames}'
    row 2 '^limner: nosuch.stl: ' '' draw nosuch.stl -o 'a-{}-{b c}-}{.png'
    # Options that others leave without effect.
    row 1 "the name 'x.svg' says svg and --format says png" '' draw nosuch.stl -o x.svg --format png
    row 1 "is 'in-own.stl', which is an input" '' draw in-own.stl -o in-own.stl --format png
    row 1 "is 'in-link.stl', which is an input" '' draw in-own.stl -o in-link.stl --format png
    row 1 'are the same file' '' draw nosuch.stl -o x.png --report x.png
    row 0 '' 'x.png' draw "$gear" $small -o x.png --eye 1,2,3 --fit 0.5
    row 1 '--fit does not go with --camera' '' draw nosuch.stl --camera a --fit 0.5
    row 1 '--ortho does not go with --camera' '' draw nosuch.stl --camera a --ortho
    row 1 '--define goes with OpenSCAD programs' '' draw "$gear" -D a=1
    row 1 '--strict goes with OpenSCAD programs' '' info "$gear" --strict
    row 1 'there is no such format' '' draw "$gear" --format bmp
    row 1 "there is no look 'edgs'" '' draw "$gear" --look edgs
    row 1 "did you mean 'edges'" '' draw "$gear" --look edgs
    row 1 "it is a technique, not a look: --set lines.operator=sobel" '' looks sobel
    row 1 'lines.width is .99px.; allowed is a number from .* pt' '' draw "$gear" --set lines.width=99px
    row 1 "did you mean 'width'" '' draw "$gear" --set lines.widht=9
    row 1 'allowed is KIND.PARAM=VALUE' '' draw "$gear" --set lines.width
    row 1 'layers.count is .-1.; allowed is a whole number from 0 to 256' '' draw "$gear" --look blueprint --set layers.count=-1
    row 1 'layers.count is .10000.; allowed' '' draw "$gear" --look blueprint --set layers.count=10000
    row 1 'has no lines' '' draw "$gear" --look plain --set lines.width=3px
    row 1 "^limner: scene.cut is 'w': a plane is x, y or z" '' draw "$gear" --cut w
    row 1 '^hint: for example x, -z=40%' '' draw "$gear" --cut w
    row 1 "cut is 'x=a%': behind '=' stands a number" '' draw "$gear" --cut x=a%
    row 1 "cut is 'box=1,2': a box is box=X0,Y0,Z0:X1,Y1,Z1" '' draw "$gear" --cut box=1,2
    row 1 "planes and boxes are separated by ';'" '' draw "$gear" --set 'scene.cut=x y'
    row 1 '^limner: scene.cut_keep: selector .a,. is wrong' '' draw "$gear" --cut x --set scene.cut_keep=a,
}

group_draw() {
    local view
    row 0 '' 'gearbox.png' draw "$gear" $small; is_png gearbox.png
    row 0 '' 'x.png' draw "$gear" $small -o x.png --look toon --set lines.width=3px --set surface.bands=4
    row 0 '' 'x.png' draw -ox.png $small -- "$gear"
    row 0 '' 'x.tmp' draw "$gear" $small -o x.tmp --format png; is_png x.tmp
    row 0 '' '' draw "$gear" $small -o -; is_png .stdout
    row 0 '' '' draw "$gear" $small -o - --format png; is_png .stdout
    for view in iso front back left right top bottom; do
        row 0 '' 'x.png' draw "$gear" $small -o x.png --view $view
    done
    row 0 '' 'x.png' draw "$gear" $small -o x.png --eye -300,-200,100.5
    # A picture of twice as many pixels is the same drawing: as many bytes of lines as vectors have.
    row 0 '' 'a.svg' draw "$gear" -o a.svg --look line --size 400x300; cp a.svg in-a.svg
    row 0 '' 'b.svg' draw "$gear" -o b.svg --look line --size 1600x1200; same in-a.svg b.svg
    row 0 '' 'x.png' draw "$gear" -o x.png --look line --page 30x20mm --dpi 127; has_size x.png 150 100
    row 0 '' 'x.png' draw "$gear" -o x.png --look line --page 60x40mm; has_size x.png 227 151
    row 0 '' 'x.png' draw "$gear" -o x.png --look line --page 60x40mm --size 120x80; has_size x.png 120 80
    row 1 '--page and --dpi say how many pixels there are, and --size too' '' draw nosuch.stl -o x.png --page A4 --dpi 100 --size 10x10
    row 1 'allowed is a number from 1 to 10000' '' draw nosuch.stl --dpi 0
    row 1 'a page of 210 x 297 mm has 23386 pixels at 2000 an inch; allowed are 16384' '' draw nosuch.stl --page A4 --dpi 2000
    row 1 "the page is 'A44'" '' draw nosuch.stl --page A44
    row 0 '' 'x.png' draw "$gear" $small -o x.png --eye=300,-200,100 --target 0,0,0 --up 0,0,1
    row 0 '' 'x.png' draw "$gear" $small -o x.png --ortho --fit 0.5 --seed 7 --samples 4 --up-axis y
    # A time that changes nothing is refused, before the first of several frames.
    row 1 "^limner: $gear: the model has no animation" '' draw "$gear" $small -o x.png --time 0.5
    row 1 "^limner: $gear: the model has no animation" '' draw "$gear" $small -o 'x-{frame}.png' --frames 0:1:24
    row 1 "^limner: $gear: the model has no animation" '' draw "$gear" $small -o x.svg --look sketch --set perturb.boil=12 --time 1
    row 0 'warning: the model has no animation' 'x.png' draw "$gear" $small -o x.png --time 0.5 --lenient
    row 0 '' 'x.png' draw "$gear" $small -o x.png --time 0.5 --look sketch --set perturb.boil=12
    local moving=$examples/box-animated.glb
    row 0 '' 'x.png' draw "$moving" $small -o x.png && cp x.png in-rest.png
    row 0 '' 'x.png' draw "$moving" $small -o x.png --time 0
    row 0 '' 'x.png' draw "$moving" $small -o x.png --time 1.5 && cp x.png in-later.png
    cmp -s in-rest.png in-later.png && complain "--time moves nothing"
    row 0 '' 'x.png' draw "$moving" $small -o x.png --clip 1 --time 1.5
    cmp -s x.png in-later.png || complain "--clip 1 is not the first clip"
    row 0 '' 'x.svg' draw "$moving" $small -o x.svg --time 1.5
    row 1 "^limner: .*motion 'accumulate' has no lines in vector drawings" '' draw "$moving" $small -o x.svg --time 1.5 --set motion.technique=accumulate
    row 0 '' 'x.png' draw "$moving" $small -o x.png --time 1.5 --set motion.exposure=0.1 --set motion.technique=blur
    printf '%s' '{"version": 1, "rules": [{"surface": "lit", "motion": {"technique": "blur", "exposure": 0.1}}, {"select": "*inner*", "surface": "lit", "motion": {"technique": "streaks", "exposure": 0.2}}]}' >in-exposures.json
    row 1 "^limner: .*different motion: exposures of 0.1 s and 0.2 s" '' draw "$moving" $small -o x.png --time 1.5 --look in-exposures.json
    row 1 "^limner: motion.texture is 'wool'; allowed is a texture of streaks" '' draw "$moving" $small -o x.png --time 1.5 --set motion.technique=streaks --set motion.texture=wool
    row 0 'warning: motion.shadows: the look has no shadows' 'x.png' draw "$moving" $small -o x.png --time 1.5 --set motion.technique=streaks --set motion.shadows=true
    row 2 "^limner: .*nowhere.png" '' draw "$moving" $small -o x.png --time 1.5 --set motion.technique=streaks --set motion.texture=nowhere.png
    row 0 '' 'x.png' draw "$moving" $small -o x.png --time 1.5 --set motion.technique=accumulate
    cmp -s x.png in-later.png && complain "motion changes nothing"
    row 0 '' 'x-0000.png x-0001.png' draw "$moving" $small -o 'x-{frame}.png' --frames 0:1:24
    row 0 '' 'x-0036.png' draw "$moving" $small -o 'x-{frame}.png' --frames 36:36:24 && cp x-0036.png in-frame.png
    row 0 '' 'x.png' draw "$moving" $small -o x.png --time 1.5 --fit-time
    cmp -s x.png in-frame.png || complain "a frame is not the picture of its time, fitted to all times"
    row 0 'warning: the clip runs from 0 to 3.70.* s: later times are drawn as its end' 'x.png' draw "$moving" $small -o x.png --time 5
    row 1 "^limner: $moving: the model has no clip 'walk'" '' draw "$moving" $small -o x.png --clip walk
    row 1 "^limner: $moving: the model has no clip '2'" '' draw "$moving" $small -o x.png --clip 2
    row 1 "clip" '' draw "$moving" $small -o x.png --clip ''
    row 1 "^hint: did you mean 'Run'" '' draw "$examples/fox.glb" $small -o x.png --clip Rin
    row 0 '' 'x.png' draw "$examples/fox.glb" $small -o x.png --clip Run,Walk --time 0.2 --report in-report.json
    tr -d ' \n' < in-report.json | grep -q '"time":{"seconds":0.2[0-9]*,"clips":\["Run","Walk"\]}' || complain "the report has no time: $(cat in-report.json)"
    row 1 "^limner: $gear: clip 'Run': the model has no animation" '' draw "$gear" $small -o x.png --clip Run
    row 0 '' 'x.png' draw "$gear" $small -o x.png --fov 60 --background none --select 'gear*'
    row 0 'drawn in [0-9]+ ms' 'x.png' draw "$gear" $small -o x.png --verbose
    row 0 '' 'x.png' draw "$gear" $small -o x.png --cut -x=40% && cp x.png in-cut.png
    row 0 '' 'x.png' draw "$gear" $small -o x.png --set scene.cut=-x=40%
    cmp -s x.png in-cut.png || complain "--cut is not --set scene.cut"
    row 0 '' 'x.png' draw "$gear" $small -o x.png
    cmp -s x.png in-cut.png && complain "--cut changes nothing"
    row 0 '' 'x.png' draw "$gear" $small -o x.png --cut 'x;1,-1,0@0,0,5;box=50%,0%,50%:100%,100%,100%' --look toon
    row 0 'warning: the section leaves nothing of the model' 'x.png' draw "$gear" $small -o x.png --cut x=-1e6
    row 0 'warning: the model is behind the viewer' 'x.png' draw "$gear" $small -o x.png --eye 1000,0,0 --target 2000,0,0
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n' > in-open.obj
    row 0 '1 of 1 parts are not closed' 'x.png' draw in-open.obj $small -o x.png --cut y=0.3
    row 1 'selector .a,. is wrong at character' '' draw "$gear" $small --select 'a,'
    row 1 'colour|background' '' draw "$gear" $small --background nosuch
    row 1 "^limner: $gear: the selection 'nosuch' matches none" '' draw "$gear" $small --select nosuch
    row 1 "^limner: $gear: the scene has no camera" '' draw "$gear" $small --camera nosuch
    # Strokes and marks lie on meshes.
    row 0 '' 'x.png' draw "$gear" $small --look line --cut x -o x.png
    # Lines that files bring are strokes.
    printf 'o block\nv 0 0 0\nv 2 0 0\nv 2 0 -2\nv 0 0 -2\nv 1 1 -1\nv 1 2 -1\nv 3 2 -2\nf 4 3 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\no wire\nl 5 6 7\n' > in-lines.obj
    row 0 '' 'x.png' draw in-lines.obj $small -o x.png --look line && cp x.png in-drawn.png
    row 0 '' 'x.png' draw in-lines.obj $small -o x.png --look line --set lines.drawn=false
    cmp -s x.png in-drawn.png && complain "the file's lines are not drawn"
    row 0 '' 'x.png' draw in-lines.obj $small -o x.png --select wire --look line --set lines.visibility=sampled
    row 0 'warning: lines that the file brings are drawn by looks with strokes' 'x.png' draw in-lines.obj $small -o x.png --look edges
    row 0 '' '' info in-lines.obj; out '^lines  *2$'
    row 0 '' 'x.svg' draw in-lines.obj -o x.svg --look line --report in-report.json
    grep -q 'id="[^"]*part-2-drawn"' x.svg || complain "the drawing has no group of the file's lines"
    tr -d ' \n' < in-report.json | grep -q '"drawn":[12]' || complain "the report does not count the file's lines: $(cat in-report.json)"
    row 0 '' 'widget.png' draw "$examples/csg/widget.csg" $small --look edges --set lines.operator=strokes
    row 2 "^limner: $examples/csg/widget.csg: lines of form" '' draw "$examples/csg/widget.csg" $small --look line --set lines.suggestive=0.5
    printf '{"version":1,"name":"removed","rules":[{"select":"*","surface":"flat"},{"select":"@removed","lines":"strokes"}]}' > in-removed.json
    row 2 "^limner: $examples/csg/widget.csg: lines 'strokes' are those of what is there" '' draw "$examples/csg/widget.csg" $small --look ./in-removed.json
    row 2 "^limner: $examples/csg/widget.csg: surface 'stipple' lies on meshes" '' draw "$examples/csg/widget.csg" $small --look stipple --set lines.operator=none
    row 0 'warning: lines of form' 'x.png' draw "$examples/csg/widget.csg" $small --look line --set lines.suggestive=0.5 --lenient -o x.png
    # Poses at telling moments, on one plate or as contours; the time is the end of the clip.
    # Where most is seen: of pictures and vectors, of what is selected; not beside another viewpoint, nor on sheets of views.
    row 0 '' 'x.png' draw "$examples/pump.glb" $small --view best -o x.png
    row 0 '' 'x.svg' draw "$examples/pump.glb" --view best --look technical -o x.svg --select '*gear'
    row 0 '' 'x-0000.png x-0001.png' draw "$examples/fox.glb" $small --view best --clip Run --frames 0:1:24 -o 'x-{frame}.png'
    row 1 'exclude each other' '' draw "$examples/pump.glb" --view best --eye 1,2,3 -o x.png
    row 1 'allowed is iso, front' '' draw "$examples/pump.glb" --views front,best --look technical -o x.svg
    row 1 "selector" '' draw "$examples/pump.glb" --view best --select '[' -o x.png
    row 0 '' 'r.json x.png' draw "$examples/walker.bvh" $small --view right -o x.png --poses 4 --report r.json
    grep -q '"reason": "turn"' r.json || complain "no turn is told"
    row 0 '' 'x.svg' draw "$examples/walker.bvh" $small --view right -o x.svg --look line --poses auto --motion ghosts
    row 1 "^limner: --poses is '1'; allowed are 2 to 64, or auto" '' draw "$moving" $small -o x.png --poses 1
    row 1 '^limner: --poses goes with --motion plate' '' draw "$moving" $small -o x.png --poses 3 --motion blur
    row 0 'nothing moves without a time' 'x.png' draw "$examples/house.glb" $small -o x.png --poses 3
    # Ways to tell of motion that have a name; vectors have them, too.
    row 0 '' 'x.png' draw "$examples/buggy.glb" --size 200x200 --time 1 -o x.png && cp x.png in-rest.png
    row 0 '' 'x.png' draw "$examples/buggy.glb" --size 200x200 --time 1 --motion speed-lines --report in-m.json -o x.png
    tr -d ' \n' < in-m.json | grep -q '"A3":24' || complain "the report does not count speed lines: $(cat in-m.json)"
    row 0 '' 'x.svg' draw "$examples/buggy.glb" --time 1 --look line --motion ghosts --set motion.contours=3 --report in-m.json -o x.svg
    grep -q 'class="visible past[" ]' x.svg || complain "the drawing has no contours of the past"
    tr -d ' \n' < in-m.json | grep -q '"contours":3' || complain "the report does not count contours: $(cat in-m.json)"
    row 0 'warning: motion' 'x.png' draw "$examples/buggy.glb" $small --motion ghosts -o x.png
    # A look with several rules says so once.
    row 0 'nothing moves without a time of an animation$' 'x.png' draw "$examples/house.glb" $small --look chrono -o x.png
    for way in echoes comic manga plate chrono squash slit lean; do
        row 0 '' 'x.png' draw "$examples/buggy.glb" --size 200x200 --time 1 --motion $way -o x.png
        cmp -s x.png in-rest.png && complain "$way changes nothing"
    done
    # The shape of what moves: of vectors, too; and where nothing moves, that is said.
    row 0 '' 'x.svg' draw "$examples/buggy.glb" --clip Drive --time 1 --camera with --look line -o x.svg && cp x.svg in-plain.svg
    for way in squash lean; do
        row 0 '' 'x.svg' draw "$examples/buggy.glb" --clip Drive --time 1 --camera with --look line --motion $way -o x.svg
        cmp -s x.svg in-plain.svg && complain "--motion $way leaves the drawing as it is"
    done
    row 0 'warning: motion: nothing moves without a time' 'x.svg' draw "$examples/buggy.glb" --look line --motion squash -o x.svg
    row 0 "warning: motion 'deform' changes nothing" 'x.svg' draw "$examples/buggy.glb" --time 1 --look line --motion deform -o x.svg
    row 0 'warning: motion: nothing is deformed' 'x.png' draw "$examples/morph-cube.glb" $small --time 0.5 --motion squash -o x.png
    row 1 "there is no motion technique 'nosuch'" '' draw "$examples/buggy.glb" $small --time 1 --motion nosuch -o x.png
    # Sizes that cannot be are told before anything is drawn, and the one that is offered is smaller.
    row 2 'needs 20000 pixels a side, the limit is' '' draw "$gear" --size 5000x5000 --samples 16
    row 2 '^hint: with 16 samples at most --size [0-9]+x[0-9]+' '' draw "$gear" --size 5000x5000 --samples 16
    row 4 '^limner: nosuch/x.png: ' '' draw "$gear" $small -o nosuch/x.png
    row 4 '^limner: nosuch/r.json: ' 'x.png' draw "$gear" $small -o x.png --report nosuch/r.json
    row 0 '' 'a.png' draw "$gear" $small -o a.png && cp a.png in-first.png
    row 0 '' 'a.png' draw "$gear" $small -o a.png
    cmp -s a.png in-first.png || complain "two runs give different files"
    rows=$((rows + 1))
    row="draw -o - on a full disk"
    "$limner" draw "$gear" $small -o - > /dev/full 2> .stderr
    [ $? = 4 ] || complain "exit status is not 4"
    row="info on a full disk"
    "$limner" info "$gear" > /dev/full 2> .stderr
    [ $? = 4 ] || complain "exit status is not 4"
    row="info into a closed pipe"
    { got=0; "$limner" info "$gear" 2> .stderr || got=$?; echo $got > .got; } | : # nobody reads
    { sleep 0.3; got=0; "$limner" info "$gear" --json 2> .stderr || got=$?; echo $got > .got; } | :
    [ "$(cat .got)" = 4 ] && grep -q '^limner: standard output: ' .stderr || complain "exit status $(cat .got), expected 4"
    row="draw beyond the limit on files"
    : > in-before.png
    for status in 1 2; do
        got=0
        (ulimit -f 1; "$limner" draw "$gear" --size 300x300 -o in-before.png 2> .stderr) || got=$?
        [ $got = 4 ] && [ ! -s in-before.png ] || complain "exit status $got, expected 4 and the file as it was"
    done
    find . -name '*limner-*' | grep -q . && complain "something temporary stays"
    row 4 '^limner: /dev/full: cannot write: No space left' '' draw "$gear" $small -o /dev/full --format png
    row="draw -o LINK"
    ln -s in-later.png in-dangling.png
    "$limner" draw "$gear" $small -o in-dangling.png 2> .stderr
    [ -L in-dangling.png ] && [ -s in-later.png ] || complain "the dangling link does not lead to the picture"
    : > in-named.png && ln -s in-named.png in-link.png
    "$limner" draw "$gear" $small -o in-link.png 2> .stderr
    [ -L in-link.png ] && [ -s in-named.png ] || complain "the link does not lead to the picture"
    "$limner" draw "$gear" $small --look plain --set lines.operator=four-tap -o in-a.png
    "$limner" draw "$gear" $small --look plain -o in-b.png
    cmp -s in-a.png in-b.png && complain "--set lines.operator changes nothing"
    # The near plane is close to the eye then, and the wall far behind it where window depth has few steps left.
    row="draw a flat wall from within the model"
    local inside="--size 200x200 --eye -0.3,-0.1,0.05 --target 0.5,0.07,0.13 --fov 40"
    "$limner" draw "$box" $inside -o in-a.png
    "$limner" draw "$box" $inside -o in-b.png --set lines.operator=none
    cmp -s in-a.png in-b.png || complain "there are lines on the wall"
}

group_perspective() {
    local town=$examples/town.geojson
    row 0 '' a.png draw "$town" $small -l city --perspective multi -o a.png
    row 0 '' a.svg draw "$town" -l technical --perspective multi --eye -60,-175,28 --target 0,0,5 -o a.svg
    row 0 '' a.png draw "$town" $small -l city --perspective panorama --eye 0,0,12 --horizon 360 --set finish.labels=name -o a.png
    row 1 'panorama needs --eye' '' draw "$town" --perspective panorama -o a.png
    row 1 'goes with --perspective multi' '' draw "$town" --bend 20 -o a.png
    row 1 'goes with --perspective panorama' '' draw "$town" --perspective multi --horizon 90 -o a.png
    row 1 'does not go with --frames' '' draw "$town" --perspective multi --frames 0:3:2 -o 'a-{frame}.png'
    row 1 'straight above' '' draw "$town" --perspective multi --view top -o a.png
    row 1 'beyond the zenith' '' draw "$town" --perspective multi --bend 80 -o a.png
    row 2 'too tall' '' draw "$town" --perspective multi --eye -60,-175,28 --bend 60 --bend-from 0.5 --bend-to 0.55 -o a.png
    row 1 'cannot bend from' '' draw "$town" --perspective multi --bend-from 0.9 --bend-to 0.1 -o a.png

    row 2 'solid of set operations' '' draw "$examples/csg/widget.csg" --perspective multi -o a.png
}

group_many() {
    cp "$gear" in-one.stl; cp "$gear" in-two.stl; printf 'solid x\nfacet' > in-bad.stl
    row 0 '' 'p-in-one.png p-in-two.png' draw in-one.stl in-two.stl $small -o 'p-{name}.png'
    # One renderer for all must not keep anything of the scene before.
    row 0 '' 'p-box-animated.png p-box.png p-gearbox.png' draw "$box" "$gear" "$examples/box-animated.glb" $small -o 'p-{name}.png'
    local name
    for name in box gearbox box-animated; do
        "$limner" draw "$examples/$name".* $small -o in-single.png
        cmp -s in-single.png p-$name.png || complain "$name alone gives another picture"
    done
    row 2 '^limner: in-bad.stl:2: ' 'p-in-one.png p-in-two.png' draw in-one.stl in-bad.stl in-two.stl $small -o 'p-{name}.png'
    row 2 '^limner: in-none.stl: ' 'p-in-two.png' draw in-none.stl in-two.stl $small -o 'p-{name}.png'
    row 2 '^limner: in-bad.stl:2: ' '' draw in-one.stl in-bad.stl $small
    row 1 'matches none' 'p-in-two.png' draw in-one.stl in-two.stl $small -o 'p-{name}.png' --select 'in-two*'
    row 0 '' 'x.png' draw in-one.stl in-two.stl $small -o x.png
    row 0 '' 'gearbox-0003.png gearbox-0004.png' draw "$gear" $small --frames 3:4:24 --look sketch --set perturb.boil=12
    row 0 '' '0000-gearbox.png' draw "$gear" $small --frames 0:0:24 -o '{frame}-{name}.png'
    row 4 '^limner: nosuch/0000.png: ' '' draw "$gear" $small --frames 0:0:24 -o 'nosuch/{frame}.png'
}

group_report() {
    row 0 '' 'r.json x.png' draw "$gear" $small -o x.png --report r.json
    cp r.json in-report.json; documented in-report.json report.md
    row 0 '' 'x.png' draw "$gear" $small -o x.png --report -
    out '"path": "x.png"'; out '"load_ms"'
    # Pictures of all sizes and samples have the same lines.
    local size lines first=
    for size in '256x192' '1024x768' '2048x1536' '512x384 --samples 16'; do
        row 0 '' 'r.json x.png' draw "$examples/crank.glb" --look line --size $size -o x.png --report r.json
        lines=$(sed -n '/"strokes": {/,/}/p' r.json)
        [ "$lines" = "${first:=$lines}" ] || complain "there are other lines: $lines instead of $first"
    done
    [[ "$first" =~ contour.*crease ]] || complain "there are no lines: $first"
    mkfifo in-pipe
    timeout 60 cat in-pipe > .piped &
    row 0 '' 'x.png' draw "$gear" $small -o x.png --report in-pipe
    wait $!
    [ -p in-pipe ] && grep -q '"load_ms"' .piped || complain "the report replaces a pipe instead of going through it"
    row 0 '' 'p-r.json p.png' draw "$gear" $small -o p.png --report p-r.json --aov .maps
    local map
    for map in depth.pfm normal.pfm id.png edge.png shade.png; do
        [ -s .maps/$map ] || complain "there is no $map"
    done
    # Looks that are seen through: every layer's maps, and how the layers were made.
    row 0 '' 'b-r.json b.png' draw "$gear" $small -o b.png --look blueprint --report b-r.json --aov .layers
    cp b-r.json in-layers.json; documented in-layers.json report.md
    grep -q '"layers": 5' b-r.json && grep -Eq '"layer_producer": "(lists|peeling)"' b-r.json || complain "the report does not tell the layers"
    for map in 0.depth.pfm 4.normal.pfm 4.id.png 4.edge.png 4.shade.png; do
        [ -s .layers/layer$map ] || complain "there is no layer$map"
    done
    [ -e .layers/layer5.depth.pfm ] && complain "there are more layers than were asked for"
    # A focus shows although the rule's other parts are all around it: the small cube is inside of the large one.
    nested > in-nested.obj
    row 0 '' 'x.png' draw in-nested.obj $small --look blueprint --set layers.focus=inner -o x.png && cp x.png in-focus.png
    row 0 '' 'x.png' draw in-nested.obj $small --look blueprint --set layers.focus=inner --set layers.focus_colour=#00ff00 -o x.png
    cmp -s x.png in-focus.png && complain "the focus is not to be seen"
    # A wrong text in a look is a wrong look, found where it stands.
    local bad # "wrong" counts
    for bad in '"scene": {"cut": "w=3"}' '"scene": {"cut": "x", "cut_keep": "a,"}' '"x-none": 0'; do
        printf '{"version": 1,\n %s,\n "rules": [{"layers": {"technique": "peel", "focus": "b,"}, "compose": "xray"}]}' "$bad" > in-wrong.json
        row 2 '^limner: in-wrong.json:[23]:[0-9]+: ' '' draw "$gear" $small --look in-wrong.json
    done
    row 0 'selects no part' 'x.png' draw "$gear" $small -o x.png --look xray --set layers.focus=nosuch
    row 1 '^limner: layers.focus: selector .a,. is wrong' '' draw "$gear" $small -o x.png --look xray --set layers.focus=a,
    row 0 "scene.cut_keep 'nosuch' selects no part" 'x.png' draw "$gear" $small -o x.png --cut x --set scene.cut_keep=nosuch
    # What is seen through keeps the opacity of its materials; other looks cut it out and say so.
    printf 'newmtl glass\nKd 0.2 0.5 0.8\nd 0.4\n' > in-glass.mtl
    { printf 'mtllib in-glass.mtl\nusemtl glass\n'; nested; } > in-glass.obj
    row 0 'transparent materials are drawn as cut-outs' 'x.png' draw in-glass.obj $small -o x.png --look edges
    row 0 '' 'x.png' draw in-glass.obj $small -o x.png --look xray
    grep -q cut-outs .stderr && complain "a transparent material is said to be cut out where it is seen through"
    row 0 '' '' bench "$gear" --look edges --look toon --size 64x64 --repeat 2 --json
    documented .stdout bench.md
    row 0 '' '' bench "$gear" --look edges --size 64x64 --repeat 2; out '^edges +[0-9.]+ +[0-9.]+'
    row 1 "there is no look 'nosuch'" '' bench "$gear" --look nosuch
    row 0 '' '' info "$gear" --json; documented .stdout info.md
    row 0 '' '' info "$gear"; out '^triangles +9532$'
    row 0 '' '' info "$examples/csg/widget.csg" --json; documented .stdout info.md
    row 0 '' '' info "$examples/csg/widget.csg"; out 'solid: 5 operands, 2 unions, 1 intersections, 1 differences, 4 levels'
    out '^ +operand cylinder x 3  \(line 12\)$'
    printf 'group() {\n cube(size = 1;\n}' > in-wrong.csg
    row 2 '^limner: in-wrong.csg:2:15: expected' '' info in-wrong.csg
}

group_inputs() {
    row 2 '^limner: nosuch.glb: ' '' draw nosuch.glb
    row 2 '^limner: nosuch.glb: ' '' info nosuch.glb
    row 2 '^limner: /: |^limner: /' '' draw /
    printf 'what is this' > in-unknown.xyz
    row 2 '^limner: in-unknown.xyz: ' '' draw in-unknown.xyz
    : > in-empty.glb
    row 2 '^limner: in-empty.glb: ' '' draw in-empty.glb
    : > in-empty.stl
    row 2 '^limner: in-empty.stl: ' '' draw in-empty.stl
    row 2 'nosuch.json: ' '' draw "$gear" --look nosuch.json
    printf '{"version": 1,\n "rules": [{"surface": "lit" "lines": "id"}]}' > in-syntax.json
    row 2 '^limner: in-syntax.json:2:[0-9]+: not valid JSON' '' draw "$gear" --look in-syntax.json
    printf '{"version": 1,\n "rules": [{"surfac": "lit"}]}' > in-key.json
    row 2 "^limner: in-key.json:2:13: rules\[0\]: unknown key 'surfac'" '' draw "$gear" --look in-key.json
    row 2 "^hint: did you mean 'surface'" '' draw "$gear" --look in-key.json
    printf '{"version": 1, "rules": [{"surface": {"technique": "toon", "bands": 99}}]}' > in-value.json
    row 2 '^limner: in-value.json:1:[0-9]+: .*bands is .99.; allowed is a whole number from' '' draw "$gear" --look in-value.json
    printf '{"version": 99}' > in-version.json
    row 2 'in-version.json:1:2: version is 99' '' draw "$gear" --look in-version.json
    printf '{"version": 1, "x-mine": 1, "rules": [{"surface": "lit"}]}' > in-good.json
    row 0 '' 'x.png' draw "$gear" $small --look ./in-good.json -o x.png
    # A part that no rule picks is not drawn, and hides nothing either: the front square is out, the one behind it whole.
    printf 'o back\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\no front\nv 0 -1 1\nv 1 -1 1\nv 1 1 1\nv 0 1 1\nf 5 6 7 8\n' > in-two.obj
    local rule='"select": "back", "surface": "lit", "lines": "discontinuity"'
    printf '{"version": 1, "rules": [{%s}]}' "$rule" > in-some.json
    printf '{"version": 1, "rules": [{%s, "layers": {"complement": false}}]}' "$rule" > in-alone.json
    row 0 '' 'x.png' draw in-two.obj $small --view front --look in-alone.json -o x.png && cp x.png in-alone.png
    row 0 '' 'x.png' draw in-two.obj $small --view front --look in-some.json -o x.png
    cmp -s x.png in-alone.png || complain "a part that is not drawn hides another"
    printf '{"version": 1, "rules": [{"select": "nosuch"}]}' > in-nothing.json
    row 1 "^limner: in-two.obj: no rule of the look 'in-nothing' selects a part" '' draw in-two.obj $small --look in-nothing.json -o x.png
    row 0 "rule 0 of look 'in-nothing' selects no part" 'x.png' draw in-two.obj $small --look in-nothing.json -o x.png --lenient
    sed 's/^ *//' > in-eyes.gltf << 'EOF'
    {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 5]}, {"camera": 1, "name": "Side", "translation": [1, 0, 5]}],
    "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}, {"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}
EOF
    row 0 '' '' info in-eyes.gltf; out 'camera-1, Side'
    row 0 '' 'x.png' draw in-eyes.gltf $small --camera camera-1 -o x.png
    row 0 '' 'x.png' draw in-eyes.gltf $small --camera Side -o x.png
    row 1 "did you mean 'camera-1'" '' draw in-eyes.gltf $small --camera camera-7 -o x.png
    local model
    for model in "$examples"/*.glb "$examples"/*.obj; do
        row 0 '' 'x.png' draw "$model" $small -o x.png
        row 0 '' '' info "$model" --json; documented .stdout info.md
    done
}

group_looks() {
    local name
    row 0 '' '' looks; out '^plain '; out '^edges '
    row 0 '' '' looks --json; documented .stdout looks-json.md
    row 0 '' '' looks edges --json; documented .stdout looks-json.md
    row 0 '' '' looks edges; out 'lines.width .*pt'
    row 1 "did you mean 'edges'" '' looks edgs
    row 1 '--markdown goes with neither' '' looks edges --markdown
    for name in $("$limner" looks | sed -n 's/^\([a-z][a-z-]*\) .*/\1/p'); do
        case $name in
            ghost) row 0 "'@removed'" 'x.png' draw "$gear" $small --look "$name" -o x.png ;; # nothing was taken away from it
            speed-lines|ghosts|chrono|manga|squash) row 0 'nothing moves without a time' 'x.png' draw "$gear" $small --look "$name" -o x.png
                row 0 '' 'x.png' draw "$examples/buggy.glb" --size 200x200 --time 1 --look "$name" -o x.png ;;
            *) row 0 '' 'x.png' draw "$gear" $small --look "$name" -o x.png ;;
        esac
        row 0 '' '' looks "$name"; out "^$name: "
    done
    row 0 '' 'x.png' draw "$examples/csg/widget.csg" $small --look ghost -o x.png
    row 0 '' '' info "$examples/csg/widget.csg"; out 'widget/removed$'
    # A shader that the driver refuses is named with its line, which stands behind what it includes.
    local shaders; shaders=$(mktemp -d); mkdir "$shaders/surface"
    printf '#include "light/light.glsl"\n\nvec4 surface_colour(surface_point p)\n{\n    return vec4(u_nothing);\n}\n' > "$shaders/surface/flat.glsl"
    LIMNER_SHADER_DIR=$shaders row 3 '^limner: src/surface/flat.glsl:5' '' draw "$gear" $small --set surface.technique=flat -o x.png
    rm -r "$shaders"
}

group_sketch() {
    local look
    for look in sketch draft chalk redraw sketch-blueprint; do
        row 0 '' 'a.png' draw "$gear" $small --look $look -o a.png && is_png a.png 64 64
    done
    # Nothing moves: the very picture of the look without it.
    row 0 '' 'a.png' draw "$gear" $small --look edges -o a.png && cp a.png in-plain.png
    row 0 '' 'a.png' draw "$gear" $small --look edges --set perturb.technique=uncertainty --set perturb.amount=0px -o a.png
    cmp -s a.png in-plain.png || complain "an amount of 0 changes the picture"
    row 0 '' 'a.png' draw "$gear" $small --look edges --set perturb.technique=uncertainty -o a.png && cp a.png in-moved.png
    cmp -s a.png in-plain.png && complain "the uncertainty changes nothing"
    row 0 '' 'a.png' draw "$gear" $small --look edges --set perturb.technique=uncertainty -o a.png
    cmp -s a.png in-moved.png || complain "the same call gives another picture"
    row 0 '' 'a.png' draw "$gear" $small --look edges --set perturb.technique=uncertainty --seed 7 -o a.png
    cmp -s a.png in-moved.png && complain "another seed gives the same picture"
    # Boiling: on twos, frames 0 and 1 of 24 a second are one drawing, frame 2 is another.
    row 0 '' 'f0000.png f0001.png f0002.png' draw "$gear" $small --look sketch --set perturb.boil=12 --frames 0:2:24 -o 'f{frame}.png'
    cmp -s f0000.png f0001.png || complain "the two frames of a two differ"
    cmp -s f0001.png f0002.png && complain "it does not boil"
    row 0 '' 'a.png' draw "$gear" $small --look sketch -o a.png --aov .maps && [ -s .maps/uncertainty.pfm ] || complain "there is no uncertainty.pfm"
    row 0 '' 'a.png' draw "$gear" $small --look edges -o a.png --aov .exact && [ -e .exact/uncertainty.pfm ] && complain "nothing is uncertain here"
    row 0 "warning: compose 'superimpose' cannot be perturbed" 'a.png' draw "$gear" $small --look sketch --set compose.technique=superimpose -o a.png
    row 1 'perturb.amount is .65px.; allowed is a number from 0 to 48 pt' '' draw "$gear" --look sketch --set perturb.amount=65px
    row 1 'perturb.lock is .floor.' '' draw "$gear" --look sketch --set perturb.lock=floor
    row 1 'set perturb.technique first' '' draw "$gear" --look edges --set perturb.amount=3px
}

group_solids() {
    local widget=$examples/csg/widget.csg look map
    for look in edges blueprint xray sketch; do
        row 0 '' 'a.png' draw "$widget" $small --look $look -o a.png && is_png a.png 64 64
        cp a.png in-$look.png
    done
    # Depth, ids and the colours of operands; inner layers are those of the solid: 2 by 2 surfaces around a bore.
    row 0 '' 'r.json x.png' draw "$widget" $small --look blueprint --set layers.count=0 --view top --ortho -o x.png --report r.json --aov .maps
    cp r.json in-solids.json; documented in-solids.json report.md
    grep -q '"layers": 4' r.json || complain "the report does not tell four layers"
    for map in layer0.depth.pfm layer3.normal.pfm layer3.edge.png; do [ -s .maps/$map ] || complain "there is no $map"; done
    # The lines where operands meet are the solid's, and can be left out.
    row 0 '' 'x.png' draw "$widget" $small --look edges --set lines.meet=180 -o x.png
    cmp -s x.png in-edges.png && complain "lines.meet changes nothing"
    # Mirrors: a solid has no plane of its own and gets the tint; cut faces take no part in finding that of meshes.
    printf '{"version": 1, "rules": [{"surface": "mirror"}]}' > in-mirror.json
    row 0 '' 'x.png' draw "$widget" $small --look in-mirror.json -o x.png
    row 0 '' 'x.png' draw "$examples/pump.glb" $small --look in-mirror.json --cut x -o x.png
    # Several files are one scene, solids among meshes.
    row 0 '' 'x.png' draw "$widget" "$gear" $small -o x.png
    row 0 '' '' info "$examples/csg/spanner.csg"; out 'solid: [0-9]+ operands'; out '^ +difference +\(line [0-9]+\)$'
    row 0 '' '' bench "$widget" --size 64x64 --look edges --repeat 2 --view top --ortho; out '^edges +[0-9.]+ +[0-9.]+'
    # Mistakes are told with line and column, what is left out with its line.
    printf 'group() {\n cube(size = 1;\n}' > in-wrong.csg
    row 2 '^limner: in-wrong.csg:2:15: expected' '' draw in-wrong.csg $small
    printf 'cube(size = 1);\nimport(file = "nosuch.stl");\n' > in-missing.csg
    row 0 'in-missing.csg, line 2: import\(\) is left out: .*No such file' 'x.png' draw in-missing.csg $small -o x.png
    printf 'cube(size = 1);\nroof() { square(size = 1); }\n' > in-unknown.csg
    row 0 'in-unknown.csg, line 2: roof\(\) is not known and left out' 'x.png' draw in-unknown.csg $small -o x.png
    printf 'difference() { cube(size = 1); cube(size = 1); }\n' > in-nothing.csg
    row 0 '' 'x.png' draw in-nothing.csg $small -o x.png
    # Programs need openscad, which nobody must have installed.
    cp "$examples/csg/widget.scad" in-program.scad
    without_openscad() { PATH=$folder/.nothing "$real" "$@"; }
    local real=$limner
    local limner=without_openscad
    row 2 '^limner: in-program.scad: a .scad file is a program that openscad must evaluate' '' draw in-program.scad $small
    row 2 '^hint: install OpenSCAD' '' draw in-program.scad $small
    limner=$real
    if ! command -v openscad > /dev/null; then
        echo "skipped: no openscad on the PATH"
        return
    fi
    printf 'n = 1;\ncube(n);\nassert(n < 3, "too large");\n' > in-program.scad
    row 0 '' '' info in-program.scad -D n=2; out '^bounds +0 0 0  to  2 2 2 '
    row 0 '' 'x.png' draw in-program.scad $small -D n=2 --strict -o x.png
    row 0 '' '' info in-program.scad "$gear" -D n=2
    row 2 '^limner: in-program.scad:3: openscad: ERROR: Assertion .*too large' '' draw in-program.scad $small -D n=3
    row 1 "^limner: in-program.scad: the definition is 'n'; allowed is NAME=VALUE" '' info in-program.scad -D n
    row 0 "no variable 'm'" 'x.png' draw in-program.scad $small -D m=2 -o x.png
    printf 'cube(1);\nnosuch();\n' > in-warned.scad
    row 0 "warning: openscad: WARNING: .*'nosuch'" 'x.png' draw in-warned.scad $small -o x.png
    row 2 "^limner: in-warned.scad:2: openscad: WARNING: .*'nosuch'" '' draw in-warned.scad $small --strict
}

group_strokes() {
    local pattern
    for pattern in parallel cross contour brick stipple scribble random; do
        row 0 '' "$pattern.png" strokes $pattern --size 64; is_png $pattern.png
        row 0 '' 'x.stx' strokes $pattern -o x.stx --count 600 --seed 3 && cp x.stx in-first.stx
        row 0 '' 'x.stx' strokes $pattern -o x.stx --count 600 --seed 3
        cmp -s x.stx in-first.stx || complain "two runs give different files"
        # Through a file nothing is lost.
        row 0 '' 'x.stx' strokes in-first.stx -o x.stx
        cmp -s x.stx in-first.stx || complain "the file is not written as it was read"
        row 0 '' 'x.svg' strokes in-first.stx -o x.svg && cp x.svg in-first.svg
        row 0 '' 'x.stx' strokes in-first.svg -o x.stx
        [ "$(wc -l < x.stx)" = "$(wc -l < in-first.stx)" ] || complain "the drawing has another number of strokes"
        row 0 '' 'x.png' strokes in-first.stx -o x.png --size 64 && cp x.png in-all.png
        row 0 '' 'x.png' strokes in-first.stx -o x.png --size 64 --light 0.7
        cmp -s x.png in-all.png && complain "--light changes nothing"
        row 0 '' 'x.png' strokes in-first.stx -o x.png --size 64 --distance 0.7
        cmp -s x.png in-all.png && complain "--distance changes nothing"
        row 0 '' 'x.png' strokes in-first.stx -o x.png --size 64 --width 5
        cmp -s x.png in-all.png && complain "--width changes nothing"
    done
    row 0 '' '' strokes in-first.stx --size 64
    [ -s in-first.png ] || complain "there is no in-first.png"
    rm -f in-first.png
    row 0 '' 'x.stx' strokes cross -o x.stx && cp x.stx in-cross.stx
    local options
    for options in '--length 0.1' '--uneven 0' '--order shuffled' '--order drawn' '--fraction count' '--fraction area' '--perspective tied' \
                   '--perspective layers' '--perspective random' '--count 100' '--seed 9'; do
        row 0 '' 'x.stx' strokes cross -o x.stx $options
        cmp -s x.stx in-cross.stx && complain "$options changes nothing"
    done
    row 0 '' '' strokes cross -o - --size 32; is_png .stdout
    row 0 '' '' strokes cross -o - --format stx; out '^# u0 v0 u1 v1 light perspective layer$'
    row 0 '' '' strokes cross -o - --format svg; out '^<svg '
    row 0 '' 'x.tmp' strokes cross -o x.tmp --format png --size 32; is_png x.tmp
    row 1 "there is no pattern 'crss'" '' strokes crss
    row 1 "did you mean 'cross'" '' strokes crss
    row 1 'a pattern is one of parallel, cross' '' strokes zzzzzzzz
    row 1 'no PATTERN.FILE is given' '' strokes
    row 1 "cannot tell the format from '.gif'" '' strokes cross -o x.gif
    row 1 'there is no such format' '' strokes cross --format gif
    row 1 '--count goes with a pattern' '' strokes in-cross.stx --count 5
    row 1 "--order is 'backwards'; allowed is one of drawn, shuffled, even" '' strokes cross --order backwards
    row 1 "--uneven is '2'; allowed is a number from 0 to 1" '' strokes cross --uneven 2
    row 1 "--size is '0'" '' strokes cross --size 0
    row 2 '^limner: nosuch.stx: cannot open' '' strokes nosuch.stx
    row 2 "^limner: strokes.gif: strokes are not read from files that end in '.gif'" '' strokes strokes.gif
    printf '0 0 1 1 1 1 0\n0 0 1 one 1 1 0\n' > in-bad.stx
    row 2 "^limner: in-bad.stx:2: v1 is 'one'; allowed is a number" '' strokes in-bad.stx
    row 2 '^hint: a line is u0 v0 u1 v1 light perspective layer' '' strokes in-bad.stx
    printf '<svg viewBox="0 0 1 1">\n<path d="M0 0 L 1"/></svg>' > in-bad.svg
    row 2 "^limner: in-bad.svg:2: a path's data is wrong" '' strokes in-bad.svg
    printf '<svg>' > in-open.svg
    row 2 '^limner: in-open.svg:1: this is not well-formed SVG' '' strokes in-open.svg
    : > in-none.stx
    row 0 '' 'x.png' strokes in-none.stx -o x.png --size 16; is_png x.png
    row 4 '^limner: nosuch/x.stx: ' '' strokes cross -o nosuch/x.stx
}

group_halftones() {
    local csg=$source/examples/csg/widget.csg spot=$source/examples/spot.obj small=(--size 120x100 --dpi 96 -o x.png)
    local kept; kept=$(mktemp -d) # not here, where each row begins with an empty folder
    export LIMNER_CACHE=$kept
    local bent=$kept/bent.json # bent strokes that are worked out for each pixel
    echo '{"version": 2, "name": "bent", "rules": [{"select": "*", "surface": {"technique": "screen", "screen": "contour", "scale": 3, "width": 1.425}}]}' > "$bent"
    # Solids throw shadows on every path.
    row 0 '' 'x.png' draw "$csg" --look gooch --set surface.technique=lit "${small[@]}"; mv x.png in-light.png
    row 0 '' 'x.png' draw "$csg" --look gooch --set surface.technique=lit --set scene.shadows=true "${small[@]}"
    cmp -s x.png in-light.png && complain "a solid throws no shadow"
    mv x.png in-shadow.png
    row 0 '' 'x.png' draw "$csg" --look gooch --set surface.technique=lit --set scene.shadows=true --set layers.evaluation=products "${small[@]}"
    cmp -s x.png in-light.png && complain "a solid of products throws no shadow"
    cmp -s x.png in-shadow.png || complain "shadows of a solid depend on how its surface is found"
    # Pencils whose lines are left out.
    row 0 '' 'x.png' draw "$csg" --look pencil --set lines.operator=none "${small[@]}"
    row 0 '' 'x.png' draw "$csg" --look pencil --set lines.operator=none --set perturb.overrun=12px "${small[@]}"
    # What was drawn before, and is kept, changes nothing.
    row 0 '' 'x.png' draw "$spot" --look "$bent" --set surface.scheme=multiply "${small[@]}"; mv x.png in-first.png
    row 0 '' 'x.png' draw "$spot" --look "$bent" "${small[@]}"
    row 0 '' 'x.png' draw "$spot" --look "$bent" --set surface.scheme=multiply "${small[@]}"
    cmp -s x.png in-first.png || complain "a kept texture changes the picture"
    LIMNER_CACHE= row 0 '' 'x.png' draw "$spot" --look "$bent" --set surface.scheme=multiply "${small[@]}"
    cmp -s x.png in-first.png || complain "without a cache the picture is another"
    row 0 '' 'x.png' draw "$spot" --look "$bent" "${small[@]}"; mv x.png in-sharp.png
    LIMNER_CACHE= row 0 '' 'x.png' draw "$spot" --look "$bent" "${small[@]}"
    cmp -s x.png in-sharp.png || complain "what another scheme has kept changes the picture"
    # Layers have no light maps: whole strokes are what they are without.
    row 0 '' 'x.png' draw "$spot" --look xray --set surface.technique=screen --set surface.coordinates=uv "${small[@]}"; mv x.png in-cut.png
    row 0 '' 'x.png' draw "$spot" --look xray --set surface.technique=screen --set surface.coordinates=uv --set surface.whole=true "${small[@]}"
    cmp -s x.png in-cut.png || complain "whole strokes in layers give another picture"
    # What gives no ink is said, what is wrong is refused.
    : > in-none.stx
    row 0 "^limner: warning: the screen of surface 'screen' has no ink anywhere" 'x.png' draw "$spot" --look "$bent" --set surface.screen=in-none.stx "${small[@]}"
    row 0 '^limner: warning: no material has strokes beside its picture' 'x.png' draw "$spot" --look "$bent" --set surface.screen=material "${small[@]}"
    row 1 "^limner: surface.screen is 'brik'; allowed is a pattern" '' draw "$spot" --look "$bent" --set surface.screen=brik "${small[@]}"
    row 1 "^hint: did you mean 'brick'" '' draw "$spot" --look "$bent" --set surface.screen=brik "${small[@]}"
    row 1 "^limner: surface.indication is 'x.gif'; allowed are pictures" '' draw "$spot" --look "$bent" --set surface.indication=x.gif "${small[@]}"
    row 2 '^limner: nosuch.stx: ' '' draw "$spot" --look "$bent" --set surface.screen=nosuch.stx "${small[@]}"
    rm -r "$kept"
}

# has FILE PATTERN: the file has it.
has() {
    grep -Eq -- "$2" "$1" || complain "$1 lacks: $2"
}

group_vectors() {
    local sheet=(--look technical)
    row 0 '' 'x.svg' draw "$gear" "${sheet[@]}" -o x.svg; has x.svg '^<svg xmlns="http://www.w3.org/2000/svg" width="270.933mm"'; cp x.svg in-first.svg
    has x.svg '<g id="view-iso-visible-part-1-contour" class="visible contour[" ]'
    row 0 '' 'x.svg' draw "$gear" "${sheet[@]}" -o x.svg
    cmp -s x.svg in-first.svg || complain "two runs give different files"
    row 0 '' '' draw "$gear" "${sheet[@]}" -o - --format svg; cmp -s .stdout in-first.svg || complain "standard output gets another drawing"
    row 0 '' 'gearbox.svg' draw "$gear" "${sheet[@]}" --format svg
    row 0 '' 'x.pdf' draw "$gear" "${sheet[@]}" -o x.pdf; has x.pdf '^%PDF-1'; cp x.pdf in-first.pdf
    row 0 '' 'x.pdf' draw "$gear" "${sheet[@]}" -o x.pdf
    cmp -s x.pdf in-first.pdf || complain "two runs give different files"
    row 0 '' 'x.dxf' draw "$gear" "${sheet[@]}" -o x.dxf; has x.dxf '^AC1015$'; has x.dxf '^VISIBLE-CONTOUR - '; has x.dxf '^HIDDEN-CREASE - '; has x.dxf '^DASHEDTINY$'
    row 0 '' 'a.svg b.json' draw "$box" "${sheet[@]}" -o a.svg --report b.json --verify; documented b.json report.md
    has b.json '"strokes": \{'; has b.json '"samples": [0-9]{2}'; has b.json '"bytes": [0-9]{3}'; has b.json '"unit": "m"'
    # Pages, scales, views.
    row 0 '' 'x.svg' draw "$gear" "${sheet[@]}" -o x.svg --page A4-landscape; has x.svg 'width="297mm" height="210mm" viewBox="0 0 297 210"'
    row 0 '' 'x.svg' draw "$gear" "${sheet[@]}" -o x.svg --page 120x80mm --scale 1:2; has x.svg '<desc>.*scale 1:2</desc>'
    row 0 '' 'x.svg' draw "$gear" "${sheet[@]}" -o x.svg --page A3 --views front,top,right,iso --frame --title 'A & <B>'
    local view; for view in front top right iso; do has x.svg "<g id=\"view-$view\" class=\"view\""; done
    has x.svg '<title>A &amp; &lt;B&gt;</title>'; has x.svg '>A &amp; &lt;B&gt;</text>'; cp x.svg in-third.svg
    row 0 '' 'x.svg' draw "$gear" "${sheet[@]}" -o x.svg --page A3 --views front,top,right,iso --frame --title 'A & <B>' --projection first
    cmp -s x.svg in-third.svg && complain "first angle is third angle"
    row 0 'warning: at 2:1 the views do not fit on the page' 'x.svg' draw "$gear" "${sheet[@]}" -o x.svg --views front,top --scale 2:1 --page A6
    # Cut faces have patterns, needles among their triangles or not; or lines.
    row 0 '' 'x.svg' draw "$examples/spot.obj" "${sheet[@]}" -o x.svg --cut x --view right; has x.svg 'fill:url\(#hatch'; has x.svg '<pattern id="hatch'
    row 0 '' 'x.svg' draw "$examples/spot.obj" "${sheet[@]}" -o x.svg --cut x --view right --loose-hatch; grep -q '<pattern' x.svg && complain "loose hatching has patterns"
    # A page that stays empty is no drawing.
    row 1 "^limner: $gear: nothing of the model lies on the page at 100000:1" '' draw "$gear" "${sheet[@]}" -o x.svg --views front,top --scale 100000:1 --page A6
    row 1 '^hint: it fits at --scale 1:5' '' draw "$gear" "${sheet[@]}" -o x.svg --views front,top --scale 100000:1 --page A6
    row 0 '' 'x.svg' draw "$gear" "${sheet[@]}" -o x.svg --views front,top --scale 1:2.5 --page A6
    row 1 "^limner: $gear: at 1:1000000 the model is 0\.0[0-9]+ mm large on the page" '' draw "$gear" "${sheet[@]}" -o x.svg --scale 1:1000000
    row 1 "^limner: $examples/spot.obj: at 1:100 the model is 0\.0[0-9]+ mm large" '' draw "$examples/spot.obj" "${sheet[@]}" -o x.svg --scale 1:100 --unit mm
    row 0 'warning: nothing of the model lies on the page' 'x.svg' draw "$gear" "${sheet[@]}" -o x.svg --scale 100000:1 --page A6 --lenient
    row 1 "the look 'plain' has no strokes for it" '' draw "$gear" --look plain -o x.dxf
    row 0 'warning: the file does not say its unit' 'x.svg' draw "$examples/spot.obj" "${sheet[@]}" -o x.svg --scale 50:1
    row 0 '' 'x.svg' draw "$examples/spot.obj" "${sheet[@]}" -o x.svg --scale 1:2 --unit cm
    # Plotters, areas, surfaces.
    row 0 '' 'x.svg' draw "$gear" "${sheet[@]}" -o x.svg --plotter; has x.svg '<g id="pen-1" class="pen[" ]'
    row 0 'warning: scene.ground: the shadow on the ground is left out' 'x.svg' draw "$box" --look toon -o x.svg --fill; has x.svg 'class="part fill[" ]'; grep -q '<image' x.svg && complain "areas lie over a picture"
    row 0 '' 'x.svg' draw "$box" --look toon -o x.svg; has x.svg '<image .*href="data:image/png;base64,'
    row 0 'warning: scene.ground: the shadow on the ground is left out' 'x.dxf' draw "$box" --look toon -o x.dxf
    row 0 '' 'x.svg' draw "$gear" --look wire -o x.svg; has x.svg 'class="hidden crease[" ]'
    row 0 '' 'x.svg' draw "$gear" --look blueprint -o x.svg; has x.svg 'class="hidden'
    row 0 '' 'x.svg' draw "$gear" --look blueprint -o x.svg --set layers.count=1
    grep -q 'class="hidden' x.svg && complain "one layer has hidden lines"
    # Solids have lines as meshes have; sections have lines and hatching.
    local widget=$examples/csg/widget.csg ending
    for ending in svg pdf dxf; do
        row 0 '' "x.$ending" draw "$gear" "${sheet[@]}" -o x.$ending --cut x
        row 0 '' "x.$ending" draw "$widget" "${sheet[@]}" -o x.$ending
        row 0 '' "x.$ending" draw "$gear" "$widget" "${sheet[@]}" -o x.$ending --cut 'box=50%,50%,50%:100%,100%,100%'
    done
    has x.dxf '^HATCH - '
    row 0 '' 'x.svg' draw "$widget" "${sheet[@]}" -o x.svg --cut x; has x.svg 'class="hatch[" ]'; has x.svg 'class="hidden crease[" ]'
    row 0 '' 'x.svg' draw "$widget" "${sheet[@]}" -o x.svg --cut x --set scene.cut_hatch=0pt
    grep -q 'class="hatch[" ]' x.svg && complain "hatching that was not wished for"
    # Where surfaces need pixels, the picture below is cut as the lines are.
    local pixels=(--look toon --set scene.ground=none --size 64x64 --dpi 96)
    row 0 '' 'x.svg' draw "$widget" "${pixels[@]}" -o x.svg --cut x; has x.svg 'class="hatch[" ]'
    row 0 '' 'y.svg' draw "$widget" "${pixels[@]}" -o y.svg
    [ "$(grep -o 'base64,[^"]*' x.svg | md5sum)" != "$(grep -o 'base64,[^"]*' y.svg | md5sum)" ] || complain "lines of a section over the picture of the whole"
    # What has no strokes is said.
    row 2 "^limner: $widget: marks lie on meshes: 1 solids of set operations" '' draw "$widget" --look stipple -o x.svg
    row 2 'lines of form' '' draw "$widget" "${sheet[@]}" -o x.svg --set lines.ridges=0.5
    row 2 'what solids take away has no lines' '' draw "$widget" --look ghost -o x.svg
    row 0 'warning: what solids take away has no lines' 'x.svg' draw "$widget" --look ghost -o x.svg --lenient
    grep -q 'selects no part' .stderr && complain "what solids take away is there, below the lines"
    printf '{"version":1,"name":"idle","rules":[{"select":"*","lines":"strokes"},{"select":"nosuch","lines":"strokes"}]}' > in-idle.json
    row 0 "warning: rule 1 of look 'idle' selects no part: 'nosuch'" 'x.svg' draw "$gear" --look ./in-idle.json -o x.svg
    # Wrong arguments, before any work.
    row 1 '--views goes with vector drawings' '' draw nosuch.stl --views front -o x.png
    row 1 '--plotter goes with vector drawings' '' draw nosuch.stl --plotter
    row 1 '--aov goes with pictures' '' draw nosuch.stl -o x.svg --aov maps
    row 1 '--samples goes with pictures' '' draw "$gear" -o x.svg "${sheet[@]}" --samples 4
    row 1 '--samples goes with pictures' '' draw nosuch.stl -o x.dxf --samples 4
    row 1 '--background does not go with .dxf' '' draw nosuch.stl -o x.dxf --background red
    row 1 '--fill does not go with .dxf' '' draw nosuch.stl -o x.dxf --fill
    row 1 '--fill does not go with --plotter' '' draw nosuch.stl -o x.svg --fill --plotter
    row 1 '--title needs --frame in .dxf' '' draw nosuch.stl -o x.dxf --title T
    row 1 '--projection says how --views lie' '' draw nosuch.stl -o x.svg --projection first
    row 1 '--verify puts its result into the report' '' draw nosuch.stl -o x.svg --verify
    row 1 '--fit does not go with --views' '' draw nosuch.stl -o x.svg --views front --fit 0.5
    row 1 '--fit does not go with --scale' '' draw nosuch.stl -o x.svg --scale 1:2 --fit 0.5
    row 1 '--page and --size exclude each other' '' draw nosuch.stl -o x.svg --page A4 --size 10x10
    row 1 '--views excludes' '' draw nosuch.stl -o x.svg --views front --view top
    row 1 '--scale is for parallel' '' draw nosuch.stl -o x.svg --scale 1:2 --fov 20
    row 1 "the page is 'A44'; allowed is" '' draw "$gear" -o x.svg "${sheet[@]}" --page A44
    row 1 "the scale is '1:0'; allowed is PAPER:MODEL" '' draw "$gear" -o x.svg "${sheet[@]}" --scale 1:0
    row 1 "the views are 'front,tip'; allowed is iso" '' draw "$gear" -o x.svg "${sheet[@]}" --views front,tip
    row 1 "the unit is 'ell'; allowed is mm" '' draw "$gear" -o x.svg "${sheet[@]}" --unit ell --scale 1:1
    row 1 "--projection is 'second'" '' draw "$gear" -o x.svg --projection second
    row 1 "the selection 'Nosuch\*' matches none" '' draw "$gear" -o x.svg "${sheet[@]}" --select 'Nosuch*'
    row 4 '^limner: nosuch/x.svg: ' '' draw "$gear" -o nosuch/x.svg "${sheet[@]}"
    row 2 '^limner: nosuch.stl: ' '' draw nosuch.stl -o x.svg
    # Lines alone need no OpenGL.
    __EGL_VENDOR_LIBRARY_DIRS=$folder/.nothing row 0 '' 'x.svg' draw "$gear" "${sheet[@]}" -o x.svg
    cmp -s x.svg in-first.svg || complain "without OpenGL lines are others"
    __EGL_VENDOR_LIBRARY_DIRS=$folder/.nothing row 3 '^limner: ' '' draw "$box" --look toon -o x.svg
    # Ctrl-C between drawings and in them.
    row="draw vectors with Ctrl-C"
    rows=$((rows + 1))
    local got=0 waited=0
    "$limner" draw "$gear" "${sheet[@]}" --lenient --frames 0:9999:24 -o 'f-{frame}.svg' 2> .stderr &
    until [ -e f-0000.svg ] || [ $((waited += 1)) -gt 600 ]; do sleep 0.1; done
    kill -INT $!
    wait $! || got=$?
    [ $got = 5 ] || complain "exit status $got, expected 5"
    find . -type f ! -name 'f-[0-9][0-9][0-9][0-9].svg' ! -name 'in-*' ! -name '.*' | grep -q . && complain "a half-written file stays behind"
    local last; last=$(ls f-*.svg | tail -n 1)
    tail -n 1 "$last" | grep -q '^</svg>$' || complain "$last is not whole"
    rm -f f-*.svg
}

# film FILE STREAM…: what ffprobe says of the film, as `width=65 … `.
film() {
    local file=$1 entry; shift
    ffprobe -v error -count_frames -select_streams v:0 -show_entries stream=width,height,r_frame_rate,nb_read_frames "$file" > .probe
    for entry; do grep -qx "$entry" .probe || complain "$file lacks $entry: $(tr '\n' ' ' < .probe)"; done
}

# like PICTURE OTHER LEAST: their signal-to-noise ratio in dB is at least that, with a fourth word: less.
like() {
    local noise
    noise=$(ffmpeg -v info -i "$1" -i "$2" -lavfi "[0:v]crop=64:48:0:0,format=rgb24[a];[1:v]crop=64:48:0:0,format=rgb24[b];[a][b]psnr" \
        -f null - 2>&1 < /dev/null | sed -n 's/.*PSNR.* average:\([0-9]*\|inf\).*/\1/p')
    [ "$noise" = inf ] && noise=1000
    if [ $# = 3 ]; then
        [ "${noise:-0}" -ge "$3" ] || complain "$1 is not like $2: ${noise:-nothing} dB, wanted $3"
    else
        [ "${noise:-1000}" -lt "$3" ] || complain "$1 is like $2, which is another frame"
    fi
}

group_films() {
    local moving=("$gear" --look sketch --set perturb.boil=24 --set perturb.amount=4 --size 65x49 --dpi 96) frames=(--frames 3:8:24) ending i
    # Wrong arguments, before any work.
    for ending in mp4 webm gif webp; do
        row 1 "^limner: .$ending is a film, which needs --frames" '' draw nosuch.stl -o x.$ending
        row 1 "^limner: -o has \{frame\}, but a film has all frames" '' draw nosuch.stl -o "x-{frame}.$ending" --frames 0:1:2
        row 1 '^limner: --resume does not go with a film' '' draw nosuch.stl -o x.$ending --frames 0:1:2 --resume
        row 1 '^hint: draw numbered pictures' '' draw nosuch.stl -o x.$ending --frames 0:1:2 --resume
        row 1 '^limner: --scale goes with vector drawings' '' draw nosuch.stl -o x.$ending --frames 0:1:2 --scale 1:2
        row 2 '^limner: nosuch.stl: ' '' draw nosuch.stl -o x.$ending --frames 0:1:2
    done
    row 1 'of films mp4, webm, gif or webp$' '' draw nosuch.stl --format avi --frames 0:1:2
    row 1 "cannot tell the format from '.avi'" '' draw nosuch.stl -o x.avi --frames 0:1:2
    row 1 '^hint: put \{frame\} into the name, or make it a film: .mp4' '' draw nosuch.stl -o x.png --frames 0:1:2
    row 1 "the name 'x.mp4' says mp4 and --format says png" '' draw nosuch.stl -o x.mp4 --format png --frames 0:1:2
    row 1 'frames cannot go to standard output' '' draw nosuch.stl -o - --format webp --frames 0:1:2
    row 1 '--report names one file for all frames' '' draw nosuch.stl -o x.webp --frames 0:1:2 --report r.json
    row 1 '^limner: --resume goes with frames' '' draw nosuch.stl --resume
    row 1 '^limner: --resume goes with numbered pictures' '' draw nosuch.stl --resume --frames 0:1:2 -o 'x-{frame}.svg'
    row 1 '^limner: x.gif: the film has 60 frames a second; allowed are 0.001 to 50' '' draw "$gear" -o x.gif --frames 0:1:60
    row 4 '^limner: nosuch/x.webp: ' '' draw "${moving[@]}" "${frames[@]}" -o nosuch/x.webp
    # Without ffmpeg: told before anything is read; .webp needs none.
    local command=$limner limner=$folder/.alone
    printf '#!/bin/sh\nPATH=/nosuch exec %s "$@"\n' "$command" > .alone && chmod +x .alone
    row 2 '^limner: x.mp4: films of this format are made by ffmpeg' '' draw nosuch.stl -o x.mp4 --frames 0:1:2
    row 2 '^hint: install it .*apt-get install ffmpeg' '' draw nosuch.stl -o x.webm --frames 0:1:2
    row 0 '' 'x.webp' draw "${moving[@]}" "${frames[@]}" -o x.webp; cp x.webp in-first.webp
    limner=$command
    row 0 '' 'x.webp' draw "${moving[@]}" "${frames[@]}" -o x.webp
    cmp -s x.webp in-first.webp || complain "two runs give different films"
    row 0 '' 'x.webp' draw "${moving[@]}" --frames 2:7:24 -o x.webp
    cmp -s x.webp in-first.webp && complain "other frames give the same film"
    row 0 '' 'gearbox.webp' draw "${moving[@]}" "${frames[@]}" --format webp; cmp -s gearbox.webp in-first.webp || complain "the standard name has another film"
    row 0 '' 'x.tmp' draw "${moving[@]}" "${frames[@]}" --format webp -o x.tmp
    row 0 '' 'box.webp gearbox.webp' draw "${moving[@]}" "$box" --frames 0:1:24 -o '{name}.webp'
    row 0 '' 'r-0000.json r-0001.json x.webp' draw "${moving[@]}" --frames 0:1:24 -o x.webp --report 'r-{frame}.json'; documented r-0001.json report.md
    row 0 "^limner: $gear: frame 2 of 2, [0-9]+ s left: drawn in [0-9]+ ms" 'x.webp' draw "${moving[@]}" --frames 0:1:24 -o x.webp -v
    row 0 'wrote x.webp \([0-9]+ bytes\)' 'x.webp' draw "${moving[@]}" --frames 0:1:24 -o x.webp -v
    row 1 "^limner: $gear: the model has no animation" '' draw "$gear" $small --frames 0:1:24 -o x.webp
    # What is warned of is warned of once.
    row 0 'warning: the clip runs from 0' 'x.webp' draw "$examples/box-animated.glb" $small -o x.webp --frames 3:6:1
    [ "$(grep -c warning .stderr)" = 1 ] || complain "the same warning comes for each frame"
    # A run that was broken off goes on: the same pictures, and only those that are missing are drawn.
    row 0 '' '' draw "${moving[@]}" "${frames[@]}" -o 'in-whole-{frame}.png'
    for i in 3 6 8; do cp in-whole-000$i.png in-f-000$i.png; done
    head -c 500 in-whole-0004.png > in-f-0004.png
    row 0 '' '' draw "$gear" --look plain $small -o in-f-0005.png # of another size
    touch -d 2001-01-01 in-f-*.png
    row 0 '^limner: 3 of 6 frames are there already$' '' draw "${moving[@]}" "${frames[@]}" -o 'in-f-{frame}.png' --resume
    for i in 3 4 5 6 7 8; do cmp -s in-f-000$i.png in-whole-000$i.png || complain "frame $i is another one"; done
    local kept; kept=$(find . -name 'in-f-*' ! -newermt 2001-01-02 -printf '%f\n' | sort | tr '\n' ' ')
    [ "$kept" = 'in-f-0003.png in-f-0006.png in-f-0008.png ' ] || complain "those that were there and stayed are $kept"
    row 0 '^limner: 6 of 6 frames are there already$' '' draw "${moving[@]}" "${frames[@]}" -o 'in-f-{frame}.png' --resume
    row 0 '' '' draw "${moving[@]}" "${frames[@]}" -o 'in-f-{frame}.png' --resume --quiet
    # A frame that has a report is done when that is there, too.
    row 0 '' 'r-0003.json r-0004.json' draw "${moving[@]}" --frames 3:4:24 -o 'in-f-{frame}.png' --report 'r-{frame}.json' --resume
    row 0 '' 'gearboxr-0003.json' draw "${moving[@]}" --frames 3:3:24 -o 'in-f-{frame}.png' --report '{name}r-{frame}.json' --resume
    films_interrupted
    # On a terminal the bar is that of all frames.
    row="draw frames on a terminal" rows=$((rows + 1))
    if command -v script > /dev/null; then
        script -qec "'$limner' draw '$gear' --look sketch --set perturb.boil=24 --size 65x49 --frames 3:8:24 -o x.webp" /dev/null < /dev/null | tr '\r' '\n' > .stderr
        grep -q 'frame 1 of 6 ' .stderr || complain "the first frame is not told"
        grep -Eq ' [5-9][0-9]% frame [4-6] of 6, [0-9]+ s left ' .stderr || complain "the time that is left is not told"
        [ -s x.webp ] || complain "there is no film"
    fi
    command -v ffprobe > /dev/null || { echo 'ffmpeg is not installed: films are not read back'; return; }
    # Read back: frames, rate, size, and what is on them.
    for ending in mp4 webm gif; do
        row 0 "$([ $ending = mp4 ] && echo '^limner: warning: films of .mp4 have even sizes: this one has 66x50 pixels')" x.$ending draw "${moving[@]}" "${frames[@]}" -o x.$ending
        film x.$ending nb_read_frames=6 width=$([ $ending = mp4 ] && echo 66 || echo 65) height=$([ $ending = mp4 ] && echo 50 || echo 49)
        [ $ending = gif ] || film x.$ending r_frame_rate=24/1
        ffmpeg -v error -i x.$ending .frame-%d.png < /dev/null # GIF's times are hundredths of a second: frame by frame
        for i in 1 2 3 4 5 6; do like .frame-$i.png in-whole-000$((i + 2)).png 33; done
        like .frame-1.png in-whole-0004.png 20 less
    done
    row 0 'warning: .mp4 has no opacity' 'x.mp4' draw "${moving[@]}" --frames 0:1:24 -o x.mp4 --background none
    row 0 'warning: in .gif a pixel is there or not' 'x.gif' draw "${moving[@]}" --frames 0:1:24 -o x.gif --background none
    row 0 '' 'x.webm' draw "${moving[@]}" --frames 0:1:24 -o x.webm --background none
}

# Ctrl-C in the middle of films leaves nothing, neither of them nor of ffmpeg.
group_depict() {
    local motion="$examples/walker.bvh" array='[{"target": "Hips", "depict": "path", "from": 0, "to": 1.5, "now": 1}]'
    row 0 '' walker.png depict "$motion" $small -q
    row 0 '' out.svg depict "$motion" -q -o out.svg
    row 0 '' out.png depict "$motion" $small -o out.png --explain -q
    out '"because"'
    out '"path"'
    # People: who walks has a way and was elsewhere, who crouches before he leaps does not go back where he came from.
    row 0 '' out.png depict "$examples/captured-walk.bvh" $small -o out.png --explain -q
    out '"path"'
    out '"still"'
    row 0 '' out.png depict "$examples/captured-jump.bvh" $small -o out.png --explain -q
    out '"path"'
    ! grep -q '"aside"' .stdout || complain "a jump is told as going back"
    # What is not told is said, unless nobody wants to hear it.
    row 0 'warning: nothing in the scene is animated' out.png depict "$examples/box.glb" $small -o out.png
    row 0 '' out.png depict "$examples/box.glb" $small -q -o out.png --explain
    out '"warnings": \['
    out 'nothing in the scene is animated'
    # What it explains is what it takes, and the same bytes come of it.
    "$limner" depict "$motion" $small -q -o in-first.png --time 1 --explain > in-told.json 2> /dev/null
    row 0 '' out.png depict "$motion" $small -q -o out.png --time 1 --expressions in-told.json
    "$limner" depict "$motion" $small -q -o .again.png --time 1 --expressions in-told.json && cmp -s .again.png in-first.png ||
        complain "expressions that were explained draw another picture"
    local told
    for told in "$motion" "$examples/box-animated.glb" "$examples/scripts/catapult.json"; do
        "$limner" depict "$told" $small -q -o in-first.png --explain > in-told.json 2> /dev/null
        row 0 '' out.png depict "$told" $small -q -o out.png --expressions in-told.json
        "$limner" depict "$told" $small -q -o .again.png --expressions in-told.json && cmp -s .again.png in-first.png ||
            complain "expressions that were explained draw another picture"
    done
    echo "$array" > in-path.json
    row 0 '' out.png depict "$motion" $small -q -o out.png -l line --expressions in-path.json
    row 0 '' out.png depict "$motion" $small -q -o out.png --interval 0.5:1
    row 1 '--interval' '' depict "$motion" --interval 1:0.5
    row 1 '--interval' '' depict "$motion" --interval soon
    row 2 '^limner: none.json: No such file' '' depict "$motion" --expressions none.json
    echo '[{"target": "Tail", "depict": "path"}]' > in-path.json
    row 2 "^limner: in-path.json:1:3: expression 1: .*'Tail'" '' depict "$motion" --expressions in-path.json
    echo '{' > in-path.json
    row 2 '^limner: in-path.json:2: ' '' depict "$motion" --expressions in-path.json
    echo '{"a": 1}' > in-path.json
    row 2 '^limner: in-path.json:1:1: there are no expressions' '' depict "$motion" --expressions in-path.json
    row 1 'behind the end of all motion' '' depict "$motion" --interval 50:60
    echo '[]' > in-path.json
    row 0 'warning: there are no expressions: nothing is told' out.png depict "$motion" $small -o out.png --expressions in-path.json
    echo '[{"target": "Hips", "depict": "expand"}]' > in-path.json
    row 0 "warning: expression 1, 'expand' of 'Hips', has no sign: it is as large" out.png depict "$motion" $small -o out.png --expressions in-path.json
    printf '{"limner_script": 1, "nodes": [{"name": "b", "sphere": {}}],\n "expressions": [\n  {"target": "b", "depict": "paht"}]}' > in-script.json
    row 2 "^limner: in-script.json:3:19: expression 1: there is no way to depict 'paht'" '' depict in-script.json
    row 1 '--interval' '' draw "$motion" --interval 0:1
    row 1 '--frames does not go with depict' '' depict "$motion" --frames 0:3:24 -o 'x-{frame}.png'
    row 1 '--explain' '' simulate "$motion" --explain
    echo '{"limner_script": 1, "nodes": [{"name": "blue", "box": {}}, {"name": "black", "box": {}}, {"name": "brown", "box": {}}, {"name": "red", "box": {}}],' \
        '"behaviour": {"target": "blue", "linear": [[0, 0, 0], [9, 0, 0]], "duration": 1}}' > in-three.json
    # A byte order mark is no part of the text; texts are cut at whole characters, and do not turn the line round.
    { printf '\xEF\xBB\xBF'; cat "$examples/scripts/bounce.json"; } > in-mark.json
    row 0 '' out.png depict in-mark.json $small -q -o out.png
    cp out.png in-mark.png
    row 0 '' out.png depict "$examples/scripts/bounce.json" $small -q -o out.png
    same out.png in-mark.png
    printf '\xEF\xBB\xBF[{"target": "Nobody", "depict": "path"}]' > in-path.json
    row 2 "^limner: in-path.json:1:[0-9]+: expression 1: .*'Nobody'" '' depict "$motion" --expressions in-path.json
    echo '[{"target": "\u202eNobody\u2066", "depict": "path"}]' > in-path.json
    row 2 "'.u202eNobody.u2066'" '' depict "$motion" --expressions in-path.json
    printf '[{"target": "Hips", "depict": "a%s"}]' "$(printf 'ä%.0s' {1..60})" > in-path.json
    row 2 "'a[ä]+'" '' depict "$motion" --expressions in-path.json
    iconv -f utf-8 -t utf-8 .stderr > .valid 2>&1 || complain "a message is no UTF-8"
    # Of several things that a pattern means it is said which is taken; nobody is his own partner.
    echo '[{"target": "b*", "depict": "path"}]' > in-path.json
    row 0 "warning: expression 1, 'path': its target means 3 things, of which 'blue' is taken" out.png depict in-three.json $small -o out.png --expressions in-path.json
    echo '[{"target": "blue", "depict": "collision", "partner": "blue"}]' > in-path.json
    row 2 "^limner: in-path.json:1:[0-9]+: expression 1: the partner is the target itself" '' depict in-three.json --expressions in-path.json
    # What is wrong with the time is said once; words that are allowed are all said.
    row 0 'later times are drawn' out.png depict "$motion" $small -o out.png --time 99
    [ "$(grep -c 'later times are drawn' .stderr)" = 1 ] || complain "a warning is said twice"
    echo '{"limner_script": 1, "nodes": [{"name": "b", "box": {}}], "behaviour": {"simultaneity": [{"target": "b", "constant": [0, 0, 0], "duration": 1}], "fit": "x"}}' > in-bad.json
    row 2 'stretch, start, centre, end, shrink' '' depict in-bad.json
    row 0 '' '' depict --help
    out 'six tenths'
    # A sign that Limner chose itself, and that shows nothing, is said, too.
    row 0 "warning: expression 3, 'motion' of '#3', has no sign: it rests at 2.2" out.png depict "$examples/box-animated.glb" $small -o out.png
    row 1 'cannot both go to standard output' '' depict "$motion" -o - --explain
    # A film of all that happens, by a command that reads the scene twice and ends.
    echo '{"limner_script": 1, "nodes": [{"name": "b", "box": {"size": [1, 1, 1]}, "translation": [0, 3, 0]}],' \
        '"behaviour": {"target": "b", "function": "bounce", "floor": 0.5, "duration": 0.25}}' > in-short.json
    row 0 '' sim.webp simulate in-short.json $small -q -o sim.webp
    # A ground ten times as large changes nothing of what is seen of the ball on it, unless a camera is given.
    local size
    echo '[{"target": "ball", "depict": "path"}, {"target": "ball", "depict": "still"}]' > in-ball.json
    for size in 40 400; do
        echo '{"limner_script": 1, "nodes": [{"name": "ground", "box": {"size": ['$size', 0.2, '$size']}, "translation": [0, -0.1, 0]},' \
            '{"name": "ball", "sphere": {"radius": 0.3}, "translation": [0, 2, 0]}],' \
            '"behaviour": {"target": "ball", "function": "bounce", "floor": 0.3, "velocity": [1, 0, 0], "duration": 2.5}}' > in-ground.json
        row 0 '' out.png depict in-ground.json --size 64x48 --dpi 96 -q -o out.png --expressions in-ball.json
        cp out.png in-$size.png
    done
    cmp -s in-40.png in-400.png || like in-40.png in-400.png 40
    # Where no font is installed, a noise that nobody wrote is left out, and what somebody wrote is refused.
    echo "<?xml version=\"1.0\"?><fontconfig><cachedir>$PWD/.fonts</cachedir></fontconfig>" > .fonts.conf
    export FONTCONFIG_FILE=$PWD/.fonts.conf
    row 0 "warning: 'POW' is left out: text: no font is installed" out.png depict in-ground.json $small -o out.png --explain
    cp .stdout in-told.json; cp out.png in-first.png
    row 0 '' out.png depict in-ground.json $small -o out.png --expressions in-told.json
    cmp -s out.png in-first.png || complain "expressions without noise draw another picture"
    echo '[{"target": "ball", "depict": "speech", "text": "Ow"}]' > in-path.json
    row 2 'no font is installed' '' depict in-ground.json --expressions in-path.json
    unset FONTCONFIG_FILE
    # A script says what is told of it, and how it is seen.
    local script=$examples/scripts/bounce.json
    row 0 '' bounce.png depict "$script" $small --explain
    out 'BOING'
    cp bounce.png in-script.png
    row 0 '' again.png depict "$script" $small -o again.png --view front --time 2.2 --look storyboard
    cmp -s again.png in-script.png || complain "what the script says is not what the command line says"
    row 0 '' other.png depict "$script" $small -o other.png --time 1
    cmp -s other.png in-script.png && complain "the command line does not count more than the script"
    # Of several stills each is what its own script says, and a bad one leaves the others alone.
    row 0 '' 'bounce.png box.png' depict "$examples/box.glb" "$script" $small -q -o '{name}.png'
    cmp -s bounce.png in-script.png || complain "one of several stills is not what its script says"
    sed 's/"time": 2.2/"tine": 2.2/' "$script" > in-bad.json
    row 1 "'tine'" bounce.png depict in-bad.json "$script" $small -q -o '{name}.png'
    for script in "$examples"/scripts/*.json "$examples"/scripts/changed/*.json; do
        row 0 '' out.png depict "$script" $small -q -o out.png
    done
    row 0 '' out.svg depict "$examples/scripts/crane.json" -q -o out.svg
    script=$examples/scripts/bounce.json
    sed 's/"time": 2.2/"tine": 2.2/' "$script" > in-bad.json
    row 1 "'tine'" '' depict in-bad.json
    sed 's/"view": "front"/"view": "above"/' "$script" > in-bad.json
    row 1 "no view 'above'" '' depict in-bad.json
}

films_interrupted() {
    local ending got waited bin; bin=$(mktemp -d) # not here, where each row begins with an empty folder
    printf '#!/bin/sh\necho $$ > %s/.started\nexec cat > /proc/self/fd/3\n' "$folder" > "$bin/ffmpeg" && chmod +x "$bin/ffmpeg"
    for ending in mp4 webp; do
        row="draw $ending with Ctrl-C" got=0 waited=0
        rows=$((rows + 1))
        PATH=$bin:$PATH "$limner" draw "${moving[@]}" --frames 0:99999:24 -o x.$ending --aov 'in-maps-{frame}' 2> .stderr &
        until [ -e in-maps-0003/depth.pfm ] || [ $((waited += 1)) -gt 600 ]; do sleep 0.1; done
        kill -INT $!
        wait $! || got=$?
        [ $got = 5 ] || complain "exit status $got, expected 5"
        [ -z "$(find . -name '*x.*' ! -name 'in-*')" ] || complain "something of the film stays behind"
        rm -r in-maps-*
    done
    [ -s .started ] || complain "ffmpeg was not started"
    sleep 0.3
    kill -0 "$(cat .started)" 2> .kill && complain "ffmpeg runs on"
    # One that fails is quoted.
    printf '#!/bin/sh\nhead -c 30000 > .taken\necho "it is too dark here" >&2\nexit 7\n' > "$bin/ffmpeg"
    PATH=$bin:$PATH row 4 '^limner: x.mp4: ffmpeg failed with exit status 7: it is too dark here$' '' draw "${moving[@]}" --frames 0:40:24 -o x.mp4 -q
    PATH=$bin:$PATH row 4 '^hint: ffmpeg got [0-9]+ whole frames' '' draw "${moving[@]}" --frames 0:40:24 -o x.mp4 -q
    rm -r "$bin"
}

group_doctor() {
    row 0 '' '' doctor; out 'Limner can draw here'; out '^  \.webp  '
    local command=$limner limner=$folder/.alone
    printf '#!/bin/sh\nPATH=/nosuch exec %s "$@"\n' "$command" > .alone && chmod +x .alone
    row 0 '' '' doctor; out '^  \.mp4 .* no: ffmpeg is missing \(sudo apt-get install ffmpeg\)$'
    limner=$command
    row 0 '' '' doctor; out '^  GDAL +([0-9]+\.[0-9]+|no: .*gdal-bin)'; out '^  PROJ +([0-9]+\.[0-9]+|no: .*gdal-bin)'
    row 0 '' '' doctor --json; documented .stdout doctor.md
    # An EGL without any vendor is a machine without drivers.
    export __EGL_VENDOR_LIBRARY_DIRS=$folder/.nothing
    row 3 '' '' doctor; out 'sudo apt-get install'
    row 3 '' '' doctor --json; out '"usable": false'; documented .stdout doctor.md
    row 3 '^limner: ' '' draw "$gear"
    row 2 '^limner: nosuch.stl: ' '' draw nosuch.stl
}

# tiles FIRST LAST PATTERN: names of all tiles of these zooms, as `row` sorts them.
tiles() {
    local z x y
    for z in $(seq "$1" "$2"); do for x in $(seq 0 $(((1 << z) - 1))); do for y in $(seq 0 $(((1 << z) - 1))); do
        printf "$3\n" $z $x $y
    done; done; done
}

group_tiles() {
    local look=(--look hatch) way check=$source/tests/cli/tiles.py cube=box-tiles all kept
    # Wrong arguments, before any work.
    row 1 "^limner: --zoom is '3:1'; allowed is FIRST:LAST with 0 up to 20" '' tiles nosuch.stl --zoom 3:1
    row 1 "^limner: --zoom is '0:21'" '' tiles nosuch.stl --zoom 0:21
    row 1 "^limner: --zoom is '1x'" '' tiles nosuch.stl --zoom 1x
    row 1 'picture of 32768 pixels a side with 1 sample each; with these the last possible zoom is 6$' '' tiles nosuch.stl --zoom 0:7
    row 1 'with these the last possible zoom is 4$' '' tiles nosuch.stl --zoom 5 --tile 512 --samples 4
    row 1 "^limner: --shard is '0/4'; allowed is I/N" '' tiles nosuch.stl --shard 0/4
    row 1 "^limner: --shard is '5/4'" '' tiles nosuch.stl --shard 5/4
    row 1 "^limner: --shard does not go with --job" '' tiles nosuch.stl --shard 1/4 --job slurm
    row 1 '^limner: --tasks goes with --job' '' tiles nosuch.stl --tasks 4
    row 1 '^limner: tiles cannot go to standard output' '' tiles nosuch.stl -o -
    row 1 '^limner: --camera excludes' '' tiles nosuch.stl --camera a --view top
    row 1 'no look .nosuch' '' tiles nosuch.stl --look nosuch
    row 2 '^limner: nosuch.stl: ' '' tiles nosuch.stl
    touch in-file
    row 1 "^limner: 'in-file' is a file; tiles go into a folder" '' tiles "$box" -o in-file
    row 4 '^limner: in-file/deep: ' '' tiles "$box" -o in-file/deep
    row 1 '^limner: --shard goes with frames as numbered pictures' '' draw "$box" --shard 1/2
    row 1 '^limner: --job goes with frames as numbered pictures' '' draw "$box" --job slurm -o x.webp --frames 0:1:24
    # What is drawn: all tiles of all zooms, which together are the one big picture.
    all=$( (tiles 0 2 $cube/%d/%d/%d.png; echo $cube/index.html; echo $cube/tiles.json) | LC_ALL=C sort | tr '\n' ' ')
    row 0 '' "${all% }" tiles "$box" "${look[@]}" --zoom 0:2
    documented $cube/tiles.json tiles.md
    has_size $cube/2/3/3.png 256 256
    kept=$(mktemp -d); mv $cube $kept/whole
    row 0 '' 'x.png' draw "$box" "${look[@]}" --size 1024x1024 --dpi 96 --samples 1 -o x.png
    python3 "$check" $kept/whole 2 256 x.png 2> .stderr || complain "the tiles are not the picture"
    # Shards together are the same, whatever their number and order; a run that goes on draws what is missing.
    row 0 '' "$( (tiles 1 1 x/%d/%d/%d.png; echo x/index.html; echo x/tiles.json) | tr '\n' ' ' | sed 's/ $//')" tiles "$box" "${look[@]}" --zoom 0:2 -o x --shard 2/3
    for way in 3 1; do "$limner" tiles "$box" "${look[@]}" --zoom 0:2 -o x --shard $way/3 2> .stderr || complain "shard $way"; done
    python3 "$check" same $kept/whole x 2> .stderr || complain "shards make other tiles"
    rm -r x/2/3 x/0; : > x/1/0/0.png; touch -d '2000-01-01' x/2/0/0.png
    "$limner" tiles "$box" "${look[@]}" --zoom 0:2 -o x --resume -v 2> .stderr || complain "no resuming"
    grep -q '3 blocks drawn into x' .stderr || complain "other blocks than what was missing"
    python3 "$check" same $kept/whole x 2> .stderr || complain "a resumed run makes other tiles"
    [ "$(stat -c %Y x/2/0/0.png)" = "$(date -d '2000-01-01' +%s)" ] || complain "a tile that was there is written again"
    # Another drawing does not go on there.
    for way in "--look toon" "--tile 512" "--view top" "--set surface.scale=9" "--seed 3"; do
        "$limner" tiles "$box" "${look[@]}" --zoom 0:2 -o x --resume $way 2> .stderr && complain "another drawing goes on: $way"
        grep -Eq 'tiles of another drawing|given twice' .stderr || complain "not told: $way"
    done
    # One file.
    row 0 '' 'x.mbtiles' tiles "$box" "${look[@]}" --zoom 0:2 -o x.mbtiles
    python3 "$check" packed x.mbtiles $kept/whole 2> .stderr || complain "the file has other tiles"
    # Scripts say the same command again, quoted.
    row 0 '' '' tiles "it's.glb" --job slurm --tasks 5 --set surface.scale=4 --look hatch --eye 1,2.5,3 -q
    out '^#SBATCH --array=1-5$'; out ' tiles --look hatch --set surface.scale=4 --eye 1,2.5,3 '"'it'\\\\''s.glb'"' --resume --quiet --shard "\$SLURM_ARRAY_TASK_ID/5"$'; out '^    exit 75$'
    bash -n .stdout || complain "the script is none"
    row 0 '' '' draw "$box" --frames 0:9:24 --job parallel
    out '^seq 8 \| parallel .*--resume-failed .* draw --frames 0:9:24 .*box.glb --resume --quiet --shard \{\}/8$'
    row 0 '' '' tiles "$box" -o x.mbtiles --job parallel; out ' && .* tiles --output x.mbtiles .*--resume --quiet$'
    rm -r "$kept"
}

group_cancel() {
    local got=0
    row="draw with Ctrl-C"
    rows=1
    "$limner" draw "$gear" --look sketch --set perturb.boil=12 --frames 0:9999:24 -o 'f-{frame}.png' 2> .stderr &
    local waited=0
    until [ -e f-0000.png ] || [ $((waited += 1)) -gt 600 ]; do sleep 0.1; done
    kill -INT $!
    wait $! || got=$?
    [ $got = 5 ] || complain "exit status $got, expected 5"
    find . -type f ! -name 'f-[0-9][0-9][0-9][0-9].png' ! -name .stderr | grep -q . && complain "a half-written file stays behind"
}

group_"$group"
printf '%d rows, %d wrong\n' $rows $wrong
[ $wrong = 0 ] && [ $rows -gt 0 ]
