#!/usr/bin/env bash
# install_test.sh CMAKE SOURCE BUILD: installs the build, builds the README's example against the
# package as a project of its own, and runs it over a folder of DEMs.
set -euo pipefail
cmake=$1 source=$2 build=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export XDG_CACHE_HOME=$folder/cache LIBGL_ALWAYS_SOFTWARE=1

fail() {
    echo "$1" >&2
    exit 1
}

# run WHAT COMMAND...: quiet, but for a failure
run() {
    local what=$1
    shift
    "$@" >"$folder/log" 2>&1 || {
        cat "$folder/log" >&2
        fail "$what failed"
    }
}

project() { # project NAME CMAKE_LINE...: a program that links reljef
    mkdir -p "$folder/$1"
    {
        echo 'cmake_minimum_required(VERSION 3.25)'
        echo "project($1 CXX)"
        printf '%s\n' "${@:2}"
    } >"$folder/$1/CMakeLists.txt"
}

dem() { # dem FILE WEST: 33 x 33 samples of 0.001 degrees
    {
        printf 'ncols 33\nnrows 33\nxllcenter %s\nyllcenter 45\ncellsize 0.001\n' "$2"
        awk 'BEGIN { for (r = 0; r < 33; r++) { for (c = 0; c < 33; c++) printf "%d ", 500 + (r * c) % 97; print "" } }'
    } >"$folder/dems/$1.asc"
    echo 'GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]]' \
        >"$folder/dems/$1.prj"
}

quick=-DCMAKE_CXX_FLAGS_RELEASE='-O0 -DNDEBUG' # what is built runs once
prefix=$folder/prefix
for component in programs library docs; do
    run "installing $component" "$cmake" --install "$build" --prefix "$folder/elsewhere" --component $component
done
mv "$folder/elsewhere" "$prefix" # what is installed may lie anywhere
[[ $("$prefix/bin/reljef" --version) == reljef* ]] || fail "the installed reljef tells no version"
[[ -x $prefix/libexec/reljef/reljef-mesh-import ]] || fail "the program that imports meshes is not installed"
(cd "$folder" && run "the installed reljef" "$prefix/bin/reljef" render urban --size 64x48 -o installed.jpg --quiet)
[[ -s $folder/installed.jpg ]] || fail "the installed reljef wrote no picture"
[[ -s $prefix/share/doc/reljef/README.md ]] || fail "the README is not installed"

project consumer 'find_package(reljef 0.1 REQUIRED)' 'add_executable(consumer main.cpp)' \
    'target_link_libraries(consumer PRIVATE reljef::reljef)' \
    'add_executable(reader reader.cpp)' 'target_link_libraries(reader PRIVATE reljef::io)'
printf '%s\n' '#include <cstdio>' '#include "engine/io/image/image.h"' 'int main(int, char** files) {' \
    'const auto picture = reljef::io::read_image(files[1]);' \
    'return picture ? 0 : std::puts(picture.error().message.c_str()); }' >"$folder/consumer/reader.cpp"
awk '/^```cpp$/ { on = 1; next } /^```$/ { on = 0 } on' "$source/README.md" >"$folder/consumer/main.cpp"
run "configuring against the package" "$cmake" -S "$folder/consumer" -B "$folder/consumer/build" \
    -G Ninja -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Release "$quick"
run "building against the package" "$cmake" --build "$folder/consumer/build"
mkdir "$folder/dems"
dem west 7.0
dem east 7.032
rm -r "$prefix/libexec" # the package of the library has a module of its own
(cd "$folder" && run "the program" "$folder/consumer/build/consumer" "$folder/dems")
[[ $(head -c 8 "$folder/picture.png" | od -An -tx1 | tr -d ' \n') == 89504e470d0a1a0a ]] ||
    fail "the program wrote no picture"
run "the program that reads a picture" "$folder/consumer/build/reader" "$folder/picture.png"

# One room from another project's tree. Its own standard and warnings stay its own.
project parent 'set(CMAKE_CXX_STANDARD 17)' "add_subdirectory($source reljef EXCLUDE_FROM_ALL)" \
    'add_executable(parent main.cpp)' 'target_link_libraries(parent PRIVATE reljef::geo)'
printf '%s\n' '#include "engine/geo/georeference.h"' \
    'int main() { return reljef::geo::geodesic_distance({0, 0, 0}, {0, 0, 0}) == 0.0 ? 0 : 1; }' \
    >"$folder/parent/main.cpp"
run "configuring as a subdirectory" "$cmake" -S "$folder/parent" -B "$folder/parent/build" -G Ninja \
    -DCMAKE_BUILD_TYPE=Release "$quick"
run "building as a subdirectory" "$cmake" --build "$folder/parent/build"
run "the program" "$folder/parent/build/parent"

# An older standard is one sentence.
if g++ -std=c++17 -I"$prefix/include/reljef" -fsyntax-only "$folder/consumer/main.cpp" 2>"$folder/log"; then
    fail "C++17 was taken"
fi
grep -q 'error: #error "reljef needs C++20' "$folder/log" || fail "C++17 is not named: $(head -n 3 "$folder/log")"

# A prefix that cannot be written is one sentence, and nothing is installed.
touch "$folder/file"
if "$cmake" --install "$build" --prefix "$folder/file/prefix" 2>"$folder/log" >"$folder/out"; then
    fail "a prefix below a file was taken"
fi
tr -s ' \n' ' ' <"$folder/log" | grep -q 'file/prefix: cannot be written, an install prefix that can be was expected' ||
    fail "the prefix is not named: $(cat "$folder/log")"
! grep -q Installing "$folder/out" || fail "something was installed"
