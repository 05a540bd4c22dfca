#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# tools/imagecrc.py accepts a whole image and refuses it with any one byte flipped, cut or added.
# usage: checksum.sh IMAGECRC SCRATCH
set -eu
tool=$1
scratch=$2
command -v python3 >/dev/null || { echo "SKIPPED: no python3"; exit 77; }
rm -rf "$scratch"
mkdir -p "$scratch"

# An image of 512 bytes: 48 vectors, the header, noise. Its CRC is computed here bit by bit, not by the tool's library.
python3 - "$scratch" <<'END'
import struct, sys
def crc(data):
    value = 0xFFFFFFFF
    for byte in data:
        for bit in range(8):
            value = value >> 1 ^ (0xEDB88320 if (value ^ byte >> bit) & 1 else 0)
    return value ^ 0xFFFFFFFF
front = bytes(range(192)) + b"BQIM" + struct.pack("<I", 512)
back = struct.pack("<I16s", 0x000100, b"test") + bytes((i * 37 + 11) & 255 for i in range(512 - 192 - 32))
whole = front + struct.pack("<I", crc(front + back)) + back
assert len(whole) == 512 and crc(b"123456789") == 0xCBF43926
def put(name, data):
    with open(f"{sys.argv[1]}/{name}.bin", "wb") as file:
        file.write(data)
put("whole", whole)
for at in (0, 3, 191, 192, 196, 200, 203, 204, 210, 224, 300, 511):
    put(f"bad_flip_{at}", whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1:])
put("bad_short", whole[:-4])
put("bad_long", whole + bytes(4))
put("bad_empty", b"")
put("bad_no_header", bytes(512))
END

failed=0
python3 "$tool" check "$scratch/whole.bin" || { echo "FAILED: refuses a whole image"; failed=1; }
for bad in "$scratch"/bad_*.bin; do
    got=0
    python3 "$tool" check "$bad" 2>/dev/null || got=$?
    if [ "$got" = 1 ]; then echo "ok: refuses $(basename "$bad")"; else echo "FAILED: $(basename "$bad") gave $got"; failed=1; fi
done
exit $failed
