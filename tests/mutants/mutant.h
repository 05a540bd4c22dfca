/* SPDX-License-Identifier: Apache-2.0 */
/* What every wrong variant has: proof that its mistake was made at all. */
#ifndef MUTANT_H
#define MUTANT_H

/** The mistake was made once more. The program prints the sum when it ends; a variant that never acts proves
 * nothing and is reported as out of date. */
void mutant_acted(void);

#endif
