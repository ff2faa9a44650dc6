/* The registers of an STM32F103 that the board layer uses, as RM0008 and PM0056 number them. */
#ifndef HK_STM32F103_H
#define HK_STM32F103_H

#include <stdint.h>

#define HK_MMIO(address) (*(volatile uint32_t *)UINT32_C(address))
#define HK_BIT(number)   (UINT32_C(1) << (number))

/* --- Clocks and flash ----------------------------------------------------------------------- */

#define RCC_CR      HK_MMIO(0x40021000)
#define RCC_CFGR    HK_MMIO(0x40021004)
#define RCC_APB2ENR HK_MMIO(0x40021018)
#define RCC_APB1ENR HK_MMIO(0x4002101C)
#define RCC_CSR     HK_MMIO(0x40021024)

#define RCC_CR_HSEON  HK_BIT(16)
#define RCC_CR_HSERDY HK_BIT(17)
#define RCC_CR_PLLON  HK_BIT(24)
#define RCC_CR_PLLRDY HK_BIT(25)

#define RCC_CFGR_SW_PLL      UINT32_C(2)
#define RCC_CFGR_SWS         (UINT32_C(3) << 2)
#define RCC_CFGR_SWS_PLL     (UINT32_C(2) << 2)
#define RCC_CFGR_PPRE1_BY_2  (UINT32_C(4) << 8)
#define RCC_CFGR_PLLSRC_HSE  HK_BIT(16)
#define RCC_CFGR_PLL_TIMES_9 (UINT32_C(7) << 18)

#define RCC_APB2_AFIO   HK_BIT(0)
#define RCC_APB2_GPIOA  HK_BIT(2)
#define RCC_APB2_GPIOB  HK_BIT(3)
#define RCC_APB2_USART1 HK_BIT(14)
#define RCC_APB1_TIM2   HK_BIT(0)
#define RCC_APB1_TIM3   HK_BIT(1)
#define RCC_APB1_I2C1   HK_BIT(21)

#define RCC_CSR_RMVF     HK_BIT(24)
#define RCC_CSR_PORRSTF  HK_BIT(27)
#define RCC_CSR_SFTRSTF  HK_BIT(28)
#define RCC_CSR_IWDGRSTF HK_BIT(29)
#define RCC_CSR_WWDGRSTF HK_BIT(30)
#define RCC_CSR_LPWRRSTF HK_BIT(31)

#define FLASH_ACR  HK_MMIO(0x40022000)
#define FLASH_KEYR HK_MMIO(0x40022004)
#define FLASH_SR   HK_MMIO(0x4002200C)
#define FLASH_CR   HK_MMIO(0x40022010)
#define FLASH_AR   HK_MMIO(0x40022014)

#define FLASH_ACR_TWO_WAITS UINT32_C(2)
#define FLASH_ACR_PREFETCH  HK_BIT(4)
#define FLASH_KEY1          UINT32_C(0x45670123)
#define FLASH_KEY2          UINT32_C(0xCDEF89AB)
#define FLASH_SR_BSY        HK_BIT(0)
#define FLASH_SR_PGERR      HK_BIT(2)
#define FLASH_SR_WRPRTERR   HK_BIT(4)
#define FLASH_SR_EOP        HK_BIT(5)
#define FLASH_CR_PG         HK_BIT(0)
#define FLASH_CR_PER        HK_BIT(1)
#define FLASH_CR_STRT       HK_BIT(6)
#define FLASH_CR_LOCK       HK_BIT(7)

/* --- The independent watchdog --------------------------------------------------------------- */

#define IWDG_KR  HK_MMIO(0x40003000)
#define IWDG_PR  HK_MMIO(0x40003004)
#define IWDG_RLR HK_MMIO(0x40003008)
#define IWDG_SR  HK_MMIO(0x4000300C)

#define IWDG_KR_RELOAD UINT32_C(0xAAAA)
#define IWDG_KR_UNLOCK UINT32_C(0x5555)
#define IWDG_KR_START  UINT32_C(0xCCCC)
#define IWDG_PR_BY_32  UINT32_C(3)
#define IWDG_RLR_MAX   0xFFFU

/* --- Pins and their interrupts: four bits configure a pin, eight pins to a register ----------- */

#define GPIOA_CRH  HK_MMIO(0x40010804)
#define GPIOA_BSRR HK_MMIO(0x40010810)
#define GPIOB_CRL  HK_MMIO(0x40010C00)
#define GPIOB_CRH  HK_MMIO(0x40010C04)
#define GPIOB_IDR  HK_MMIO(0x40010C08)
#define GPIOB_BSRR HK_MMIO(0x40010C10)
#define GPIOB_BRR  HK_MMIO(0x40010C14)

#define GPIO_PULLED_INPUT         UINT32_C(0x8)
#define GPIO_PUSH_PULL            UINT32_C(0x2) /* 2 MHz */
#define GPIO_OPEN_DRAIN           UINT32_C(0x6)
#define GPIO_PERIPHERAL_PUSH_PULL UINT32_C(0x9) /* 10 MHz */
#define GPIO_PERIPHERAL_DRAIN     UINT32_C(0xE)

