/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file emu_periph.h
 * The inside of the emulator: what one peripheral model offers to the core and what the core offers to
 * models. One model = one file. A chip (emu_f072.c, emu_f405.c) is a table of instances; each row names the
 * function that makes the model. Nothing here needs a processor.
 *
 * Adding a model: write emu_NAME.c with one function `emu_periph *emu_NAME_new(emu *e, const emu_instance
 * *at)`, declare it in emu_models.h, and add a row to the instance table of each chip that has it.
 */
#ifndef EMU_PERIPH_H
#define EMU_PERIPH_H

#include "emu.h"

#define EMU_IRQS_PER_INSTANCE 4
#define EMU_NO_IRQ 0xffu

typedef enum emu_bus { EMU_AHB, EMU_APB1, EMU_APB2, EMU_CORE /**< private peripheral bus */ } emu_bus;

/** Families where an IP exists in several forms. */
typedef enum emu_family { EMU_F0, EMU_F4 } emu_family;

/** What the clock of the IP's core is, where it is not simply the bus clock. */
typedef enum emu_kernel {
    EMU_KERNEL_BUS,   /**< the clock of its bus */
    EMU_KERNEL_TIMER, /**< bus clock, doubled when the prescaler of the bus is not 1 */
    EMU_KERNEL_I2C1,  /**< F0: HSI or SYSCLK by RCC_CFGR3 */
    EMU_KERNEL_USART, /**< F0: USART1 by RCC_CFGR3; others the bus */
    EMU_KERNEL_ADC14, /**< F0: HSI14 or PCLK by ADC_CFGR2, which the model itself knows */
    EMU_KERNEL_LSI    /**< 40 kHz (F0) or 32 kHz (F4) */
} emu_kernel;

/** One possible place of a signal of a peripheral. */
typedef struct emu_pad {
    uint8_t signal; /**< EMU_SIG_... */
    uint8_t port;   /**< 0 = A */
    uint8_t pin;
    uint8_t af; /**< alternate function number; EMU_AF_ANALOG = analog mode */
} emu_pad;

#define EMU_AF_ANALOG 0x10u

enum emu_signal {
    EMU_SIG_END, /**< ends a list of pads */
    EMU_SIG_TX,
    EMU_SIG_RX,
    EMU_SIG_SCL,
    EMU_SIG_SDA,
    EMU_SIG_SCK,
    EMU_SIG_MISO,
    EMU_SIG_MOSI,
    EMU_SIG_CHANNEL0 = 0x20 /**< ADC: + channel */
};

/** Requests to a DMA controller. A model raises them by level; the DMA model knows to which stream or channel
 * each goes. */
typedef enum emu_dma_line {
    EMU_DMA_SPI1_RX,
    EMU_DMA_SPI1_TX,
    EMU_DMA_SPI2_RX,
    EMU_DMA_SPI2_TX,
    EMU_DMA_I2C1_RX,
    EMU_DMA_I2C1_TX,
    EMU_DMA_USART2_RX,
    EMU_DMA_USART2_TX,
    EMU_DMA_ADC1,
    EMU_DMA_LINES
} emu_dma_line;

typedef struct emu_periph emu_periph;
typedef struct emu_instance emu_instance;

/** A row of a chip's table: where a model stands. Constant. */
struct emu_instance {
    const char *name; /**< as in the reference manual, "I2C1": name in misuse entries */
    emu_periph *(*create)(emu *e, const emu_instance *at);
    uint32_t base, size;
    uint8_t number; /**< 1 = I2C1; the bus number in the world's callbacks */
    emu_family family;
    emu_bus bus;
    emu_kernel kernel;
    uint8_t enable_reg; /**< offset of the RCC register with its clock enable bit; 0xff = always clocked */
    uint8_t enable_bit;
    uint8_t reset_reg;                  /**< offset of the RCC register with its reset bit; 0xff = none */
    uint8_t irq[EMU_IRQS_PER_INSTANCE]; /**< NVIC numbers, in the order the model states; EMU_NO_IRQ = none */
    const emu_pad *pads;                /**< ends with EMU_SIG_END; NULL = none */
};

