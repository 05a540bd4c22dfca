#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Worst-case stack of every entry point of the library, from the call graph that gcc writes (-fcallgraph-info).

    tools/stack.py [--cc CC] [--flags=FLAGS] [--targets FILE] [--board FILE] [--top N] [--limit BYTES] [SOURCE...]
    tools/stack.py --image FOLDER [--targets FILE] [--board FILE] [--top N] [--limit BYTES]

Without sources, all of src/ and drivers/bq*/ is compiled with -Os. With --image nothing is compiled: FOLDER is where an
image was built with the call graphs of everything in it, and every function that nobody calls is an entry.

Exit status 1, with a line PROBLEM for each, on
    recursion (direct, or through a table of functions),
    a frame whose size is not known when compiling (alloca, variable arrays),
    a call through a pointer that the target file does not declare,
    a call to a function outside the library that is not a memory function, and
    a stack deeper than the limit, where one is given.
Exit status 77 where the compiler cannot write a call graph (clang).

The target file has one line for each kind of call through a pointer:
    PATH-PREFIX MEMBER TARGET...
MEMBER is the name that is called; TARGET is a function of the library, or the word board for a call that leaves the
library. What the board's functions need on the stack comes on top, unless they are among the sources and a file for
--board says for each MEMBER which functions the word board stands for; targets that this board does not link are
passed over then.
"""
import argparse
import functools
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
INDIRECT = "__indirect_call"
# Leaf functions of the C library or of the compiler's own; their few bytes are not counted.
OUTSIDE = re.compile(r"(mem(cpy|move|set|cmp)|str(len|cmp)|__aeabi_\w+|__gnu_thumb1_case_\w+|__stack_chk_fail)$")


def short(title):
    return title.split(":")[-1]


def plain(title):
    """Name of a function without what the optimiser appended (.part.0, .constprop.0, .isra.0)."""
    return short(title).split(".")[0]


def readable(path):
    path = pathlib.Path(path)
    return str(path.relative_to(ROOT) if path.is_relative_to(ROOT) else path)


class Graph:
    def __init__(self, targets, board=None):
        self.frame, self.dynamic, self.edges, self.calls, self.problems = {}, set(), {}, {}, set()
        self.targets, self.board, self.depths, self.same = targets, board, {}, {}

    def read(self, ci):
        for line in ci.read_text().split("\n"):
            node = re.match(r'node: { title: "([^"]+)" label: ".*?(\d+) bytes \(([a-z,]+)\)', line)
            edge = re.match(r'edge: { sourcename: "([^"]+)" targetname: "([^"]+)"(?: label: "(.*):(\d+):(\d+)")?', line)
            if node:
                self.frame[node[1]] = int(node[2])
                if node[3] not in ("static", "dynamic,bounded"):
                    self.dynamic.add(node[1])
            elif edge and edge[2] == INDIRECT:
                text = self.lines(edge[3])[int(edge[4]) - 1]
                member = re.search(r"(\w+)\(", text[int(edge[5]) - 1:])
                self.calls.setdefault(edge[1], set()).add((readable(edge[3]), member[1] if member else "?", edge[4]))
            elif edge:
                self.edges.setdefault(edge[1], set()).add(edge[2])

    @functools.lru_cache(maxsize=None)
    def lines(self, path):
        return pathlib.Path(path).read_text().split("\n")

    def merge(self, elf):
        """Functions that the compiler found to be the same are names of one address; the graph holds one of them."""
        told = subprocess.run(["arm-none-eabi-nm", str(elf)], capture_output=True, text=True, check=True).stdout
        places = {name: at for at, name in re.findall(r"^(\w+) \S (\S+)$", told, re.M)}
        known = {places[short(title)]: title for title in self.frame if short(title) in places}
        self.same = {name: known[at] for name, at in places.items() if at in known}

    def declared(self, caller, path, member, line):
        """Titles that a call through a pointer may reach."""
        for rule in self.targets:
            if path.startswith(readable(rule[0])) and member == rule[1]:
                wanted = [name for name in rule[2:] if name != "board"]
                if self.board is not None and "board" in rule:
                    wanted += self.board.get(member, [])
                found = [title for title in self.frame if plain(title) in wanted]
                found += [self.same[name] for name in wanted if name in self.same]
                for name in set(wanted) - {plain(title) for title in found} if self.board is None else ():
                    self.problems.add(f"target {name} of {path} {member} does not exist")
                return found
        self.problems.add(f"undeclared call through a pointer: {path}:{line}: {member}, in {short(caller)}")
        return []

    def callees(self, title):
        found = {callee if callee in self.frame else self.same.get(short(callee), callee) for callee in self.edges.get(title, ())}
        for path, member, line in self.calls.get(title, ()):
            found.update(self.declared(title, path, member, line))
        return sorted(found)

    def depth(self, title, path=()):
        if title in path:
            ring = path[path.index(title):] + (title,)
            self.problems.add("recursion: " + " -> ".join(map(short, ring)))
            return 0, ()
        if title in self.depths:
            return self.depths[title]
        if title not in self.frame:
            if not OUTSIDE.match(title):
                self.problems.add(f"not part of the library: {short(title)}")
            return 0, ()
        if title in self.dynamic:
            self.problems.add(f"frame of unknown size: {short(title)}")
        deepest = max((self.depth(callee, path + (title,)) for callee in self.callees(title)), default=(0, ()))
        self.depths[title] = self.frame[title] + deepest[0], (short(title),) + deepest[1]
        return self.depths[title]

    def entries(self, image):
        """Functions with external linkage that belong to a public header by their name, deepest first; of an image those
        that nobody calls."""
        for title in list(self.frame):
            self.depth(title)
        public = [title for title in self.frame if ":" not in title and not title.startswith("pl_")]
        if image:
            called = {callee for title in self.frame for callee in self.callees(title)}
            public = [title for title in self.frame if title not in called]
        return sorted((self.depths[title] for title in public), key=lambda d: (-d[0], d[1]))


def compile_graph(options, graph):
    sources = options.sources or sorted(ROOT.glob("src/**/*.c")) + sorted(ROOT.glob("drivers/bq*/*.c"))
    with tempfile.TemporaryDirectory() as scratch:
        for number, source in enumerate(sources):
            target = pathlib.Path(scratch) / f"{number}.o"
            command = shlex.split(options.cc) + shlex.split(options.flags)
            command += ["-std=c99", "-DBQHOST_OTP=1", f"-I{ROOT}/include", "-fcallgraph-info=su,da"]
            command += ["-c", str(source), "-o", str(target)]
            done = subprocess.run(command, capture_output=True, text=True)
            if done.returncode != 0 and "callgraph-info" in done.stderr:
                print("SKIPPED: this compiler writes no call graph")
                sys.exit(77)
            if done.returncode != 0:
                sys.exit(done.stderr)
            graph.read(target.with_suffix(".ci"))


def words(file):
    lines = file.read_text().split("\n")
    return [tuple(line.split()) for line in lines if line.strip() and not line.startswith("#")]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cc", default="gcc")
    parser.add_argument("--flags", default="-Os")
    parser.add_argument("--image", type=pathlib.Path)
    parser.add_argument("--targets", type=pathlib.Path, default=ROOT / "tools/stack.targets")
    parser.add_argument("--board", type=pathlib.Path)
    parser.add_argument("--top", type=int, default=0, help="print the N deepest entries only")
    parser.add_argument("--limit", type=int, default=0, help="deepest stack allowed, bytes")
    parser.add_argument("sources", nargs="*", type=pathlib.Path)
    options = parser.parse_args()

    rules = words(options.targets)
    board = {rule[0]: list(rule[1:]) for rule in words(options.board)} if options.board else None
    graph = Graph(rules, board)
    if options.image:
        for ci in sorted(options.image.rglob("*.ci")):
            graph.read(ci)
        for elf in options.image.glob("*.elf"):
            graph.merge(elf)
    else:
        compile_graph(options, graph)
    entries = graph.entries(options.image is not None)
    for size, path in entries[:options.top or None]:
        print(f"{size:6} {' > '.join(path)}")
    if options.limit and entries and entries[0][0] > options.limit:
        graph.problems.add(f"deeper than {options.limit} bytes: {entries[0][1][0]}")
    for problem in sorted(graph.problems):
        print("PROBLEM", problem)
    return 1 if graph.problems or not entries else 0


if __name__ == "__main__":
    sys.exit(main())
