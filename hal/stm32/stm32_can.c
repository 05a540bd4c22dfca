/* SPDX-License-Identifier: Apache-2.0 */
#include "stm32_can.h"
#include "stm32_chip.h"
#include "stm32_core.h"

#define PATIENCE (STM32_CORE_HZ / 10000u) /* turns of a waiting loop; below 1 ms at ten cycles each */

/* ---- set-up
 * -------------------------------------------------------------------------------------------------- */

bq_status stm32_can_init(stm32_can *can, stm32_time *time)
{
    stm32_can_regs *c = STM32_CAN1;
    uint32_t patience = PATIENCE;
    can->time = time;
    stm32_apb1_enable(STM32_APB1_CAN1);
    c->mcr = STM32_CAN_MCR_INRQ; /* and out of sleep */
    while ((c->msr & (STM32_CAN_MSR_INAK | STM32_CAN_MSR_SLAK)) != STM32_CAN_MSR_INAK) {
        if (patience-- == 0u) {
            return BQ_E_TIMEOUT;
        }
    }
    c->mcr = STM32_CAN_MCR_INRQ | STM32_CAN_MCR_TXFP | STM32_CAN_MCR_ABOM;
    c->btr = STM32_CAN_BTR_500K;
    c->ier = STM32_CAN_IER_TMEIE | STM32_CAN_IER_BOFIE | STM32_CAN_IER_ERRIE;
    c->mcr = STM32_CAN_MCR_TXFP | STM32_CAN_MCR_ABOM; /* joins after 11 recessive bits; nobody waits for it */
    stm32_can_irqs_enable(2);
    return BQ_OK;
}

/* ---- interrupt
 * ----------------------------------------------------------------------------------------------- */

static void take_errors(stm32_can *can, stm32_can_regs *c)
{
    if ((c->msr & STM32_CAN_MSR_ERRI) == 0u) {
        return;
    }
    c->msr = STM32_CAN_MSR_ERRI;
    if ((c->esr & STM32_CAN_ESR_BOFF) != 0u) {
        c->tsr = STM32_CAN_TSR_ABRQ(0) | STM32_CAN_TSR_ABRQ(1) | STM32_CAN_TSR_ABRQ(2);
        stm32_time_event(can->time);
    }
}

void stm32_can_irq(stm32_can *can)
{
    stm32_can_regs *c = STM32_CAN1;
    uint32_t sent = c->tsr & (STM32_CAN_TSR_RQCP(0) | STM32_CAN_TSR_RQCP(1) | STM32_CAN_TSR_RQCP(2));
    if (sent != 0u) {
        c->tsr = sent;
        stm32_time_event(can->time);
    }
    take_errors(can, c);
}

/* ---- bus
 * ----------------------------------------------------------------------------------------------------- */

static bool off(const stm32_can_regs *c)
{
    return (c->esr & STM32_CAN_ESR_BOFF) != 0u || (c->msr & STM32_CAN_MSR_INAK) != 0u;
}

