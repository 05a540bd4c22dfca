/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file status.h
 * The one status type of the library: zero is success, negative values are errors,
 * and BQ_PENDING (the only positive value) means "not finished, poll again".
 */
#ifndef BQHOST_STATUS_H
#define BQHOST_STATUS_H

#ifdef __cplusplus
extern "C" {
#endif

typedef enum bq_status {
    BQ_OK = 0,
    BQ_PENDING = 1, /**< under way; call the matching poll function again */

    /* programming errors: nothing was sent, nothing changed */
    BQ_E_ARG = -1,         /**< null pointer, index out of range, buffer too small */
    BQ_E_STATE = -2,       /**< not allowed in the present state of the instance */
    BQ_E_BUSY = -3,        /**< another operation of this instance is still running */
    BQ_E_UNSUPPORTED = -4, /**< the board or build does not offer this */

    /* configuration refused: at init, with nothing half-applied, or at bring-up where only the chip knows (a
     * limit its trim cannot hold, cells or a part other than configured); then its outputs are off */
    BQ_E_RANGE = -10,     /**< a value outside what the field may hold */
    BQ_E_NO_CODE = -11,   /**< a threshold or delay that no register code expresses: exactly (bq76PL536), or
                             without being   looser than asked (bq769x0) */
    BQ_E_COV_CUV = -12,   /**< COV - CUV below 300 mV (PL-COV-12) */
    BQ_E_DEVICES = -13,   /**< more devices than addresses, or none (PL-ADR-01) */
    BQ_E_CELLS = -14,     /**< a cell count that the part cannot have (PL-GEN-01) */
    BQ_E_UNLATCHED = -15, /**< delay 0 without explicit permission (PL-ELEC-06, PL-ELEC-07) */
    BQ_E_CLOCK = -16,     /**< bus clock outside the legal range for this stack (PL-TIM-01, PL-NUM-38) */
    BQ_E_CONFIG = -17,    /**< fields that contradict each other, or what was found */

    /* the bus */
    BQ_E_BUS = -20,         /**< the back-end reported a failed transfer */
    BQ_E_TIMEOUT = -21,     /**< the back-end or the chip did not finish within its bound */
    BQ_E_NO_ANSWER = -22,   /**< every byte 0x00 or every byte 0xff: nobody answered */
    BQ_E_CRC = -23,         /**< an answer arrived damaged */
    BQ_E_IMPLAUSIBLE = -24, /**< the CRC holds but the content cannot be true */
    BQ_E_NACK = -25,        /**< I2C: address or data byte not acknowledged */
    BQ_E_ARBITRATION = -26, /**< I2C: lost to another master, or the bus is stuck */

    /* the chip */
    BQ_E_VERIFY = -30,       /**< read-back differs from what was written */
    BQ_E_NOT_FOUND = -31,    /**< a device that is configured was not found; settings: there are none */
    BQ_E_EXTRA_DEVICE = -32, /**< something answers at address 0 after discovery */
    BQ_E_LOCKED_UP = -33,    /**< a conversion never ended (PL-ADC-12) */
    BQ_E_DEFECTIVE = -34,    /**< a chip fault that a reset does not cure */
    BQ_E_LINE_STUCK = -35,   /**< FAULT, ALERT or DRDY does not follow the devices */
    BQ_E_CHAIN_BROKEN = -36, /**< a forced FAULT or ALERT does not reach the host */
    BQ_E_PERSISTS = -37,     /**< a flag returned after clearing: its cause is still there */
    BQ_E_NOT_BLANK = -38,    /**< EPROM already holds something */
    BQ_E_VOLTAGE = -39,      /**< supply or programming voltage outside its window */
    BQ_E_STALE = -40,        /**< values too old, or none yet */
    BQ_E_CRC_OFF = -41       /**< the device runs with CRC switched off in its EPROM */
} bq_status;

/** Name of a status for logs, for example "BQ_E_CRC"; never NULL; "BQ_E_?" for unknown values. */
const char *bq_status_name(bq_status status);

/** The same without what it begins with, "BQ_" with BQ_OK and BQ_PENDING, "BQ_E_" with all others: for
 * programs to which 150 bytes matter. */
const char *bq_status_word(bq_status status);

#ifdef __cplusplus
}
#endif
#endif
