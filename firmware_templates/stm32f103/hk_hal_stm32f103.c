/* The hardware layer on an STM32F103 at 72 MHz, as on a Blue Pill: see hk_hal.h. I2C, link, store and
 * reset have their own files.
 *
 * PB6 SCL, PB7 SDA, PB8 the sensor's INT pin, PA9 and PA10 (TX and RX of USART 1) the link, PA8 high
 * while the filter computes. Timer 2 is the clock, timer 3 ends the sleep every 4 ms. All interrupts
 * have one priority, so none interrupts another. */
#include "hk_hal.h"

#include "hk_board_stm32f103.h"
#include "hk_stm32f103.h"

#if F_CPU != 72000000UL
#error "the clock of this board layer is 72 MHz, from a crystal of 8 MHz"
#endif

#define HK_MARK_PIN 8U
#define HK_TX_PIN   9U
#define HK_RX_PIN   10U
#define HK_INT_PIN  8U
#define HK_INT      HK_BIT(HK_INT_PIN)

uint32_t hk_board_hold(void)
{
    uint32_t held;

    __asm__ volatile("mrs %0, primask\n\tcpsid i" : "=r"(held) : : "memory");
    return held;
}

void hk_board_release(uint32_t held)
{
    __asm__ volatile("msr primask, %0" : : "r"(held) : "memory");
}

/* --- Clock: timer 2 counts microseconds ------------------------------------------------------ */

/* The counter of 16 bits wraps after 65.5 ms. That is longer than the flash takes to erase a page,
 * while no interrupt can count the wrap. */
#define HK_CLOCK_SHIFT 16
#define HK_CLOCK_MASK  0xFFFFU

static volatile uint32_t clock_overflows;

/* Interrupts must be off, and for less than a period of the counter. */
static uint32_t clock_us(void)
{
    uint32_t overflows = clock_overflows;
    uint32_t count_us = TIM2_CNT;

    if ((TIM2_SR & TIM_SR_UIF) != 0U) {
        overflows++; /* the counter has wrapped, its interrupt has not come yet */
        count_us = TIM2_CNT;
    }
    return (overflows << HK_CLOCK_SHIFT) + count_us;
}

/* The flag is looked at, because its clearing may reach the timer after the return from here. */
void hk_tim2(void)
{
    if ((TIM2_SR & TIM_SR_UIF) != 0U) {
        TIM2_SR = ~TIM_SR_UIF;
        clock_overflows++;
    }
}

/* Wakes the processor, and nothing else: one too many does no harm. */
#define HK_TICK_US 4096U
static volatile uint32_t ticks;

void hk_tim3(void)
{
    TIM3_SR = ~TIM_SR_UIF;
    ticks++;
}

uint32_t hk_hal_time_us(void)
{
    const uint32_t held = hk_board_hold();
    const uint32_t now_us = clock_us();

    hk_board_release(held);
    return now_us;
}

uint32_t hk_board_elapsed_us(uint32_t since)
{
    return (TIM2_CNT - since) & HK_CLOCK_MASK;
}

/* --- Data ready: the sensor holds its pin high until it is read ----------------------------- */

static volatile uint32_t ready_us;

void hk_exti9_5(void)
{
    if ((EXTI_PR & HK_INT) != 0U) {
        EXTI_PR = HK_INT;
        ready_us = clock_us();
    }
}

static bool sample_announced(void)
{
    return (GPIOB_IDR & HK_INT) != 0U;
}

bool hk_hal_data_ready(uint32_t *time_us)
{
    uint32_t held;

    if (!sample_announced()) {
        return false;
    }
    held = hk_board_hold();
    /* The pin may just have risen, with its interrupt still to come. */
    *time_us = (EXTI_PR & HK_INT) != 0U ? clock_us() : ready_us;
    hk_board_release(held);
    return true;
}

/* --- The rest ------------------------------------------------------------------------------- */

/* The crystal of 8 MHz times nine; the flash needs two wait states, bus APB1 half the clock. Without
 * its crystal the board does not start: its link could not keep its rate. The internal oscillator
 * stays on, for the flash is programmed with it. */
