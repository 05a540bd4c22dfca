/* SPDX-License-Identifier: Apache-2.0 */
#include "bqsim_value.h"
#include <math.h>
#include <stdio.h>

bool bqsim_choice(bqsim_text word, const char *no, const char *yes, double *value)
{
    if (!bqsim_is(word, no) && !bqsim_is(word, yes)) {
        return false;
    }
    *value = bqsim_is(word, yes) ? 1.0 : 0.0;
    return true;
}

bool bqsim_read_value(bqsim_notation as, bqsim_text word, double low, double high, double *value)
{
    uint64_t ns;
    uint8_t byte;

    switch (as) {
    case BQSIM_LEVEL:
        return bqsim_choice(word, "0", "1", value);
    case BQSIM_SWITCH:
        return bqsim_choice(word, "off", "on", value);
    case BQSIM_BYTE:
        if (!bqsim_hex8(word, &byte)) {
            return false;
        }
        *value = byte;
        return true;
    case BQSIM_TIME:
        if (!bqsim_time(word, &ns)) {
            return false;
        }
        *value = (double)ns;
        return true;
    case BQSIM_VBAT:
        if (bqsim_is(word, "sum")) {
            *value = -1.0;
            return true;
        }
        break;
    default:
        break;
    }
    return bqsim_number(word, value) && *value >= low && *value <= high &&
           (as != BQSIM_WHOLE || floor(*value) == *value);
}

void bqsim_print_value(bqsim_notation as, double value, char *out, size_t size)
{
    switch (as) {
    case BQSIM_LEVEL:
        (void)snprintf(out, size, "%d", value > 0.5);
        break;
    case BQSIM_SWITCH:
        (void)snprintf(out, size, "%s", value > 0.5 ? "on" : "off");
        break;
    case BQSIM_BYTE:
        (void)snprintf(out, size, "%02x", (unsigned)value & 0xffu);
        break;
    case BQSIM_WORD:
        (void)snprintf(out, size, "%04x", (unsigned)value & 0xffffu);
        break;
    case BQSIM_VBAT:
        if (value < 0.0) {
            (void)snprintf(out, size, "sum");
            break;
        }
        bqsim_print_number(out, size, value, 3);
        break;
    case BQSIM_VOLTS:
        bqsim_print_number(out, size, value, 3);
        break;
    default:
        bqsim_print_number(out, size, value, 0);
        break;
    }
}
