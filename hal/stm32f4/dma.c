/* SPDX-License-Identifier: Apache-2.0 */
#include "stm32_chip.h"

#define PATIENCE 2000u /* turns; an item of a slow peripheral bus takes some dozen cycles */

bool stm32_dma_stop(unsigned stream)
{
    stm32_dma_stream *s = &STM32_DMA2->stream[stream];
    uint32_t patience = PATIENCE;
    s->cr &= ~STM32_DMA_CR_EN;
    while ((s->cr & STM32_DMA_CR_EN) != 0u) {
        if (patience-- == 0u) {
            return false;
        }
    }
    return true;
}