static void start_clock(void)
{
    RCC_CR |= RCC_CR_HSEON;
    while ((RCC_CR & RCC_CR_HSERDY) == 0U) {
    }
    FLASH_ACR = FLASH_ACR_PREFETCH | FLASH_ACR_TWO_WAITS;
    RCC_CFGR = RCC_CFGR_PLLSRC_HSE | RCC_CFGR_PLL_TIMES_9 | RCC_CFGR_PPRE1_BY_2;
    RCC_CR |= RCC_CR_PLLON;
    while ((RCC_CR & RCC_CR_PLLRDY) == 0U) {
    }
    RCC_CFGR |= RCC_CFGR_SW_PLL;
    while ((RCC_CFGR & RCC_CFGR_SWS) != RCC_CFGR_SWS_PLL) {
    }
    RCC_APB2ENR = RCC_APB2_AFIO | RCC_APB2_GPIOA | RCC_APB2_GPIOB | RCC_APB2_USART1;
    RCC_APB1ENR = RCC_APB1_TIM2 | RCC_APB1_TIM3 | RCC_APB1_I2C1;
    (void)RCC_APB1ENR; /* two clocks pass before the peripherals listen */
}

static void set_field(volatile uint32_t *reg, uint32_t pin, uint32_t mode)
{
    const uint32_t shift = 4U * (pin % 8U);

    *reg = (*reg & ~(UINT32_C(0xF) << shift)) | (mode << shift);
}

void hk_board_configure_low_pin(uint32_t pin, uint32_t mode)
{
    set_field(&GPIOB_CRL, pin, mode);
}

/* The timers of APB1 run at twice its clock, hence at that of the core. */
static void start_timers(void)
{
    TIM2_PSC = F_CPU / 1000000UL - 1U;
    TIM2_ARR = HK_CLOCK_MASK;
    TIM2_EGR = TIM_EGR_UG; /* takes the prescaler over, and raises the flag */
    TIM2_SR = ~TIM_SR_UIF;
    TIM2_DIER = TIM_DIER_UIE;
    TIM2_CR1 = TIM_CR1_CEN;
    TIM3_PSC = F_CPU / 1000000UL - 1U;
    TIM3_ARR = HK_TICK_US - 1U;
    TIM3_EGR = TIM_EGR_UG;
    TIM3_SR = ~TIM_SR_UIF;
    TIM3_DIER = TIM_DIER_UIE;
    TIM3_CR1 = TIM_CR1_CEN;
}

/* RX is pulled up, so that an open pin stays silent. */
static void start_pins(void)
{
    set_field(&GPIOA_CRH, HK_MARK_PIN, GPIO_PUSH_PULL);
    set_field(&GPIOA_CRH, HK_TX_PIN, GPIO_PERIPHERAL_PUSH_PULL);
    GPIOA_BSRR = HK_BIT(HK_RX_PIN);
    set_field(&GPIOA_CRH, HK_RX_PIN, GPIO_PULLED_INPUT);
    GPIOB_BRR = HK_INT; /* pulled down */
    set_field(&GPIOB_CRH, HK_INT_PIN, GPIO_PULLED_INPUT);
    AFIO_EXTICR3 = AFIO_EXTICR3_PORTB;
    EXTI_RTSR = HK_INT;
    EXTI_IMR = HK_INT;
}

/* The watchdog comes first: it also ends the wait for a crystal that does not start. */
void hk_hal_init(void)
{
    hk_board_find_reset_cause();
    hk_board_start_watchdog();
    start_clock();
    start_timers();
    hk_board_start_link();
    start_pins();
    hk_hal_i2c_recover();
    NVIC_ISER0 = NVIC_EXTI9_5 | NVIC_TIM2 | NVIC_TIM3;
    NVIC_ISER1 = NVIC_USART1;
}

/* Sleep through the interrupts of the transmitter, until timer 3's, every 4 ms, a byte or a sample.
 * WFI ends for an interrupt that is held off too, so none is lost between the test and the sleep. */
void hk_hal_idle(void)
{
    const uint32_t tick = ticks;
    bool asleep = true;

    while (asleep) {
        const uint32_t held = hk_board_hold();

        asleep = !sample_announced() && !hk_board_has_received() && ticks == tick;
        if (asleep) {
            __asm__ volatile("dsb\n\twfi" : : : "memory");
        }
        hk_board_release(held);
        __asm__ volatile("isb" : : : "memory");
    }
}

void hk_hal_mark_begin(void)
{
    GPIOA_BSRR = HK_BIT(HK_MARK_PIN);
}

void hk_hal_mark_end(void)
{
    GPIOA_BSRR = HK_BIT(HK_MARK_PIN + 16U);
}
