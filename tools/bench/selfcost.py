#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Instructions executed in the library's own sources, from two callgrind outputs of the same program.

    selfcost.py ROOT FEWER MORE DIFFERENCE

FEWER and MORE differ by DIFFERENCE repetitions, so that set-up cancels out. Prints room, instructions per repetition; a room is
the folder of the source file that an instruction belongs to, inlined functions included. Only src/, drivers/ and include/ count;
C library, simulator and back-end don't.
"""
import pathlib
import re
import sys

ROOMS = ("src/core", "src/pack", "src/app", "drivers", "include")


def costs(path, root):
    """Self cost of each room."""
    names, rooms, room, skip = {}, {}, None, False
    for line in pathlib.Path(path).read_text().split("\n"):
        place = re.match(r"(fl|fi|fe)=\((\d+)\)(?: (.*))?$", line)
        if place:
            if place[3]:
                names[place[2]] = place[3]
            name = names[place[2]]
            inside = name.removeprefix(root + "/") if name.startswith(root + "/") else ""
            room = next((r for r in ROOMS if inside.startswith(r + "/")), None)
        elif re.match(r"cf[il]=\(\d+\) ", line):  # the file of a called function, named here for the first time
            number, name = re.match(r"cf[il]=\((\d+)\) (.*)$", line).groups()
            names[number] = name
        elif line.startswith("calls="):
            skip = True  # the next line is the inclusive cost of the call
        elif re.match(r"[+*\-0-9]", line):
            if not skip and room:
                rooms[room] = rooms.get(room, 0) + int(line.split()[1])
            skip = False
    return rooms


def main():
    root, fewer, more, difference = sys.argv[1:]
    few, many = costs(fewer, root), costs(more, root)
    for room in ROOMS:
        print(room, (many.get(room, 0) - few.get(room, 0)) / int(difference))


if __name__ == "__main__":
    main()
