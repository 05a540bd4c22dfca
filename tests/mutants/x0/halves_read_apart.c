/* SPDX-License-Identifier: Apache-2.0 */
/* High and low byte read in two transactions. */
#include "x0_wrong.h"

const x0_wrong wrong = {.one_by_one = true};