/** What a model offers. Made by its create function with emu_periph_new(). Times are absolute ns. */
struct emu_periph {
    const emu_instance *at; /**< set by emu_periph_new() */
    emu *e;                 /**< set by emu_periph_new() */
    void *state;            /**< zeroed, of the size given to emu_periph_new(); freed by the core */
    /**
     * One access. `offset` is word-aligned on APB1 and APB2, exact on AHB; `bytes` is 1, 2 or 4. read returns
     * the whole register (the core takes the lane). On the APBs a narrow write arrives as the bridge makes
     * it: duplicated to 32 bits. On AHB it arrives right-aligned; emu_merge() helps. Called only while the
     * instance is clocked and not held in reset. Side effects of reading happen here.
     */
    uint32_t (*read)(emu_periph *p, uint32_t offset, unsigned bytes);
    void (*write)(emu_periph *p, uint32_t offset, uint32_t value, unsigned bytes);
    /** Time of the model's next event; EMU_NEVER = none. NULL = never has one. Asked again after any
     * function of this model was called, so it must depend on nothing that changes otherwise. */
    uint64_t (*next)(const emu_periph *p);
    /** Now is at or past next(): do what is due. Called with emu_now() = that time, or a little later when
     * the processor was inside a run of instructions; a model that repeats counts on from its own due time.
     */
    void (*run)(emu_periph *p);
    /** Registers to their reset values, interrupt and DMA requests withdrawn. Called at creation, at each
     * chip reset (see emu_reset_cause()) and by the reset bit of RCC. NULL = nothing to do. */
    void (*reset)(emu_periph *p);
    /** The clock tree changed (bus clocks, kernel clock): rates from now on. NULL = takes no notice. */
    void (*clock)(emu_periph *p);
    /** The level of a DMA request changed; only DMA models. */
    void (*dma)(emu_periph *p, emu_dma_line line, bool level);
    /** A byte or frame is complete at the receiver; only USART and CAN. False = nobody listens. */
    bool (*uart_in)(emu_periph *p, uint8_t byte);
    bool (*can_in)(emu_periph *p, const emu_can_frame *frame);
    uint8_t slot; /**< private to the core */
};

/** Registers a model: a zeroed emu_periph with a zeroed state of `state_size` bytes. NULL without memory. */
emu_periph *emu_periph_new(emu *e, const emu_instance *at, size_t state_size);
/** The model of an instance by name; NULL = this chip has none. */
emu_periph *emu_periph_find(const emu *e, const char *name);

/* ---- services -------------------------------------------------------------------------------------------
 */

/* uint64_t emu_now(const emu *e); is in emu.h */

/** The world, moved to the present time first. Every callback is there. */
const emu_world *emu_outside(emu *e);

uint32_t emu_bus_hz(const emu *e, emu_bus bus);               /**< HCLK, PCLK1, PCLK2, or HCLK for EMU_CORE */
uint32_t emu_kernel_hz(const emu *e, const emu_instance *at); /**< clock of the IP's core; 0 = stands still */
bool emu_clocked(const emu *e, const emu_instance *at);       /**< its enable bit is set */
/** Duration of n cycles of a clock, rounded up; EMU_NEVER for 0 Hz. */
uint64_t emu_cycles_ns(uint32_t hz, uint64_t n);

/** Interrupt request line `index` (0..3 of the instance's irq list), by level. Lines of several models that
 * share a number are ORed. A request that goes away before it is served stays pending, as in hardware. */
void emu_irq(emu_periph *p, unsigned index, bool level);
/** A line into EXTI (16 = PVD, 17 = RTC alarm, ...): the present level. EXTI finds the edges. */
void emu_exti_line(emu *e, unsigned line, bool level);
/** Non-maskable interrupt (clock security system). */
void emu_nmi(emu *e);

/** DMA request by level; reaches every DMA model of the chip at once. */
void emu_dma_request(emu *e, emu_dma_line line, bool level);
bool emu_dma_level(const emu *e, emu_dma_line line);

/** Level that the input buffer of a pin sees: own output, the outside, pull resistors. */
bool emu_pin_level(emu *e, unsigned port, unsigned pin);
/** Alternate function number of a pin in alternate function mode, EMU_AF_ANALOG in analog mode, -1 in input
 * and output mode. */
int emu_pin_af(const emu *e, unsigned port, unsigned pin);
bool emu_pin_open_drain(const emu *e, unsigned port, unsigned pin);
/** The pad on which a signal of the instance is selected now; NULL = none: the signal is not connected. */
const emu_pad *emu_pad_of(const emu *e, const emu_instance *at, unsigned signal);
/** The same, and none is misuse ("SCL on no pin"). For use at the moment the signal begins to matter. */
const emu_pad *emu_pad_needed(emu_periph *p, unsigned signal, const char *signal_name);

/** Records what the reference manual forbids. `reg` is the register's name. Text: at most 79 characters. */
void emu_misuse(emu_periph *p, const char *reg, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 3, 4)))
#endif
    ;
/** Misuse when a write sets bits outside of `allowed` or changes them from `old`; returns value & allowed. */
uint32_t emu_reserved(emu_periph *p, const char *reg, uint32_t value, uint32_t allowed);

/** Bus master access of a DMA controller: memory and peripherals, with clock gate and judge. False: bus
 * error. */
bool emu_mem_read(emu *e, uint32_t address, void *bytes, size_t n);
bool emu_mem_write(emu *e, uint32_t address, const void *bytes, size_t n);

/** The cause of the reset that is being carried out (inside reset()); EMU_CAUSES = only this peripheral. */
emu_cause emu_reset_cause(const emu *e);
/** Asks for a chip reset (watchdog, SYSRESETREQ); it happens before the next instruction. */
void emu_ask_reset(emu *e, emu_cause cause);
/** The processor does not fetch until `ns` (flash busy). Interrupt entry waits as well. */
void emu_stall_until(emu *e, uint64_t ns);

/** A register after a narrow write: `value` of `bytes` bytes at byte `offset & 3` of `old`. */
uint32_t emu_merge(uint32_t old, uint32_t offset, uint32_t value, unsigned bytes);

#endif
