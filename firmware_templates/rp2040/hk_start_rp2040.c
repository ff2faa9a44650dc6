/* From the second-stage loader to main: vector table, static data, everything else fatal. */
#include <stdint.h>

#include "hk_rp2040.h"

/* Of the linker script. */
extern uint32_t hk_stack_top[];
extern uint32_t hk_data_image[];
extern uint32_t hk_data_start[];
extern uint32_t hk_data_end[];
extern uint32_t hk_bss_start[];
extern uint32_t hk_bss_end[];

int main(void);

void hk_reset(void);
void hk_trap(void);
void hk_irq_timer_0(void);
void hk_irq_io_bank0(void);
void hk_irq_uart0(void);

typedef void (*hk_vector_t)(void);

typedef struct {
    uint32_t *stack_top;
    hk_vector_t reset;
    hk_vector_t system[14];
    hk_vector_t irq[HK_IRQS];
} hk_vectors_t;

extern const hk_vectors_t hk_vectors;

/* An exception or interrupt that nobody expects ends here: a probe finds it, and without one the
 * watchdog starts the board over. */
void hk_trap(void)
{
    for (;;) {
    }
}

void hk_reset(void)
{
    const uint32_t *from = hk_data_image;
    uint32_t *to;

    for (to = hk_data_start; to < hk_data_end; to++) {
        *to = *from++;
    }
    for (to = hk_bss_start; to < hk_bss_end; to++) {
        *to = 0U;
    }
    (void)main();
    hk_trap();
}

#define HK_TRAPS_5 hk_trap, hk_trap, hk_trap, hk_trap, hk_trap
#define HK_TRAPS_6 HK_TRAPS_5, hk_trap

__attribute__((section(".vectors"), used)) const hk_vectors_t hk_vectors = {
    .stack_top = hk_stack_top,
    .reset = hk_reset,
    .system = {HK_TRAPS_6, HK_TRAPS_6, hk_trap, hk_trap},
    .irq = {hk_irq_timer_0, HK_TRAPS_6, HK_TRAPS_6, hk_irq_io_bank0, HK_TRAPS_6, hk_irq_uart0,
            HK_TRAPS_5},
};
