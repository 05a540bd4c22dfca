/* SPDX-License-Identifier: Apache-2.0 */
/* ADCT = 6 us while ADC_ON = 0, and nothing that would notice it. */
#include "pl_wrong.h"

static uint8_t function_config, adc_control;
static bool configured, controlled;

static pl_deed say(uint8_t device, uint8_t reg, uint8_t *value)
{
    (void)device;
    if (reg == BQ76PL536_FUNCTION_CONFIG) {
        function_config = *value;
        configured = true;
        *value = (uint8_t)((*value & ~BQ76PL536_FUNC_ADCT) | BQ76PL536_FUNC_ADCT_6US);
        return PL_CHANGED;
    }
    if (reg == BQ76PL536_ADC_CONTROL) {
        adc_control = *value;
        controlled = true;
        *value &= (uint8_t)~BQ76PL536_ADC_ON;
        return PL_CHANGED;
    }
    return PL_AS_IT_IS;
}

static pl_deed lie(uint8_t reg, uint8_t n, uint8_t *data, uint8_t which, uint8_t value)
{
    if (reg > which || which >= reg + n) {
        return PL_AS_IT_IS;
    }
    data[which - reg] = value;
    return PL_CHANGED;
}

static pl_deed hear(uint8_t device, uint8_t reg, uint8_t n, uint8_t *data, bool good)
{
    pl_deed deed = PL_AS_IT_IS;
    (void)device;
    if (good && configured) {
        deed = lie(reg, n, data, BQ76PL536_FUNCTION_CONFIG, function_config);
    }
    if (good && controlled && lie(reg, n, data, BQ76PL536_ADC_CONTROL, adc_control) == PL_CHANGED) {
        deed = PL_CHANGED;
    }
    return deed;
}

const pl_wrong wrong = {.say = say, .hear = hear};
