#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints the C file of an NTC table for include/bqhost/thermistor.h, or with --codes for include/bqhost/bq769x0_known.h,
from R25 and beta.

The curve is R(T) = R25 * exp(beta * (1/T - 1/298.15 K)). Before anything is printed, resistances of the whole range
(or all codes) are converted the way bq_thermistor_dc() or bq769x0_sensor_codes() does it and compared with the curve; an error of 0.1 degree C or more,
rounding included, is refused (choose a smaller step).

    tools/thermistor.py --r25 10000 --beta 3435 --name bq_thermistor_103at > src/core/thermistor_103at.c
    tools/thermistor.py --codes --step 2.5 --r25 10000 --beta 3435 --name bq769x0_codes_103at > src/core/bq769x0_codes_103at.c
"""
import argparse
import math
import sys

KELVIN = 273.15
LIMIT_C = 0.1


def resistance(celsius, r25, beta):
    return r25 * math.exp(beta * (1.0 / (celsius + KELVIN) - 1.0 / (25.0 + KELVIN)))


def temperature(ohms, r25, beta):
    return 1.0 / (1.0 / (25.0 + KELVIN) + math.log(ohms / r25) / beta) - KELVIN


def code_of(ohms):
    """Of the bq769x0: 382 uV a code, the sensor against 10 kOhm at 3.3 V."""
    return round(3.3 / 382e-6 * ohms / (ohms + 10000.0))


def ohms_of(value, codes):
    return 10000.0 * value * 382e-6 / (3.3 - value * 382e-6) if codes else value


def worst_error(table, first_dc, step_dc, r25, beta, codes):
    """Largest distance, degrees C, between the integer interpolation and the curve, and where it is."""
    worst = (0.0, 0)
    for index in range(len(table) - 1):
        high, low = table[index], table[index + 1]
        span = high - low
        # 2000 points of an interval show its worst; the unit test looks at every ohm.
        for value in range(low, high + 1, max(1, span // 2000)):
            tenths = first_dc + index * step_dc + (2 * step_dc * (high - value) + span) // (2 * span)
            error = abs(tenths / 10.0 - temperature(ohms_of(value, codes), r25, beta))
            worst = max(worst, (error, value))
    return worst


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--r25", type=float, required=True, help="resistance at 25 degrees C, ohms")
    parser.add_argument("--beta", type=float, required=True, help="beta constant, kelvin")
    parser.add_argument("--name", required=True, help="name of the table")
    parser.add_argument("--from", dest="first", type=float, default=-40.0, help="first temperature, C (-40)")
    parser.add_argument("--to", dest="last", type=float, default=125.0, help="last temperature, C (125)")
    parser.add_argument("--step", type=float, default=1.5, help="distance of two points, C (1.5)")
    parser.add_argument("--codes", action="store_true", help="codes of the bq769x0 instead of ohms")
    options = parser.parse_args()

    first_dc, last_dc, step_dc = (round(10 * value) for value in (options.first, options.last, options.step))
    if options.r25 <= 0 or options.beta <= 0:
        sys.exit("thermistor: --r25 and --beta must be positive")
    if step_dc <= 0 or last_dc <= first_dc or (last_dc - first_dc) % step_dc:
        sys.exit("thermistor: the range must be a whole number of steps")
    if first_dc < -2700 or last_dc > 32767:
        sys.exit("thermistor: the range leaves what tenths of a degree in 16 bits can hold")
    table = [round(resistance(t / 10.0, options.r25, options.beta)) for t in range(first_dc, last_dc + 1, step_dc)]
    if options.codes:
        table = [code_of(ohms) for ohms in table]
    if table[0] >= 2**32 or any(a <= b for a, b in zip(table, table[1:])):
        sys.exit("thermistor: whole ohms or codes cannot describe this curve")
    error, where = worst_error(table, first_dc, step_dc, options.r25, options.beta, options.codes)
    if error >= LIMIT_C:
        sys.exit(f"thermistor: {error:.3f} C wrong at {where}; choose a smaller --step")

    print("/* SPDX-License-Identifier: Apache-2.0 */")
    unit, kind, what, header = ("codes", "uint16_t", "bq769x0_code_table", "bq769x0_known") if options.codes else \
        ("ohms", "uint32_t", "bq_thermistor", "thermistor")
    print(f"/* Made by tools/thermistor.py{' --codes' if options.codes else ''} --name {options.name} --r25 {options.r25:g} --beta {options.beta:g}")
    print(f" *     --from {options.first:g} --to {options.last:g} --step {options.step:g}")
    print(f" * R(T) = R25 * exp(beta * (1/T - 1/298.15 K)); worst error {error:.3f} C, rounding to 0.1 C included. */")
    print(f'#include "bqhost/{header}.h"\n')
    print(f"static const {kind} {unit}[{len(table)}] = {{")
    for row in range(0, len(table), 10):
        print("    " + " ".join(f"{value}," for value in table[row:row + 10]))
    print("};\n")
    print(f"const {what} {options.name} = {{{unit}, {len(table)}, {first_dc}, {step_dc}}};")


if __name__ == "__main__":
    main()
