#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# House rules that a command can check, over the sources of one tree.
# usage: gates.sh ROOT [GATE...]   prints FILE:LINE: reason for every breach; exit 1 if there is one
set -eu
LC_ALL=C
export LC_ALL
here=$(cd "$(dirname "$0")" && pwd)
cd "$1"
shift
[ $# -gt 0 ] || set -- words arrows length spdx unfinished unity links

rooms() { # rooms GLOB ROOM...: the files of some rooms, those that do not exist left out
    glob=$1
    shift
    for room; do
        [ ! -d "$room" ] || find "$room" -type f -name "$glob"
    done | sort
}

# code FILE: the text without comments and string contents, line numbers kept; #include lines stay whole.
code() {
    awk '
        { line = $0; out = ""
          if (!comment && line ~ /^[ \t]*#[ \t]*include/) { print; next }
          while (line != "") {
              if (comment) {
                  if ((p = index(line, "*/")) == 0) break
                  line = substr(line, p + 2); comment = 0; out = out " "
              } else if (substr(line, 1, 2) == "/*") { comment = 1; line = substr(line, 3) }
              else if (substr(line, 1, 2) == "//") break
              else if (match(line, /^"([^"\\]|\\.)*"/)) { out = out "\"\""; line = substr(line, RLENGTH + 1) }
              else if (match(line, /^\047([^\047\\]|\\.)*\047/)) { out = out "0"; line = substr(line, RLENGTH + 1) }
              else { out = out substr(line, 1, 1); line = substr(line, 2) }
          }
          print out }' "$1"
}

# No float, no heap in what is shipped.
gate_words() {
    { rooms '*.[ch]' include src drivers; rooms '*.[ch]' hal | grep -v '^hal/sim/' || :; } | while read -r f; do
        code "$f" | awk -v file="$f" '
            { n = split($0, word, /[^A-Za-z0-9_]+/)
              for (i = 1; i <= n; i++)
                  if (word[i] ~ /^(float|double|malloc|calloc|realloc|free)$/) print file ":" NR ": " word[i]
              gsub(/[A-Za-z_0-9]*[A-Za-z_][0-9A-Za-z_]*/, " & "); gsub(/0[xX][0-9a-fA-F]+/, "0")
              if ($0 ~ /[0-9]\.|\.[0-9]|(^|[^0-9A-Za-z_])[0-9]+[eE][0-9]/) print file ":" NR ": floating constant" }'
    done
}

# The include arrows of docs/design.md. A quoted name without a folder means a private header beside the file.
gate_arrows() {
    rooms '*.[ch]' include src drivers hal sim tools/emulator | while read -r f; do
        code "$f" | awk -v file="$f" '
            function wrong(reason) { print file ":" NR ": includes " name ": " reason }
            function beside(    found) {
                if (name ~ /\//) return 0
                found = (getline line < (dir "/" name)) >= 0
                close(dir "/" name)
                return found
            }
            function there(folder,    found) {
                found = (getline line < (folder "/" name)) >= 0
                close(folder "/" name)
                return found
            }
            # The simulator below hal/sim; hal/stm32 below its families, and these below the boards. hal/stm32 itself sees two
            # headers that each family has, hal/boards itself two that each board has.
            function below() {
                if (file ~ /^hal\/sim\//) return name ~ /^sim_[a-z0-9_]+\.h$/
                if (file ~ /^hal\/stm32\//) return name ~ /^stm32_(chip|usart)\.h$/
                if (file ~ /^hal\/stm32f[0-9]\//) return there("hal/stm32")
                if (file ~ /^hal\/boards\/[a-z_]*\.c$/ && name ~ /^(board|pins)\.h$/) return 1
                if (file ~ /^hal\/boards\//) return there("hal/boards") || there("hal/stm32") || there("hal/stm32f0") || there("hal/stm32f4")
                return 0
            }
            BEGIN { dir = file; sub(/\/[^\/]*$/, "", dir)
                    small = "^(assert|limits|stdbool|stddef|stdint|string)\\.h$" }
            /^[ \t]*#[ \t]*include/ {
                name = $0; quoted = name ~ /include[ \t]*"/
                gsub(/^[^"<]*["<]|[">].*$/, "", name)
                public = name; sub(/^bqhost\//, "", public)
                ours = public != name
                if (name ~ /\.\./) { wrong("climbs out of its room"); next }
                if (file ~ /^sim\//) {
                    if (quoted ? !beside() : name !~ /^[a-z0-9_]+\.h$/) wrong("the simulator knows nothing of the other rooms")
                    next
                }
                if (file ~ /^tools\/emulator\//) {
                    if (ours || (quoted ? !beside() && name != "sim_misuse.h" : name !~ /^(unicorn\/)?[a-z0-9_]+\.h$/))
                        wrong("the emulator knows the reference manuals and nothing of what it runs")
                    next
                }
                if (file ~ /^hal\//) {
                    if (ours && file !~ /^hal\/boards\// && public !~ /^(hal|status)\.h$/) wrong("a back-end sees hal.h alone")
                    if (!ours && quoted && !beside() && !below())
                        wrong("not a header of this back-end")
                    next
                }
                if (!ours) {
                    if (!quoted) { if (name !~ small) wrong("not among the headers of a small C library") }
                    else if (file ~ /^include\// || !beside()) wrong("only bqhost/ and private headers beside the file")
                    next
                }
                if (file ~ /^src\/core\// && public ~ /^(afe|app|hal|pack.*|sample|bq76pl536|bq76pl536_state)\.h$/)
                    wrong("the core stands below drivers and pack")
                if (file ~ /^drivers\// && public ~ /^(app|pack.*)\.h$/) wrong("a driver stands below the pack")
                if (file ~ /^src\/pack\// && public ~ /^(afe|app|hal|bq76pl536.*|bq769x0.*)\.h$/)
                    wrong("the pack knows no chip and no board")
                if (file ~ /^src\/app\// && public ~ /^(bq76pl536.*|bq769x0.*)\.h$/) wrong("the loop knows no chip")
            }'
    done
}

# A file beyond 500 lines does more than one thing.
gate_length() {
    rooms '*' include src drivers hal sim tools tests | while read -r f; do
        case $f in *.csv | *.md) continue ;; esac
        awk -v file="$f" 'END { if (NR > 500) print file ":" NR ": longer than 500 lines" }' "$f"
    done
}

# Every source file names its licence near the top.
gate_spdx() {
    { rooms '*' include src drivers hal sim tools tests cmake .ci; [ ! -f CMakeLists.txt ] || echo CMakeLists.txt; } |
        while read -r f; do
            case $f in
            *.c | *.h | *.sh | *.py | *.ld | *.cmake | *.awk | *.in | *CMakeLists.txt | tools/trace | .ci/run) ;;
            *) continue ;;
            esac
            head -n 3 "$f" | grep -q 'SPDX-License-Identifier: Apache-2.0' || echo "$f:1: no SPDX line"
        done
}

# Nothing is left for later.
gate_unfinished() {
    rooms '*' include src drivers hal sim tools tests | while read -r f; do
        case $f in tests/packaging/gates*.sh) continue ;; esac
        awk -v file="$f" '/(^|[^A-Za-z0-9_])(TODO|FIXME|XXX|HACK|SKELETON)([^A-Za-z0-9_]|$)/ {
            print file ":" NR ": unfinished" }' "$f"
    done
}

# Tests use only macros that the real Unity has too, so they compile against either.
gate_unity() {
    rooms '*.[ch]' tests | while read -r f; do
        code "$f" | awk -v file="$f" -v names="$here/unity_names.txt" '
            BEGIN { while ((getline name < names) > 0) if (name !~ /^#/) known[name] = 1 }
            { n = split($0, word, /[^A-Za-z0-9_]+/)
              for (i = 1; i <= n; i++)
                  if (word[i] ~ /^TEST_(ASSERT|FAIL|IGNORE|MESSAGE|PASS)/ && !(word[i] in known))
                      print file ":" NR ": " word[i] " is no macro of Unity" }'
    done
}

# What a document points to exists.
gate_links() {
    for f in *.md docs/*.md; do
        [ -f "$f" ] || continue
        awk '{ rest = $0
               while (match(rest, /\]\([^)]*\)/)) {
                   print NR, substr(rest, RSTART + 2, RLENGTH - 3); rest = substr(rest, RSTART + RLENGTH) } }' "$f" |
            while read -r line target; do
                case $target in http*) continue ;; esac
                target=${target%%#*}
                [ -e "$(dirname "$f")/$target" ] || echo "$f:$line: no $target"
            done
    done
}

status=0
for gate; do
    out=$("gate_$gate") || { echo "gate $gate did not run"; exit 2; }
    if [ -n "$out" ]; then
        printf '%s\n' "$out"
        echo "gate $gate: broken"
        status=1
    else
        echo "gate $gate: held"
    fi
done
exit $status
