/* Vector table and start-up of an STM32F103 of medium density: 43 interrupts after 15 exceptions. */
#include "hk_board_stm32f103.h"
#include "hk_stm32f103.h"

/* From the linker script. */
extern uint32_t hk_stack_top[];
extern uint32_t hk_data_load[];
extern uint32_t hk_data_start[];
extern uint32_t hk_data_end[];
extern uint32_t hk_bss_start[];
extern uint32_t hk_bss_end[];

int main(void);

typedef void (*hk_handler_t)(void);

typedef struct {
    uint32_t *stack_top;
    hk_handler_t exception[15];
    hk_handler_t interrupt[43];
} hk_vectors_t;

/* What is still on its way to memory arrives before the reset. */
void hk_board_restart(void)
{
    __asm__ volatile("dsb" : : : "memory");
    SCB_AIRCR = SCB_AIRCR_RESET;
    for (;;) {
    }
}

/* A fault, or an interrupt that nobody asked for. */
static void restart(void)
{
    hk_board_restart();
}

#define HK_FIVE_RESTARTS restart, restart, restart, restart, restart

__attribute__((section(".vectors"), used)) static const hk_vectors_t vectors = {
    .stack_top = hk_stack_top,
    .exception = {hk_reset, HK_FIVE_RESTARTS, HK_FIVE_RESTARTS, restart, restart, restart, restart},
    .interrupt =
        {
            HK_FIVE_RESTARTS, HK_FIVE_RESTARTS, HK_FIVE_RESTARTS, HK_FIVE_RESTARTS, /* 0 to 19 */
            restart, restart, restart, hk_exti9_5, restart,                         /* 20 to 24 */
            restart, restart, restart, hk_tim2, hk_tim3,                            /* 25 to 29 */
            HK_FIVE_RESTARTS, restart, restart, hk_usart1, restart, restart,        /* 30 to 39 */
            restart, restart, restart,                                              /* 40 to 42 */
        },
};

void hk_reset(void)
{
    const uint32_t *from = hk_data_load;
    uint32_t *to;

    SCB_CCR |= SCB_CCR_STKALIGN; /* the core of this part starts without */
    for (to = hk_data_start; to < hk_data_end; to++) {
        *to = *from++;
    }
    for (to = hk_bss_start; to < hk_bss_end; to++) {
        *to = 0U;
    }
    (void)main();
    restart();
}