#define AFIO_EXTICR3       HK_MMIO(0x40010010)
#define AFIO_EXTICR3_PORTB UINT32_C(1) /* line 8 is PB8 */

#define EXTI_IMR  HK_MMIO(0x40010400)
#define EXTI_RTSR HK_MMIO(0x40010408)
#define EXTI_PR   HK_MMIO(0x40010414)

/* --- Timers 2 and 3 -------------------------------------------------------------------------- */

#define TIM2_CR1  HK_MMIO(0x40000000)
#define TIM2_DIER HK_MMIO(0x4000000C)
#define TIM2_SR   HK_MMIO(0x40000010)
#define TIM2_EGR  HK_MMIO(0x40000014)
#define TIM2_CNT  HK_MMIO(0x40000024)
#define TIM2_PSC  HK_MMIO(0x40000028)
#define TIM2_ARR  HK_MMIO(0x4000002C)

#define TIM3_CR1  HK_MMIO(0x40000400)
#define TIM3_DIER HK_MMIO(0x4000040C)
#define TIM3_SR   HK_MMIO(0x40000410)
#define TIM3_EGR  HK_MMIO(0x40000414)
#define TIM3_PSC  HK_MMIO(0x40000428)
#define TIM3_ARR  HK_MMIO(0x4000042C)

#define TIM_CR1_CEN  HK_BIT(0)
#define TIM_DIER_UIE HK_BIT(0)
#define TIM_SR_UIF   HK_BIT(0)
#define TIM_EGR_UG   HK_BIT(0)

/* --- I2C 1 ----------------------------------------------------------------------------------- */

#define I2C1_CR1   HK_MMIO(0x40005400)
#define I2C1_CR2   HK_MMIO(0x40005404)
#define I2C1_DR    HK_MMIO(0x40005410)
#define I2C1_SR1   HK_MMIO(0x40005414)
#define I2C1_SR2   HK_MMIO(0x40005418)
#define I2C1_CCR   HK_MMIO(0x4000541C)
#define I2C1_TRISE HK_MMIO(0x40005420)

#define I2C_CR1_PE    HK_BIT(0)
#define I2C_CR1_START HK_BIT(8)
#define I2C_CR1_STOP  HK_BIT(9)
#define I2C_CR1_ACK   HK_BIT(10)
#define I2C_CR1_POS   HK_BIT(11)
#define I2C_CR1_SWRST HK_BIT(15)
#define I2C_SR1_SB    HK_BIT(0)
#define I2C_SR1_ADDR  HK_BIT(1)
#define I2C_SR1_BTF   HK_BIT(2)
#define I2C_SR1_RXNE  HK_BIT(6)
#define I2C_SR1_TXE   HK_BIT(7)
#define I2C_SR1_BERR  HK_BIT(8)
#define I2C_SR1_ARLO  HK_BIT(9)
#define I2C_SR1_AF    HK_BIT(10)
#define I2C_SR2_MSL   HK_BIT(0)
#define I2C_CCR_FAST  HK_BIT(15)

/* --- USART 1 --------------------------------------------------------------------------------- */

#define USART1_SR  HK_MMIO(0x40013800)
#define USART1_DR  HK_MMIO(0x40013804)
#define USART1_BRR HK_MMIO(0x40013808)
#define USART1_CR1 HK_MMIO(0x4001380C)

#define USART_SR_FE      HK_BIT(1)
#define USART_SR_ORE     HK_BIT(3)
#define USART_SR_RXNE    HK_BIT(5)
#define USART_SR_TC      HK_BIT(6)
#define USART_SR_TXE     HK_BIT(7)
#define USART_CR1_RE     HK_BIT(2)
#define USART_CR1_TE     HK_BIT(3)
#define USART_CR1_RXNEIE HK_BIT(5)
#define USART_CR1_TXEIE  HK_BIT(7)
#define USART_CR1_UE     HK_BIT(13)

/* --- The core -------------------------------------------------------------------------------- */

#define NVIC_ISER0 HK_MMIO(0xE000E100)
#define NVIC_ISER1 HK_MMIO(0xE000E104)
#define SCB_AIRCR  HK_MMIO(0xE000ED0C)
#define SCB_CCR    HK_MMIO(0xE000ED14)

#define NVIC_EXTI9_5 HK_BIT(23)      /* in ISER0 */
#define NVIC_TIM2    HK_BIT(28)      /* in ISER0 */
#define NVIC_TIM3    HK_BIT(29)      /* in ISER0 */
#define NVIC_USART1  HK_BIT(37 - 32) /* in ISER1 */

#define SCB_AIRCR_RESET  UINT32_C(0x05FA0004)
#define SCB_CCR_STKALIGN HK_BIT(9)

/* Handlers that the vector table names. */
void hk_reset(void);
void hk_exti9_5(void);
void hk_tim2(void);
void hk_tim3(void);
void hk_usart1(void);

#endif
