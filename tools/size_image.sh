#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Flash and RAM of a firmware image, whole and module by module, as tables in Markdown.
# usage: tools/size_image.sh BOARD.elf [BOARD.map]   the map is that of the GNU linker or of lld; default: beside the .elf
# The size tool is arm-none-eabi-size, or $SIZE. Of an image that was optimised as a whole the map knows no modules: its functions
# are counted where they were written (inlined ones with their caller), constants and strings as one row.
set -eu
elf=${1:?usage: size_image.sh BOARD.elf [BOARD.map]}
map=${2:-${elf%.elf}.map}
size=${SIZE:-arm-none-eabi-size}

echo "| image | flash | RAM | of it stack, guard and crash record |"
echo "|---|---|---|---|"
"$size" -A "$elf" | awk -v name="$(basename "$elf" .elf)" '
    $1 == ".vectors" || $1 == ".text" || $1 == ".data" { flash += $2 }
    $1 == ".noinit" { stack = $2 }
    $1 == ".noinit" || $1 == ".data" || $1 == ".bss" { ram += $2 }
    END { printf "| %s | %d | %d | %d |\n", name, flash, ram, stack }'

if grep -q 'ltrans[0-9]*\.ltrans\.o' "$map"; then
    echo
    echo "| module | flash |"
    echo "|---|---|"
    flash=$("$size" -A "$elf" | awk '$1 == ".vectors" || $1 == ".text" || $1 == ".data" { flash += $2 } END { print flash }')
    arm-none-eabi-nm -S -l "$elf" | awk -F '\t' -v flash="$flash" '
        function hex(text,    i, value) {
            for (i = 1; i <= length(text); i++) value = value * 16 + index("0123456789abcdef", substr(text, i, 1)) - 1
            return value
        }
        split($1, word, " ") != 4 || word[3] !~ /[TtWw]/ || $2 == "" || seen[word[1]]++ { next }
        { module = $2; sub(/\.[ch]:[0-9]+$/, "", module)
          if (module ~ /\/hal\/boards\//) module = "board"
          else if (sub(/.*\/hal\//, "hal/", module)) sub(/\/[^\/]*$/, "", module)
          else sub(/.*\//, "library: ", module)
          bytes[module] += hex(word[2]); rest -= hex(word[2]) }
        END { for (m in bytes) printf "| %s | %d |\n", m, bytes[m]
              printf "| constants, strings, vectors, compiler | %d |\n", flash + rest }' | sort
    exit
fi

echo
echo "| module | flash | RAM |"
echo "|---|---|---|"
# GNU: " .text.name  0xaddress  0xsize  file", the name on a line of its own when it is long; lld: "address load size
# align file:(.text.name)". Modules by the path of the object, libraries of the compiler by their archive.
awk '
    function number(text,    i, value) {
        if (text !~ /^0x/) return text + 0
        text = tolower(substr(text, 3))
        for (i = 1; i <= length(text); i++) value = value * 16 + index("0123456789abcdef", substr(text, i, 1)) - 1
        return value
    }
    function hex(text) { return number("0x" text) }
    function module(file) {
        if (file ~ /libbqhost\.a/) {
            sub(/.*\(/, "", file); sub(/\).*/, "", file)
            return "library: " kind(file)
        }
        if (file ~ /libbqhost_hal/) { sub(/.*libbqhost_hal_/, "", file); sub(/\.a.*/, "", file); return "hal/" file }
        if (file ~ /\.dir\//) return "board"
        if (file ~ /lib[a-z_]+\.a/) { sub(/.*\/lib/, "lib", file); sub(/\(.*/, "", file); return file }
        return "other"
    }
    function kind(object) { sub(/\.c\.o(bj)?$/, "", object); return object }
    function add(section, bytes, file,    m) {
        if (bytes == 0) return
        m = module(file)
        seen[m]
        if (section ~ /^\.(text|rodata|vectors|image_header|data|ramcode)/) flash[m] += bytes
        if (section ~ /^\.(bss|data|ramcode)/ || section == "COMMON") ram[m] += bytes
    }
    /^ *VMA +LMA/ { lld = 1; next }
    /^Linker script and memory map/ { gnu = 1; next }
    lld && NF >= 5 && $5 ~ /:\(/ {
        section = file = $5; sub(/.*:\(/, "", section); sub(/\).*/, "", section); sub(/:\([^(]*$/, "", file)
        add(section, hex($3), file)
        next
    }
    gnu && /^ (\.[a-z]|COMMON)/ && NF == 1 { pending = $1; next }
    gnu && pending != "" { if (NF >= 3) add(pending, number($2), $3); pending = ""; next }
    gnu && /^ (\.[a-z]|COMMON)/ && NF >= 4 { add($1, number($3), $4) }
    END { for (m in seen) printf "| %s | %d | %d |\n", m, flash[m], ram[m] }' "$map" | sort
