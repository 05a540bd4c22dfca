/* SPDX-License-Identifier: Apache-2.0 */
/* What the test image needs to know of its chip. */
#ifndef NVM_H
#define NVM_H

#define NVM_BYTES 8u
#define NVM_CAN_AF 9
#define NVM_SECTORS {{0x08008000u, 0x0800C000u}, 16384u} /* sectors 2 and 3, the quick ones */
#define NVM_CAN_HANDLERS                                                                                     \
    void can1_tx_handler(void)                                                                               \
    {                                                                                                        \
        stm32_can_irq(&can);                                                                                 \
    }                                                                                                        \
    void can1_rx0_handler(void)                                                                              \
    {                                                                                                        \
        stm32_can_irq(&can);                                                                                 \
    }                                                                                                        \
    void can1_sce_handler(void)                                                                              \
    {                                                                                                        \
        stm32_can_irq(&can);                                                                                 \
    }

#endif
