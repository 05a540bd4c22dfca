# SPDX-License-Identifier: Apache-2.0
# Prints the fenced block that follows the line "<!-- NAME -->", without its fences: awk -v name=NAME -f extract.awk FILE
$0 == "<!-- " name " -->" { armed = 1; next }
armed && /^```/ {
    if (inside) { found = 1; exit }
    inside = 1
    next
}
armed && inside { print }
armed && !inside && !/^[ \t]*$/ { exit }
END { exit found ? 0 : 1 }
