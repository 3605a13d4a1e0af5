#!/bin/bash
# libraries.sh SOURCES PREFIX - builds the libraries of the WebAssembly module from Debian's sources (.ci/setup-wasm)
# with emscripten: PREFIX/include and PREFIX/lib.
set -euo pipefail

sources=$(realpath "$1") prefix=$2
mkdir -p "$prefix/include" "$prefix/lib"
prefix=$(realpath "$prefix")
work=$prefix/work
rm -rf "$work" && mkdir "$work"

# unpacked NAME: the folder of its sources.
unpacked() {
    local found
    found=$(compgen -G "$sources/$1-[0-9]*/" | head -n 1)
    [[ $found ]] || {
        echo "libraries.sh: the sources of $1 are missing; run: make setup-wasm" >&2
        exit 1
    }
    echo "${found%/}"
}

# compile LIBRARY FOLDER FILE.. [-- OPTION..]: an archive of C files, named without their ending.
compile() {
    local library=$1 folder=$2
    local -a files=()
    shift 2
    while (($#)) && [[ $1 != -- ]]; do
        files+=("$1")
        shift
    done
    printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -I FILE emcc -O3 -c -iquote "$prefix/include" \
        -I"$prefix/include" "${@:2}" -o "$work/$library-FILE.o" "$folder/FILE.c"
    emar rcs "$prefix/lib/lib$library.a" "$work/$library"-*.o
}

# with_cmake NAME TARGET OPTION..: builds a library with its own cmake files, in $work/NAME.
with_cmake() {
    local folder
    folder=$(unpacked "$1")
    emcmake cmake -S "$folder" -B "$work/$1" -DCMAKE_BUILD_TYPE=Release "${@:3}" &&
        cmake --build "$work/$1" --target "$2" --parallel "$(nproc)"
}

folder=$(unpacked zlib)
cp "$folder"/{zlib,zconf}.h "$prefix/include"
sed -i 's/^#ifdef HAVE_UNISTD_H.*/#if 1/' "$prefix/include/zconf.h" # as its configure script does
compile z "$folder" adler32 compress crc32 deflate gzclose gzlib gzread gzwrite infback inffast inflate inftrees \
    trees uncompr zutil -- -DHAVE_UNISTD_H

folder=$(unpacked libpng1.6)
cp "$folder"/{png,pngconf}.h "$prefix/include"
cp "$folder/scripts/pnglibconf.h.prebuilt" "$prefix/include/pnglibconf.h"
compile png "$folder" png pngerror pngget pngmem pngpread pngread pngrio pngrtran pngrutil pngset pngtrans \
    pngwio pngwrite pngwtran pngwutil

folder=$(unpacked libyaml)
cp "$folder/include/yaml.h" "$prefix/include"
compile yaml "$folder/src" api dumper emitter loader parser reader scanner writer -- -DYAML_VERSION_MAJOR=0 \
    -DYAML_VERSION_MINOR=2 -DYAML_VERSION_PATCH=5 '-DYAML_VERSION_STRING="0.2.5"'

folder=$(unpacked kissfft)
mkdir -p "$prefix/include/kissfft"
cp "$folder"/kiss_fft{,nd}.h "$prefix/include/kissfft"
compile kissfft "$folder" kiss_fft kiss_fftnd

with_cmake jansson jansson -DJANSSON_BUILD_DOCS=OFF -DJANSSON_WITHOUT_TESTS=ON -DJANSSON_EXAMPLES=OFF
cp "$work"/jansson/include/*.h "$prefix/include"
cp "$work"/jansson/lib/libjansson.a "$prefix/lib"

# cmake's test for the size of size_t needs a program that runs.
with_cmake libjpeg-turbo jpeg-static -DWITH_SIMD=0 -DENABLE_SHARED=0 -DWITH_TURBOJPEG=0 -DSIZE_T=4 -DHAVE_SIZE_T=1 \
    -DUNSIGNED_LONG=4 -DHAVE_UNSIGNED_LONG=1
cp "$work/libjpeg-turbo/jconfig.h" "$(unpacked libjpeg-turbo)"/{jpeglib,jmorecfg,jerror}.h "$prefix/include"
cp "$work/libjpeg-turbo/libjpeg.a" "$prefix/lib"

# Headers as installed, which include what cmake would configure. Its locks are stubs: the module has no threads.
folder=$(unpacked openexr)
mkdir -p "$prefix/include/OpenEXR"
cp /usr/include/OpenEXR/{openexr*,OpenEXRConfig,IlmThreadConfig}.h \
    /usr/include/Imath/{Imath{Config,Export,Namespace,Platform},half}.h "$prefix/include/OpenEXR"
mapfile -t names < <(cd "$folder/src/lib/OpenEXRCore" && ls ./*.c)
names=("${names[@]#./}")
compile OpenEXRCore "$folder/src/lib/OpenEXRCore" "${names[@]%.c}" -- -I"$prefix/include/OpenEXR"

# Random123 is copied, because -I/usr/include would also find the headers of the machine's C library. Random123 refuses
# architectures that its authors did not try; test_random compares its numbers with published ones.
cp -r /usr/include/Random123 "$prefix/include"
sed -i 's/ && !defined(__arm__)/& \&\& !defined(__wasm__)/' "$prefix/include/Random123/features/gccfeatures.h"
rm -r "$work"
