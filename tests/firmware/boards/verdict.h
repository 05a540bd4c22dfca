/* SPDX-License-Identifier: Apache-2.0 */
/** @file verdict.h
 * What every good image does and a broken one does not: the same run for all of them, each broken promise a
 * bit. */
#ifndef VERDICT_H
#define VERDICT_H

#define V_PERIOD 1u   /**< heartbeats come once a period, never later than 1.25 of it */
#define V_RESET 2u    /**< nobody resets the processor */
#define V_ON 4u       /**< the outputs are on at the end */
#define V_BOOK 8u     /**< the reference manual was kept */
#define V_MONITOR 16u /**< the monitors' datasheet was kept */
#define V_BITE 32u    /**< a loop that stands still does not keep the outputs on */

#define V_FROM_MS 1500u /**< outputs on; the defects strike at 1600 */
#define V_MS 1600u      /**< a watchdog of one second bites in it */
#define V_LAST_MS 450u  /**< the end of it, in which a hanging loop does nothing */

#endif