static uint32_t word(const uint8_t *b)
{
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static bq_status can_send(void *ctx, const bq_can_frame *f)
{
    stm32_can_regs *c = STM32_CAN1;
    stm32_can_mailbox *m;
    uint32_t tsr;
    (void)ctx;
    if (f == NULL || f->len > 8u || f->id > (f->extended ? 0x1fffffffu : 0x7ffu)) {
        return BQ_E_ARG;
    }
    if (off(c)) {
        return BQ_E_BUS;
    }
    tsr = c->tsr;
    if ((tsr & (STM32_CAN_TSR_TME(0) | STM32_CAN_TSR_TME(1) | STM32_CAN_TSR_TME(2))) == 0u) {
        return BQ_E_BUSY;
    }
    m = &c->tx[tsr >> STM32_CAN_TSR_CODE_SHIFT & 3u];
    m->dtr = f->len;
    m->dlr = word(f->data);
    m->dhr = word(f->data + 4);
    m->ir = (f->extended ? f->id << STM32_CAN_IR_EXID_SHIFT | STM32_CAN_IR_IDE
                         : f->id << STM32_CAN_IR_STID_SHIFT) |
            STM32_CAN_IR_TXRQ;
    return BQ_OK;
}

static bq_status no_frame(void *ctx, bq_can_frame *f)
{
    (void)ctx;
    return f == NULL ? BQ_E_ARG : BQ_PENDING;
}

static bq_can_state can_state(void *ctx)
{
    stm32_can_regs *c = STM32_CAN1;
    (void)ctx;
    if (off(c)) {
        return BQ_CAN_OFF;
    }
    return (c->esr & STM32_CAN_ESR_EPVF) != 0u ? BQ_CAN_PASSIVE : BQ_CAN_ACTIVE;
}

bq_can stm32_can_bus(void)
{
    static const bq_can_ops ops = {can_send, no_frame, can_state};
    bq_can bus = {&ops, NULL};
    return bus;
}

/* ---- reception
 * ----------------------------------------------------------------------------------------------- */

/* One filter, a mask over 32 bits: the sixteen standard ids, data frames only. */
static void set_filter(stm32_can_regs *c)
{
    c->fmr |= STM32_CAN_FMR_FINIT;
    c->fa1r = 0;
    c->fm1r = 0; /* masks */
    c->fs1r = 1u;
    c->ffa1r = 0; /* FIFO 0 */
    c->filter[0].fr1 = STM32_CAN_FIRST_ID << STM32_CAN_IR_STID_SHIFT;
    c->filter[0].fr2 = 0x7f0u << STM32_CAN_IR_STID_SHIFT | STM32_CAN_IR_IDE | STM32_CAN_IR_RTR;
    c->fa1r = 1u;
    c->fmr &= ~STM32_CAN_FMR_FINIT;
}

static void unpack(const stm32_can_mailbox *m, bq_can_frame *f)
{
    uint32_t low = m->dlr, high = m->dhr, len = m->dtr & 15u;
    f->id = m->ir >> STM32_CAN_IR_STID_SHIFT; /* the filter lets standard ids through only */
    f->extended = false;
    f->len = (uint8_t)(len > 8u ? 8u : len);
    for (unsigned i = 0; i < 4u; i++) {
        f->data[i] = (uint8_t)(low >> 8u * i);
        f->data[i + 4u] = (uint8_t)(high >> 8u * i);
    }
}

/* The release of a frame is over when RFOM reads 0 again, some cycles later. */
static void release(stm32_can_regs *c)
{
    c->rf0r = STM32_CAN_RF0R_RFOM;
    for (unsigned n = 0; n < 100u && (c->rf0r & STM32_CAN_RF0R_RFOM) != 0u; n++) {
    }
}

void stm32_can_rx_irq(stm32_can_inbox *in)
{
    stm32_can_regs *c = STM32_CAN1;
    /* three frames at most are in the FIFO */
    for (unsigned n = 0; n < 3u && (c->rf0r & STM32_CAN_RF0R_FMP) != 0u; n++) {
        if ((uint8_t)(in->put - in->get) < STM32_CAN_RX) {
            unpack(&c->rx[0], &in->rx[in->put % STM32_CAN_RX]);
            in->put++;
        }
        release(c);
        stm32_time_event(in->time);
    }
    if ((c->rf0r & STM32_CAN_RF0R_FOVR) != 0u) {
        c->rf0r = STM32_CAN_RF0R_FOVR | STM32_CAN_RF0R_FULL;
    }
}

static bq_status can_receive(void *ctx, bq_can_frame *f)
{
    stm32_can_inbox *in = ctx;
    if (f == NULL) {
        return BQ_E_ARG;
    }
    if (in->put == in->get) {
        return BQ_PENDING;
    }
    __asm volatile("" ::: "memory"); /* the frame is looked at after the index that announces it */
    *f = in->rx[in->get % STM32_CAN_RX];
    __asm volatile("" ::: "memory");
    in->get++;
    return BQ_OK;
}

bq_can stm32_can_listen(stm32_can_inbox *inbox, stm32_time *time)
{
    static const bq_can_ops ops = {can_send, can_receive, can_state};
    stm32_can_regs *c = STM32_CAN1;
    bq_can bus = {&ops, inbox};
    inbox->time = time;
    inbox->put = 0;
    inbox->get = 0;
    set_filter(c);
    c->ier |= STM32_CAN_IER_FMPIE0;
    return bus;
}
