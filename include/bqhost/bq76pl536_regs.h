/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file bq76pl536_regs.h
 * Registers of the bq76PL536: addresses, bits, reset values (PL-REG-07..49), masks (PL-REG-50) and what a
 * host may write.
 * Reserved addresses (0x13..0x1f, 0x26..0x2f, 0x35..0x39, 0x3e, 0x4c..0xff) read 0 and are never written.
 */
#ifndef BQHOST_BQ76PL536_REGS_H
#define BQHOST_BQ76PL536_REGS_H

#include "bqhost/status.h"
#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Device addresses (PL-ADR-01). */
#define BQ76PL536_ADDR_NONE 0x00u      /**< a device that has no address answers here */
#define BQ76PL536_ADDR_FIRST 0x01u
#define BQ76PL536_ADDR_LAST 0x3eu
#define BQ76PL536_ADDR_BROADCAST 0x3fu /**< writes only */

/* Group 1, read only. Results are big-endian pairs, high byte first; bits 15..14 of the word are 0. */
#define BQ76PL536_DEVICE_STATUS 0x00u
#define BQ76PL536_GPAI 0x01u         /**< 0x01, 0x02: GPAI pins or brick voltage */
#define BQ76PL536_VCELL1 0x03u       /**< 0x03..0x0e: cells 1..6 */
#define BQ76PL536_TEMPERATURE1 0x0fu /**< 0x0f, 0x10 */
#define BQ76PL536_TEMPERATURE2 0x11u /**< 0x11, 0x12 */
#define BQ76PL536_COV_FAULT 0x22u    /**< bit n-1 = cell n */
#define BQ76PL536_CUV_FAULT 0x23u    /**< bit n-1 = cell n */
#define BQ76PL536_PRESULT_A 0x24u    /**< parity result of 0x40 (bit 0) .. 0x47 (bit 7) */
#define BQ76PL536_PRESULT_B 0x25u    /**< parity result of 0x48 (bit 0) .. 0x4b (bit 3) */

/* Group 2, read and write. */
#define BQ76PL536_ALERT_STATUS 0x20u
#define BQ76PL536_FAULT_STATUS 0x21u
#define BQ76PL536_ADC_CONTROL 0x30u
#define BQ76PL536_IO_CONTROL 0x31u
#define BQ76PL536_CB_CTRL 0x32u
#define BQ76PL536_CB_TIME 0x33u
#define BQ76PL536_ADC_CONVERT 0x34u /**< reads 0 */
#define BQ76PL536_SHDW_CTRL 0x3au   /**< reads 0 */
#define BQ76PL536_ADDRESS_CONTROL 0x3bu
#define BQ76PL536_RESET 0x3cu       /**< reads 0 */
#define BQ76PL536_TEST_SELECT 0x3du /**< only 0x00 may ever be written (PL-TEST-03) */
#define BQ76PL536_E_EN 0x3fu        /**< reads 0; programming is irreversible */

/* Group 3: shadow of the EPROM, each write needs the key directly before it (PL-G3-02). */
#define BQ76PL536_FUNCTION_CONFIG 0x40u
#define BQ76PL536_IO_CONFIG 0x41u
#define BQ76PL536_CONFIG_COV 0x42u
#define BQ76PL536_CONFIG_COVT 0x43u
#define BQ76PL536_CONFIG_CUV 0x44u
#define BQ76PL536_CONFIG_CUVT 0x45u
#define BQ76PL536_CONFIG_OT 0x46u
#define BQ76PL536_CONFIG_OTT 0x47u
#define BQ76PL536_USER1 0x48u /**< 0x48..0x4b: USER1..USER4 */
#define BQ76PL536_USER4 0x4bu

#define BQ76PL536_GROUP3_FIRST 0x40u
#define BQ76PL536_GROUP3_COUNT 12u
#define BQ76PL536_REG_LAST 0x4bu

/* DEVICE_STATUS */
#define BQ76PL536_DS_AR 0x80u /**< 1 = has an address */
#define BQ76PL536_DS_FAULT 0x40u
#define BQ76PL536_DS_ALERT 0x20u
#define BQ76PL536_DS_ZERO 0x10u /**< not implemented, always 0 */
#define BQ76PL536_DS_ECC_COR 0x08u
#define BQ76PL536_DS_UVLO 0x04u
#define BQ76PL536_DS_CBT 0x02u /**< balancing timer runs */
#define BQ76PL536_DS_DRDY 0x01u /**< no conversion is running */

/* ALERT_STATUS */
#define BQ76PL536_ALERT_AR 0x80u /**< address was lost or never given; stays until cleared */
#define BQ76PL536_ALERT_PARITY 0x40u
#define BQ76PL536_ALERT_ECC_ERR 0x20u
#define BQ76PL536_ALERT_FORCE 0x10u /**< plain bit: takes the value written */
#define BQ76PL536_ALERT_TSD 0x08u
#define BQ76PL536_ALERT_SLEEP 0x04u
#define BQ76PL536_ALERT_OT2 0x02u
#define BQ76PL536_ALERT_OT1 0x01u

