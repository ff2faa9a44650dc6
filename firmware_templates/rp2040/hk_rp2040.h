/* The registers of the RP2040 that the firmware uses: addresses and bits as in its data sheet. */
#ifndef HK_RP2040_H
#define HK_RP2040_H

#include <stdint.h>

#define HK_REG(address) (*(volatile uint32_t *)(address))

/* Each register of a peripheral has two more addresses, where a write sets or clears bits. */
#define HK_SET(address) HK_REG((address) + UINT32_C(0x2000))
#define HK_CLEAR(address) HK_REG((address) + UINT32_C(0x3000))

#define HK_BIT(n) (UINT32_C(1) << (n))

/* Crystal oscillator */
#define HK_XOSC_CTRL         UINT32_C(0x40024000)
#define HK_XOSC_STATUS       UINT32_C(0x40024004)
#define HK_XOSC_STARTUP      UINT32_C(0x4002400C)
#define HK_XOSC_1_TO_15_MHZ  UINT32_C(0xAA0)
#define HK_XOSC_ENABLE       UINT32_C(0xFAB000)
#define HK_XOSC_STABLE       HK_BIT(31)

/* Clocks */
#define HK_CLK_REF_CTRL      UINT32_C(0x40008030)
#define HK_CLK_REF_DIV       UINT32_C(0x40008034)
#define HK_CLK_REF_SELECTED  UINT32_C(0x40008038)
#define HK_CLK_SYS_CTRL      UINT32_C(0x4000803C)
#define HK_CLK_SYS_DIV       UINT32_C(0x40008040)
#define HK_CLK_SYS_SELECTED  UINT32_C(0x40008044)
#define HK_CLK_PERI_CTRL     UINT32_C(0x40008048)
#define HK_CLK_REF_XOSC      UINT32_C(2)
#define HK_CLK_SYS_REF       UINT32_C(0)
#define HK_CLK_SYS_AUX       UINT32_C(1) /* auxiliary source 0: PLL_SYS */
#define HK_CLK_PERI_ENABLE   HK_BIT(11)  /* auxiliary source 0: clk_sys */
#define HK_CLK_WHOLE         UINT32_C(0x100)

/* PLL */
#define HK_PLL_SYS_CS        UINT32_C(0x40028000)
#define HK_PLL_SYS_PWR       UINT32_C(0x40028004)
#define HK_PLL_SYS_FBDIV     UINT32_C(0x40028008)
#define HK_PLL_SYS_PRIM      UINT32_C(0x4002800C)
#define HK_PLL_LOCK          HK_BIT(31)
#define HK_PLL_POWER_DOWN    (HK_BIT(0) | HK_BIT(5)) /* the whole, and its oscillator */
#define HK_PLL_DIVIDERS_DOWN HK_BIT(3)
#define HK_PLL_POST_1        16U
#define HK_PLL_POST_2        12U

/* Resets */
#define HK_RESETS_RESET      UINT32_C(0x4000C000)
#define HK_RESETS_DONE       UINT32_C(0x4000C008)
#define HK_RESET_I2C0        HK_BIT(3)
#define HK_RESET_IO_BANK0    HK_BIT(5)
#define HK_RESET_PADS_BANK0  HK_BIT(8)
#define HK_RESET_PLL_SYS     HK_BIT(12)
#define HK_RESET_TIMER       HK_BIT(21)
#define HK_RESET_UART0       HK_BIT(22)

/* Power-on state machine: what the watchdog resets, by bit */
#define HK_PSM_WDSEL         UINT32_C(0x40010008)
#define HK_PSM_BUT_CLOCKS    UINT32_C(0x1FFFC) /* everything but both oscillators */

/* Why the chip was reset */
#define HK_CHIP_RESET        UINT32_C(0x40064008)
#define HK_CHIP_HAD_RUN      HK_BIT(16) /* by the pin RUN */
#define HK_CHIP_HAD_RESTART  HK_BIT(20) /* by a debugger */

/* Watchdog: its tick drives the timer; the boot ROM reads its scratch registers 4 to 7 */
#define HK_WATCHDOG_CTRL     UINT32_C(0x40058000)
#define HK_WATCHDOG_LOAD     UINT32_C(0x40058004)
#define HK_WATCHDOG_REASON   UINT32_C(0x40058008)
#define HK_WATCHDOG_SCRATCH0 UINT32_C(0x4005800C)
#define HK_WATCHDOG_SCRATCH1 UINT32_C(0x40058010)
#define HK_WATCHDOG_TRIGGER  HK_BIT(31)
#define HK_WATCHDOG_ENABLE   HK_BIT(30)
#define HK_WATCHDOG_PAUSE    (UINT32_C(7) << 24) /* while a debugger halts a processor */
#define HK_WATCHDOG_TICK     UINT32_C(0x4005802C)
#define HK_TICK_ENABLE       HK_BIT(9)

/* Timer */
#define HK_TIMER_ALARM0      UINT32_C(0x40054010)
#define HK_TIMER_RAWL        UINT32_C(0x40054028)
#define HK_TIMER_INTR        UINT32_C(0x40054034)
#define HK_TIMER_INTE        UINT32_C(0x40054038)

