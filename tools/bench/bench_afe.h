/* SPDX-License-Identifier: Apache-2.0 */
#ifndef BENCH_AFE_H
#define BENCH_AFE_H

/** Prints the table; 0, or 1 when a part does not come up or needs more on the bus than it must. */
int bench_afe_bus(void);

#endif