/* FAULT_STATUS */
#define BQ76PL536_FAULT_I_FAULT 0x20u
#define BQ76PL536_FAULT_FORCE 0x10u /**< plain bit: takes the value written */
#define BQ76PL536_FAULT_POR 0x08u
#define BQ76PL536_FAULT_CRC 0x04u
#define BQ76PL536_FAULT_CUV 0x02u
#define BQ76PL536_FAULT_COV 0x01u

/* ADC_CONTROL */
#define BQ76PL536_ADC_ON 0x40u
#define BQ76PL536_ADC_TS2 0x20u
#define BQ76PL536_ADC_TS1 0x10u
#define BQ76PL536_ADC_GPAI 0x08u
#define BQ76PL536_ADC_CELL_SEL 0x07u /**< cells - 1 */

/* IO_CONTROL */
#define BQ76PL536_IO_AUX 0x80u
#define BQ76PL536_IO_GPIO_OUT 0x40u /**< 0 = pin low, 1 = released */
#define BQ76PL536_IO_GPIO_IN 0x20u  /**< pin level, read only */
#define BQ76PL536_IO_SLEEP 0x04u
#define BQ76PL536_IO_TS2 0x02u
#define BQ76PL536_IO_TS1 0x01u

/* CB_CTRL and CB_TIME */
#define BQ76PL536_CB_MASK 0x3fu
#define BQ76PL536_CB_MINUTES 0x80u
#define BQ76PL536_CB_DURATION 0x3fu

/* Values with a meaning of their own. */
#define BQ76PL536_CONVERT_START 0x01u /**< ADC_CONVERT */
#define BQ76PL536_SHDW_KEY 0x35u      /**< SHDW_CTRL: opens one group 3 write */
#define BQ76PL536_SHDW_REFRESH 0x27u  /**< SHDW_CTRL: reloads group 3 from EPROM */
#define BQ76PL536_ADDRESS_AR 0x80u    /**< ADDRESS_CONTROL: address assigned */
#define BQ76PL536_ADDRESS_MASK 0x3fu
#define BQ76PL536_RESET_CODE 0xa5u    /**< RESET */
#define BQ76PL536_E_EN_PROGRAM 0x91u  /**< E_EN */

/* FUNCTION_CONFIG */
#define BQ76PL536_FUNC_ADCT 0xc0u      /**< time per channel: 3, 6, 12, 24 us */
#define BQ76PL536_FUNC_ADCT_SHIFT 6u
#define BQ76PL536_FUNC_ADCT_6US 0x40u
#define BQ76PL536_FUNC_GPAI_REF 0x20u  /**< 1 = REG50, 0 = band-gap */
#define BQ76PL536_FUNC_GPAI_SRC 0x10u  /**< 1 = brick voltage, 0 = GPAI pins */
#define BQ76PL536_FUNC_CN 0x0cu        /**< 6 - cells, which comparators are masked */
#define BQ76PL536_FUNC_CN_SHIFT 2u

/* IO_CONFIG, thresholds and delays */
#define BQ76PL536_IOC_CRC_DIS 0x01u
#define BQ76PL536_COV_DISABLE 0x80u
#define BQ76PL536_COV_CODE_MAX 0x3cu
#define BQ76PL536_CUV_DISABLE 0x80u
#define BQ76PL536_CUV_CODE_MAX 0x1au
#define BQ76PL536_DELAY_MS 0x80u /**< COVT, CUVT: unit 100 ms instead of 100 us */
#define BQ76PL536_DELAY_CODE 0x1fu
#define BQ76PL536_OT_CODE_MAX 11u

/* Values after power-on reset or RESET command that are not 0. Group 3 is loaded from EPROM (0x00 in a blank
 * part). */
#define BQ76PL536_RESET_DEVICE_STATUS 0x61u /**< FAULT, ALERT, DRDY */
#define BQ76PL536_RESET_ALERT_STATUS 0x80u  /**< AR */
#define BQ76PL536_RESET_FAULT_STATUS 0x08u  /**< POR; COV may join it at once in a blank part */

/** Bits of `reg` that keep a written 1 and so can be verified by read-back (PL-REG-50). 0 for registers that
 * act on the write and read 0, for read-only registers and for reserved addresses. */
uint8_t bq76pl536_readback_mask(uint8_t reg);

/**
 * May a host write `value` to `reg`? (PL-REG-01, PL-REG-02, PL-TEST-03, PL-AMB-45, PL-FLT-14)
 * BQ_OK; BQ_E_ARG: `reg` is reserved or read-only; BQ_E_RANGE: the value sets an undefined bit, is a
 * reserved or illegal code (COV above 0x3c, CUV above 0x1a, OT above 11), joins FORCE with the clearing of
 * flags, is an address outside 1..0x3e (bit 7 may be set or not), enters TEST mode, or is 0x91 for E_EN
 * (only bq76pl536_packet_program() builds that).
 */
bq_status bq76pl536_write_check(uint8_t reg, uint8_t value);

#ifdef __cplusplus
}
#endif
#endif
