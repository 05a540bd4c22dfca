#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# The ways of using the library from another project, each configured, built and run from nothing:
# carried in a folder (add_subdirectory), installed (find_package), and compiled without CMake.
# usage: consumers.sh vendored|installed|plain ROOT SCRATCH VERSION CMAKE GENERATOR CC
set -eu
way=$1 root=$2 scratch=$3 version=$4 cmake=$5 generator=$6
CC=$7
export CC
unset CFLAGS LDFLAGS CMAKE_PREFIX_PATH 2>/dev/null || :
here=$root/tests/packaging
rm -rf "$scratch"
mkdir -p "$scratch"

configure() { # configure SOURCE BUILD [OPTION...]
    from=$1 into=$2
    shift 2
    "$cmake" -G "$generator" -S "$from" -B "$into" -DCMAKE_BUILD_TYPE=Release "$@" >"$scratch/log" 2>&1 ||
        { cat "$scratch/log"; return 1; }
}

build() {
    "$cmake" --build "$1" >"$scratch/log" 2>&1 || { cat "$scratch/log"; return 1; }
}

says() { # says PROGRAM: the consumer's program works
    out=$("$1")
    [ "$out" = BQ_E_ARG ] || { echo "FAILED: $1 printed '$out'"; exit 1; }
}

case $way in
vendored)
    configure "$here/vendored" "$scratch/build" "-DBQHOST=$root"
    # Neither the parent's own file nor the library's get this project's warnings, let alone -Werror.
    if grep '"command"' "$scratch/build/compile_commands.json" | grep -E -e ' -W| -fsanitize| --coverage'; then
        echo "FAILED: flags of this project reach another one"
        exit 1
    fi
    grep -q 'consumer.c' "$scratch/build/compile_commands.json" || { echo "FAILED: nothing to look at"; exit 1; }
    build "$scratch/build"
    says "$scratch/build/vendored"
    ;;
installed)
    configure "$root" "$scratch/build" -DBQHOST_BUILD_TESTS=OFF -DBQHOST_BUILD_TOOLS=OFF "-DCMAKE_INSTALL_PREFIX=$scratch/prefix"
    build "$scratch/build"
    "$cmake" --install "$scratch/build" >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
    # Nothing of the source or build tree may be named in what was installed.
    if grep -rl "$scratch/build\|$root/src\|$root/include" "$scratch/prefix" --include='*.cmake'; then
        echo "FAILED: the package points into the tree it came from"
        exit 1
    fi
    configure "$here/installed" "$scratch/consumer" "-DCMAKE_PREFIX_PATH=$scratch/prefix" "-DBQHOST_WANTED=$version"
    build "$scratch/consumer"
    says "$scratch/consumer/installed"
    # canary: another version is not found
    if configure "$here/installed" "$scratch/other" "-DCMAKE_PREFIX_PATH=$scratch/prefix" -DBQHOST_WANTED=99.0.0 >/dev/null 2>&1; then
        echo "FAILED: version 99 was found"
        exit 1
    fi
    ;;
plain)
    for std in c99 c11 c17; do
        # shellcheck disable=SC2046
        "$CC" "-std=$std" -pedantic-errors -O1 -DBQHOST_CRC8=table16 -I "$root/include" "$here/consumer.c" \
            $(find "$root/src" "$root"/drivers/bq* -name '*.c') -o "$scratch/plain-$std"
        says "$scratch/plain-$std"
    done
    ;;
*)
    echo "unknown way: $way" >&2
    exit 2
    ;;
esac
rm -rf "$scratch"
echo "$way: builds and runs"
