#!/bin/sh
# Remakes the pictures of the pages on the techniques, all or those named:
#   docs/pictures/remake.sh [gallery] [light] [triangles] [parallax] [steps] [skipping] [warping] [options] [ground] [silhouettes]
# Needs ./dev build, and montage of ImageMagick.
set -eu
cd "$(dirname "$0")/../.."
reljef=${RELJEF:-build/release/bin/reljef}
panels=$(mktemp -d)
trap 'rm -rf "$panels"' EXIT

# panel NUMBER LABEL ARGUMENTS of reljef render
panel() {
    number=$1
    label=$2
    shift 2
    "$reljef" render "$@" --size 420x320 --quiet -o "$panels/$number.png"
    convert "$panels/$number.png" -gravity southwest -font DejaVu-Sans -pointsize 16 \
        -fill white -undercolor '#000000b0' -annotate +2+4 " $label " "$panels/$number.png"
}

# sheet NAME: the panels there are, two in a row
sheet() {
    montage "$panels"/*.png -tile 2x -geometry +0+0 -define jpeg:extent=148KB -strip "docs/pictures/$1.jpg"
    rm "$panels"/*.png
}

city() {
    number=$1
    label=$2
    shift 2
    panel "$number" "$label" urban --eye=60,-200,80 --look=-20,0,5 "$@"
}

wall() {
    number=$1
    label=$2
    shift 2
    panel "$number" "$label" gallery --textures brick --sun 250,30 --eye=-5.2,1.9,2.2 \
        --look=-1.5,3.4,1.4 "$@"
}

land() {
    number=$1
    label=$2
    shift 2
    panel "$number" "$label" natural --pose low --wireframe "$@"
}

gallery() {
    "$reljef" render gallery --path docs/pictures/gallery_path.toml --frames 8 --size 800x500 \
        --quiet -o "$panels/%04d.png" --contact-sheet docs/pictures/gallery.jpg
    rm "$panels"/*.png
}

light() {
    wall 1 texture --technique texture
    wall 2 normal --technique normal
    wall 3 bump --technique bump
    wall 4 emboss --technique emboss
    sheet light
}

triangles() {
    land 1 'polygons:lods=3' --technique polygons:lods=3
    land 2 'polygons:lods=5' --technique polygons:lods=5
    land 3 'polygons:error=4' --technique polygons:error=4
    wall 4 displacement --technique displacement:texels=2
    sheet triangles
}

parallax() {
    city 1 texture --technique texture
    city 2 parallax --technique parallax
    city 3 parallax-iterated --technique parallax-iterated
    city 4 'the truth' --truth
    sheet parallax
}

steps() {
    city 1 steep --technique steep
    city 2 relief --technique relief
    city 3 interval --technique interval
    city 4 'the truth' --truth
    sheet steps
}

skipping() {
    city 1 cone --technique cone
    city 2 'cone, step=0' --technique cone:step=0
    city 3 exact --technique exact
    city 4 'the truth' --truth
    sheet skipping
}

warping() {
    city 1 texture --technique texture
    city 2 prewarp --technique prewarp
    city 3 exact --technique exact
    city 4 'the truth' --truth
    sheet warping
}

options() {
    city 1 exact --technique exact
    city 2 shadow=hard --technique exact:shadow=hard
    city 3 shadow=soft --technique exact:shadow=soft
    city 4 'relief, edges=smooth' --technique relief:edges=smooth
    sheet options
}

hill() {
    number=$1
    label=$2
    shift 2
    panel "$number" "$label" natural --max-error 1 --eye=0,-3000,774 --look=300,-2400,765 "$@"
}

ground() {
    panel 1 'no tile' urban --pose low
    panel 2 'cobble, 3 m wide' urban --pose low --detail cobble:width=3
    hill 3 'no tile'
    hill 4 'rock, 14 m wide, shadow=hard' --detail rock:width=14,scale=0.1 \
        --detail-technique exact:shadow=hard
    sheet ground
}

ball() {
    number=$1
    label=$2
    shift 2
    panel "$number" "$label" gallery --eye=-0.6,-4.2,2.2 --look=0.6,0,1.4 "$@"
}

silhouettes() {
    ball 1 exact --technique exact
    ball 2 silhouettes=true --technique exact:silhouettes=true
    sheet silhouettes
}

for name in "${@:-all}"; do
    case $name in
    all) for each in gallery light triangles parallax steps skipping warping options ground silhouettes; do "$each"; done ;;
    gallery | light | triangles | parallax | steps | skipping | warping | options | ground | silhouettes) "$name" ;;
    *)
        echo "remake.sh: '$name' found, the name of a picture was expected" >&2
        exit 2
        ;;
    esac
done
