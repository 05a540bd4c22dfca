#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Length and checksum of a firmware image (header: hal/stm32/stm32_image.h).

usage: imagecrc.py seal IMAGE.elf   writes length and CRC into the image's header
       imagecrc.py check FILE       an .elf or .bin; prints board, version, length, CRC
Exit status 0: done, or the image is whole; 1: damaged or no image; 2: wrong usage.

The image is what lies in flash, from the first vector to the last initial value of .data. Its CRC-32 (as in zlib)
leaves out the four bytes of the CRC itself.
"""
import struct
import sys
import zlib

MAGIC = b"BQIM"
HEADER = struct.Struct("<4sIII16s")  # magic, length, crc, version, board
SEARCH = 1024  # the header follows the vectors: 16 + 240 words at most


class Damaged(Exception):
    pass


def load_segments(elf):
    """(physical address, offset in the file, bytes in the file) of each loaded segment, ascending."""
    if elf[:6] != b"\x7fELF\x01\x01":
        raise Damaged("no 32-bit little-endian ELF file")
    (offset,) = struct.unpack_from("<I", elf, 28)
    size, count = struct.unpack_from("<HH", elf, 42)
    segments = []
    for n in range(count):
        kind, at, _, physical, length = struct.unpack_from("<IIIII", elf, offset + n * size)
        if kind == 1 and length > 0:
            segments.append((physical, at, length))
    if not segments:
        raise Damaged("nothing to load in it")
    return sorted(segments)


def flat(elf):
    """The image as it lies in flash, gaps filled as objcopy does."""
    segments = load_segments(elf)
    base = segments[0][0]
    image = bytearray(segments[-1][0] + segments[-1][2] - base)
    for physical, at, length in segments:
        image[physical - base : physical - base + length] = elf[at : at + length]
    return image


def header_at(image):
    at = image.find(MAGIC, 0, SEARCH)
    if at < 0 or at % 4 != 0 or at + HEADER.size > len(image):
        raise Damaged("no image header")
    return at


def checksum(image, at):
    """CRC of an image whose header begins at `at`."""
    return zlib.crc32(image[at + 12 :], zlib.crc32(image[: at + 8]))


def seal(path):
    with open(path, "rb") as file:
        elf = bytearray(file.read())
    image = flat(elf)
    at = header_at(image)
    if len(image) % 4 != 0:
        raise Damaged("length is no multiple of 4")
    struct.pack_into("<I", image, at + 4, len(image))
    crc = checksum(image, at)
    base = load_segments(elf)[0][0]
    for physical, offset, length in load_segments(elf):
        place = base + at - physical
        if 0 <= place and place + HEADER.size <= length:
            struct.pack_into("<II", elf, offset + place + 4, len(image), crc)
    with open(path, "wb") as file:
        file.write(elf)


def check(path):
    with open(path, "rb") as file:
        image = file.read()
    if image[:4] == b"\x7fELF":
        image = flat(image)
    at = header_at(image)
    _, length, crc, version, board = HEADER.unpack_from(image, at)
    if length != len(image):
        raise Damaged(f"length {len(image)}, header says {length}")
    if checksum(image, at) != crc:
        raise Damaged(f"CRC {checksum(image, at):08x}, header says {crc:08x}")
    name = board.rstrip(b"\0").decode("ascii", "replace")
    print(f"{path}: {name} {version >> 16}.{version >> 8 & 255}.{version & 255}, {length} bytes, CRC {crc:08x}")


def main(arguments):
    if len(arguments) != 2 or arguments[0] not in ("seal", "check"):
        print(__doc__, file=sys.stderr)
        return 2
    try:
        (seal if arguments[0] == "seal" else check)(arguments[1])
    except (Damaged, OSError, struct.error) as reason:
        print(f"{arguments[1]}: {reason}", file=sys.stderr)
        return 1
    return 0


sys.exit(main(sys.argv[1:]))
