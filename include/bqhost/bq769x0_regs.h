/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file bq769x0_regs.h
 * Register map of the bq769x0 family (X0-REG-00 to X0-REG-59): addresses, bits, masks.
 */
#ifndef BQHOST_BQ769X0_REGS_H
#define BQHOST_BQ769X0_REGS_H

#define BQ769X0_SYS_STAT 0x00u
#define BQ769X0_CELLBAL1 0x01u /**< three registers, one per group of five inputs */
#define BQ769X0_SYS_CTRL1 0x04u
#define BQ769X0_SYS_CTRL2 0x05u
#define BQ769X0_PROTECT1 0x06u
#define BQ769X0_PROTECT2 0x07u
#define BQ769X0_PROTECT3 0x08u
#define BQ769X0_OV_TRIP 0x09u
#define BQ769X0_UV_TRIP 0x0au
#define BQ769X0_CC_CFG 0x0bu
#define BQ769X0_VC1_HI 0x0cu
#define BQ769X0_BAT_HI 0x2au
#define BQ769X0_TS1_HI 0x2cu
#define BQ769X0_CC_HI 0x32u
#define BQ769X0_ADCGAIN1 0x50u
#define BQ769X0_ADCOFFSET 0x51u
#define BQ769X0_ADCGAIN2 0x59u

#define BQ769X0_STAT_CC_READY 0x80u
#define BQ769X0_STAT_XREADY 0x20u
#define BQ769X0_STAT_OVRD_ALERT 0x10u
#define BQ769X0_STAT_UV 0x08u
#define BQ769X0_STAT_OV 0x04u
#define BQ769X0_STAT_SCD 0x02u
#define BQ769X0_STAT_OCD 0x01u
#define BQ769X0_STAT_FAULTS 0x3fu /**< everything but CC_READY */
#define BQ769X0_STAT_CLEAR 0xbfu  /**< bits that may ever be written as 1 (X0-BIT-09) */

#define BQ769X0_CTRL1_LOAD_PRESENT 0x80u
#define BQ769X0_CTRL1_ADC_EN 0x10u
#define BQ769X0_CTRL1_TEMP_SEL 0x08u
#define BQ769X0_CTRL1_MASK 0x1fu /**< bits that can be compared (X0-SEQ-17) */

#define BQ769X0_CTRL2_DELAY_DIS 0x80u
#define BQ769X0_CTRL2_CC_EN 0x40u
#define BQ769X0_CTRL2_CC_ONESHOT 0x20u
#define BQ769X0_CTRL2_DSG_ON 0x02u
#define BQ769X0_CTRL2_CHG_ON 0x01u
#define BQ769X0_CTRL2_FETS 0x03u

#define BQ769X0_CC_CFG_VALUE 0x19u /**< X0-CC-10 */
#define BQ769X0_UV_MINQUAL 0x0518u /**< below: the chip takes the input for a shorted one (X0-UV-07) */
#define BQ769X0_TS_OPEN 8639u      /**< code of an open thermistor input (X0-TS-07) */

#endif
