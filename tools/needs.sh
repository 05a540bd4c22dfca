#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Sourced by test.sh and demo.sh: sees to compiler, CMake and a build program, and sets
#   root        top of the tree
#   jobs        parallel jobs
#   generator   Ninja or Unix Makefiles
# Installs what is missing when it may (root or password-less sudo, and apt-get); otherwise says what to install and exits 1.
# want_tools does the same for what only some tests need: cross compilers, emulators, clang. Without them those are skipped.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
jobs=$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 2)
export TMPDIR="$root/build/tmp"
mkdir -p "$TMPDIR"
cmake_least=3.22

have() { command -v "$1" >/dev/null 2>&1; }

cmake_works() {
    have cmake || return 1
    local version
    version=$(cmake --version | sed -n '1s/[^0-9]*\([0-9.]*\).*/\1/p')
    [ "$(printf '%s\n%s\n' "$cmake_least" "$version" | sort -V | head -n 1)" = "$cmake_least" ]
}

compiler_works() {
    have gcc && have ar && printf '#include <stdio.h>\nint main(void) { return 0; }\n' |
        gcc -x c - -o "$TMPDIR/compiler-works" 2>/dev/null
}

missing() { # names of the Debian packages that are still needed
    compiler_works || echo gcc libc6-dev
    cmake_works || echo cmake
    have ninja || have make || echo ninja-build
}

install_packages() { # install_packages NAME...: 1 if not allowed, the status of apt-get otherwise
    local as=()
    have apt-get || return 1
    if [ "$(id -u)" != 0 ]; then
        have sudo && sudo -n true 2>/dev/null || return 1
        as=(sudo -n)
    fi
    echo "installing: $*"
    "${as[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -qq &&
        "${as[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >/dev/null
}

need_tools() {
    local packages
    packages=$(missing | tr '\n' ' ')
    if [ -n "$packages" ]; then
        # shellcheck disable=SC2086
        install_packages $packages || true
        packages=$(missing | tr '\n' ' ')
    fi
    if [ -n "$packages" ]; then
        {
            echo "Missing, and not installed by this script: $packages"
            echo "Needed: gcc with the C library's headers, cmake $cmake_least or newer, ninja or make. On Debian or Ubuntu:"
            echo "    apt-get install gcc libc6-dev cmake ninja-build"
        } >&2
        exit 1
    fi
    if have ninja; then generator=Ninja; else generator="Unix Makefiles"; fi
}

arm_works() { # compiler, C library and the python that seals the image
    have python3 && have arm-none-eabi-gcc &&
        echo 'int main(void) { return 0; }' | arm-none-eabi-gcc --specs=nano.specs --specs=nosys.specs -x c - -o "$TMPDIR/arm-works" 2>/dev/null
}

unicorn_works() {
    echo '#include <unicorn/unicorn.h>' | gcc -fsyntax-only -x c - 2>/dev/null
}

wished() { # names of the Debian packages that more tests could use
    arm_works || echo gcc-arm-none-eabi libnewlib-arm-none-eabi python3
    unicorn_works || echo libunicorn-dev
    have qemu-system-arm || echo qemu-system-arm
    have clang-19 && have ld.lld-19 && have llvm-objcopy-19 || echo clang-19 lld-19 llvm-19
    have riscv64-unknown-elf-gcc || echo gcc-riscv64-unknown-elf
}

want_tools() { # never fails: what is still missing is the business of the tests that need it
    local packages package
    packages=$(wished | tr '\n' ' ')
    [ -n "$packages" ] || return 0
    # shellcheck disable=SC2086
    install_packages $packages && return 0
    for package in $(wished | tr '\n' ' '); do # one that does not exist here must not keep the others away
        install_packages "$package" >/dev/null 2>&1 || break
    done
    return 0
}

# A build tree of another generator or another place cannot be used again.
fresh_if_foreign() { # fresh_if_foreign BUILD_DIRECTORY
    local cache=$1/CMakeCache.txt
    [ -f "$cache" ] || return 0
    if ! grep -qxF "CMAKE_GENERATOR:INTERNAL=$generator" "$cache" || ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$cache"; then
        rm -rf "$1"
    fi
}

build_preset() { # build_preset PRESET [OPTION...] [-- TARGET...]
    local preset=$1 options=() targets=()
    shift
    while [ $# -gt 0 ] && [ "$1" != -- ]; do options+=("$1"); shift; done
    [ $# -eq 0 ] || { shift; targets=(--target "$@"); }
    fresh_if_foreign "$root/build/$preset"
    (cd "$root" && cmake --preset "$preset" -G "$generator" "${options[@]}") >"$TMPDIR/$preset.log" 2>&1 &&
        cmake --build "$root/build/$preset" -j "$jobs" "${targets[@]}" >>"$TMPDIR/$preset.log" 2>&1 && return 0
    grep -vE "^\[[0-9]+/[0-9]+\]|^-- " "$TMPDIR/$preset.log" | tail -n 60 >&2
    return 1
}
