/* SPDX-License-Identifier: Apache-2.0 */
/* Made by tools/thermistor.py --codes --name bq769x0_codes_103at --r25 10000 --beta 3435
 *     --from -40 --to 125 --step 2.5
 * R(T) = R25 * exp(beta * (1/T - 1/298.15 K)); worst error 0.095 C, rounding to 0.1 C included. */
#include "bqhost/bq769x0_known.h"

static const uint16_t codes[67] = {
    8304, 8250, 8189, 8121, 8045, 7960, 7867, 7764, 7652, 7530,
    7398, 7256, 7104, 6943, 6773, 6594, 6407, 6213, 6013, 5807,
    5598, 5386, 5172, 4957, 4742, 4530, 4319, 4113, 3910, 3713,
    3521, 3336, 3157, 2985, 2820, 2663, 2512, 2370, 2234, 2106,
    1984, 1869, 1760, 1658, 1562, 1471, 1387, 1307, 1231, 1161,
    1095, 1033, 975, 920, 869, 821, 776, 734, 694, 657,
    622, 589, 559, 530, 503, 477, 453,
};

const bq769x0_code_table bq769x0_codes_103at = {codes, 67, -400, 25};
