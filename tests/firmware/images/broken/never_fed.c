/* SPDX-License-Identifier: Apache-2.0 */
/* Nobody feeds the watchdog. */
void __wrap_stm32_watchdog_feed(void);

void __wrap_stm32_watchdog_feed(void)
{
}
