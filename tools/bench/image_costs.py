#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a firmware image cost while packsim ran it: rows of a Markdown table from `packsim --costs FILE`.

usage: image_costs.py rooms FILE ELF     instructions for each update of the pack, room by room
       image_costs.py loop FILE ELF      sleep, longest pass, interrupts, stack

The ELF must have line numbers (-g). An instruction belongs to the file whose function it was written in, inlined or not.
"""
import collections
import re
import subprocess
import sys

ROOMS = (("drivers", "drivers/"), ("src/core", "src/core/"), ("src/pack", "src/pack/"), ("src/app", "src/app/"),
         ("hal", "hal/"), ("inlined from include", "include/bqhost/"))
CORE_HZ = {"Cortex-M0": 48e6, "Cortex-M4": 168e6}


def read(path):
    values, counts = {}, {}
    for line in open(path):
        word = line.split()
        if word[0] == "at":
            counts[int(word[1], 16)] = int(word[2])
        else:
            values[word[0]] = int(word[1], 16 if word[0] == "lowest_sp" else 10)
    return values, counts


def symbols(elf):
    text = subprocess.run(["arm-none-eabi-nm", elf], capture_output=True, text=True, check=True).stdout
    return {m[2]: int(m[1], 16) for m in re.finditer(r"^([0-9a-f]+) \S (\S+)$", text, re.M)}


def rooms(counts, elf):
    addresses = sorted(counts)
    asked = "\n".join(f"{a:x}" for a in addresses)
    told = subprocess.run(["arm-none-eabi-addr2line", "-e", elf], input=asked, capture_output=True, text=True, check=True)
    cost = collections.Counter()
    for address, place in zip(addresses, told.stdout.split("\n")):
        room = next((name for name, part in ROOMS if "/" + part in place), "compiler's library")
        cost[room] += counts[address]
    return cost


def core(elf):
    head = subprocess.run(["arm-none-eabi-readelf", "-A", elf], capture_output=True, text=True, check=True).stdout
    return "Cortex-M4" if "v7E-M" in head else "Cortex-M0"


def main():
    what, file, elf = sys.argv[1:]
    values, counts = read(file)
    if what == "rooms":
        cost = rooms(counts, elf)
        for name in [r[0] for r in ROOMS] + ["compiler's library"]:
            print(f"| {name} | {cost[name] / values['scans']:.0f} |")
        print(f"| **all** | **{sum(cost.values()) / values['scans']:.0f}** |")
        return
    hz, place = CORE_HZ[core(elf)], symbols(elf)
    awake, asleep = values["cycles_awake"], values["cycles_asleep"]
    print(f"| asleep | {100 * asleep / (awake + asleep):.1f} % of the time |")
    print(f"| longest pass of the main loop | {values['longest_pass']} cycles, {values['longest_pass'] / hz * 1e6:.0f} us |")
    print(f"| longest latency of an interrupt | {values['longest_latency']} cycles, {values['longest_latency'] / hz * 1e6:.1f} us |")
    print(f"| longest interrupt handler | {values['longest_isr']} cycles, {values['longest_isr'] / hz * 1e6:.1f} us |")
    print(f"| deepest stack seen | {place['stm32_stack_end'] - values['lowest_sp']} bytes |")


if __name__ == "__main__":
    main()
