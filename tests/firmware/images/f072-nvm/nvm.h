/* SPDX-License-Identifier: Apache-2.0 */
/* What the test image needs to know of its chip. */
#ifndef NVM_H
#define NVM_H

#define NVM_BYTES 8u
#define NVM_CAN_AF 4
#define NVM_SECTORS {{0x0801F000u, 0x0801F800u}, 2048u} /* pages 62 and 63 */
#define NVM_CAN_HANDLERS                                                                                     \
    void can_handler(void)                                                                                   \
    {                                                                                                        \
        stm32_can_irq(&can);                                                                                 \
    }

#endif
