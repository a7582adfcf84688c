#!/bin/sh
# Draws the pictures of the README, its gallery into docs/pictures/terrains:
#   docs/pictures/terrains.sh DATA
# DATA holds the elevation files named below: SRTM, a USGS DEM, and city models of Delft and Ann Arbor.
# Needs ./dev build.
set -eu
data=$(cd "${1:?DATA was expected: a folder with elevation files}" && pwd)
cd "$(dirname "$0")/../.."
reljef=${RELJEF:-build/release/bin/reljef}
mkdir -p docs/pictures/terrains

# draw NAME TERRAIN ARGUMENTS of reljef render
draw() {
    name=$1
    shift
    "$reljef" render "$@" --size 640x400 --samples 4 --quiet -o "docs/pictures/terrains/$name.jpg"
}

nature=$data/natural
cities=$data/urban
draw rainier "$nature/mt_rainier_90m.tif" --camera 46.76,-121.90,2900,45,0 --fov 40 --sun 265,20
draw st-helens "$nature/SainteHelens.dem" --camera 46.243,-122.192,2150,178,-1 --sun 265,25
draw kauai "$nature/srtm3/N22W160v2.3a.hgt.zip" --camera 22.32,-159.62,2600,165,-14 --sun 265,25
draw mont-blanc "$nature/srtm3/N45E006.hgt" --camera 45.74,6.78,3600,50,-5 --sun 250,14
draw normandy "$nature/srtm3/N49E001.hgt" --camera 49.93,1.25,700,215,-10 --exaggeration 3 --sun 300,12
draw natural natural --pose low
draw map "$nature/srtm3/N45E006.hgt" --projection orthographic --eye 20000,10000,9000 --look 20000,10000,0 --ramp swiss --sun 315,30 --contours 100 --marks legend,scale,north
draw clay "$nature/srtm3/N45E006.hgt" --ramp clay --base solid --sun 300,18
draw urban urban --eye=-180,-200,60 --look 0,0,0 --technique exact:shadow=hard --sun 250,35
draw delft "$cities/delft/tud-dsm-5m.tif" --camera 51.9935,4.363,140,25,-10 --ramp clay --sun 245,18
draw ann-arbor "$cities/annarbor/test_dsm.tif" --camera 42.2702,-83.7375,370,0,-18 --ramp stretched --sun 245,25
"$reljef" render natural --pose low --technique relief --compare errors --size 640x400 --quiet \
    -o docs/pictures/terrains/errors.jpg
"$reljef" render "$nature/srtm3/N45E006.hgt" --camera 45.72,6.72,4300,38,-10 --fov 45 --sun 270,18 \
    --samples 4 --size 1100x620 --quiet -o terrains/pictures/alps.jpg