/* Pins */
#define HK_IO_CTRL(pin)      (UINT32_C(0x40014004) + 8U * (pin))
#define HK_IO_INTR0          UINT32_C(0x400140F0) /* of pins 0 to 7, four bits each */
#define HK_IO_INTE0          UINT32_C(0x40014100)
#define HK_IO_EDGE_HIGH(pin) HK_BIT(4U * (pin) + 3U)
#define HK_IO_UART           UINT32_C(2)
#define HK_IO_I2C            UINT32_C(3)
#define HK_IO_SIO            UINT32_C(5)
#define HK_PAD(pin)          (UINT32_C(0x4001C004) + 4U * (pin))
#define HK_PAD_SCHMITT       HK_BIT(1)
#define HK_PAD_PULL_DOWN     HK_BIT(2)
#define HK_PAD_PULL_UP       HK_BIT(3)
#define HK_PAD_4_MA          HK_BIT(4)
#define HK_PAD_INPUT         HK_BIT(6)
#define HK_SIO_IN            UINT32_C(0xD0000004)
#define HK_SIO_OUT_CLEAR     UINT32_C(0xD0000018)
#define HK_SIO_OE_SET        UINT32_C(0xD0000024)
#define HK_SIO_OE_CLEAR      UINT32_C(0xD0000028)

/* I2C */
#define HK_I2C0_CON          UINT32_C(0x40044000)
#define HK_I2C0_TAR          UINT32_C(0x40044004)
#define HK_I2C0_DATA_CMD     UINT32_C(0x40044010)
#define HK_I2C0_FS_SCL_HIGH  UINT32_C(0x4004401C)
#define HK_I2C0_FS_SCL_LOW   UINT32_C(0x40044020)
#define HK_I2C0_RAW_INTR     UINT32_C(0x40044034)
#define HK_I2C0_CLR_TX_ABRT  UINT32_C(0x40044054)
#define HK_I2C0_CLR_STOP_DET UINT32_C(0x40044060)
#define HK_I2C0_ENABLE       UINT32_C(0x4004406C)
#define HK_I2C0_STATUS       UINT32_C(0x40044070)
#define HK_I2C0_SDA_HOLD     UINT32_C(0x4004407C)
#define HK_I2C0_ENABLED      UINT32_C(0x4004409C)
#define HK_I2C0_FS_SPKLEN    UINT32_C(0x400440A0)
#define HK_I2C_MASTER        (HK_BIT(0) | HK_BIT(6)) /* master, and no slave */
#define HK_I2C_FAST          (UINT32_C(2) << 1)
#define HK_I2C_RESTART_OK    HK_BIT(5)
#define HK_I2C_READ          HK_BIT(8)
#define HK_I2C_STOP          HK_BIT(9)
#define HK_I2C_RESTART       HK_BIT(10)
#define HK_I2C_TX_ABRT       HK_BIT(6)
#define HK_I2C_STOP_DET      HK_BIT(9)
#define HK_I2C_TX_NOT_FULL   HK_BIT(1)
#define HK_I2C_RX_NOT_EMPTY  HK_BIT(3)

/* UART, a PL011 */
#define HK_UART0_DR          UINT32_C(0x40034000)
#define HK_UART0_FR          UINT32_C(0x40034018)
#define HK_UART0_IBRD        UINT32_C(0x40034024)
#define HK_UART0_FBRD        UINT32_C(0x40034028)
#define HK_UART0_LCR_H       UINT32_C(0x4003402C)
#define HK_UART0_CR          UINT32_C(0x40034030)
#define HK_UART0_IFLS        UINT32_C(0x40034034)
#define HK_UART0_IMSC        UINT32_C(0x40034038)
#define HK_UART0_ICR         UINT32_C(0x40034044)
#define HK_UART_BAD          (UINT32_C(7) << 8) /* of a byte: framing, parity, break */
#define HK_UART_BUSY         HK_BIT(3)
#define HK_UART_RX_EMPTY     HK_BIT(4)
#define HK_UART_TX_FULL      HK_BIT(5)
#define HK_UART_8_BITS       (UINT32_C(3) << 5)
#define HK_UART_FIFOS        HK_BIT(4)
#define HK_UART_ENABLE       (HK_BIT(0) | HK_BIT(8) | HK_BIT(9)) /* both directions */
#define HK_UART_TX_QUARTER   UINT32_C(1)
#define HK_UART_RX_HALF      (UINT32_C(2) << 3)
#define HK_UART_TX_INTERRUPT HK_BIT(5)
#define HK_UART_RX_INTERRUPT (HK_BIT(4) | HK_BIT(6)) /* half full, or 32 bits of silence */

/* Interrupts */
#define HK_NVIC_ENABLE       UINT32_C(0xE000E100)
#define HK_IRQ_TIMER_0       0
#define HK_IRQ_IO_BANK0      13
#define HK_IRQ_UART0         20
#define HK_IRQS              26

#endif
