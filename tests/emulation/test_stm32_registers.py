"""The register header of the STM32F103 against addresses and bits from public sources.

They were looked up in libopencm3 (memorymap.h, rcc.h, flash.h, usart_common_all.h, i2c_common_v1.h,
iwdg_common_all.h, timer and exti headers, irq.json) and compared with RM0008, PM0075 and PM0056.
"""

import re
import subprocess
from pathlib import Path

import pytest
from boards import require_or_skip

HEADER = Path(__file__).parents[2] / "firmware_templates/stm32f103/hk_stm32f103.h"
START = HEADER.with_name("hk_start.c")

BASE = {
    "TIM2": 0x40000000,
    "TIM3": 0x40000400,
    "IWDG": 0x40003000,
    "I2C1": 0x40005400,
    "AFIO": 0x40010000,
    "EXTI": 0x40010400,
    "GPIOA": 0x40010800,
    "GPIOB": 0x40010C00,
    "USART1": 0x40013800,
    "RCC": 0x40021000,
    "FLASH": 0x40022000,
    "NVIC": 0xE000E100,
    "SCB": 0xE000ED00,
}
TIMER = {"CR1": 0x00, "DIER": 0x0C, "SR": 0x10, "EGR": 0x14, "CNT": 0x24, "PSC": 0x28, "ARR": 0x2C}
PORT = {"CRL": 0x00, "CRH": 0x04, "IDR": 0x08, "ODR": 0x0C, "BSRR": 0x10, "BRR": 0x14}
OFFSET = {
    "TIM2": TIMER,
    "TIM3": TIMER,
    "IWDG": {"KR": 0x00, "PR": 0x04, "RLR": 0x08, "SR": 0x0C},
    "I2C1": {"CR1": 0x00, "CR2": 0x04, "DR": 0x10, "SR1": 0x14, "SR2": 0x18, "CCR": 0x1C,
             "TRISE": 0x20},
    "AFIO": {"EXTICR3": 0x10},
    "EXTI": {"IMR": 0x00, "RTSR": 0x08, "PR": 0x14},
    "GPIOA": PORT,
    "GPIOB": PORT,
    "USART1": {"SR": 0x00, "DR": 0x04, "BRR": 0x08, "CR1": 0x0C},
    "RCC": {"CR": 0x00, "CFGR": 0x04, "APB2ENR": 0x18, "APB1ENR": 0x1C, "CSR": 0x24},
    "FLASH": {"ACR": 0x00, "KEYR": 0x04, "SR": 0x0C, "CR": 0x10, "AR": 0x14},
    "NVIC": {"ISER0": 0x00, "ISER1": 0x04},
    "SCB": {"AIRCR": 0x0C, "CCR": 0x14},
}  # fmt: skip
BITS = {
    "RCC_CR": {"HSEON": 16, "HSERDY": 17, "PLLON": 24, "PLLRDY": 25},
    "RCC_CFGR": {"PLLSRC_HSE": 16},
    "RCC_CSR": {"RMVF": 24, "PORRSTF": 27, "SFTRSTF": 28, "IWDGRSTF": 29, "WWDGRSTF": 30,
                "LPWRRSTF": 31},
    "RCC_APB2": {"AFIO": 0, "GPIOA": 2, "GPIOB": 3, "USART1": 14},
    "RCC_APB1": {"TIM2": 0, "TIM3": 1, "I2C1": 21},
    "FLASH_ACR": {"PREFETCH": 4},
    "FLASH_SR": {"BSY": 0, "PGERR": 2, "WRPRTERR": 4, "EOP": 5},
    "FLASH_CR": {"PG": 0, "PER": 1, "STRT": 6, "LOCK": 7},
    "TIM_CR1": {"CEN": 0},
    "TIM_DIER": {"UIE": 0},
    "TIM_SR": {"UIF": 0},
    "TIM_EGR": {"UG": 0},
    "I2C_CR1": {"PE": 0, "START": 8, "STOP": 9, "ACK": 10, "POS": 11, "SWRST": 15},
    "I2C_SR1": {"SB": 0, "ADDR": 1, "BTF": 2, "RXNE": 6, "TXE": 7, "BERR": 8, "ARLO": 9, "AF": 10},
    "I2C_SR2": {"MSL": 0},
    "I2C_CCR": {"FAST": 15},
    "USART_SR": {"FE": 1, "ORE": 3, "RXNE": 5, "TC": 6, "TXE": 7},
    "USART_CR1": {"RE": 2, "TE": 3, "RXNEIE": 5, "TXEIE": 7, "UE": 13},
    "SCB_CCR": {"STKALIGN": 9},
}  # fmt: skip
VALUES = {
    "RCC_CFGR_SW_PLL": 2,
    "RCC_CFGR_SWS": 3 << 2,
    "RCC_CFGR_SWS_PLL": 2 << 2,
    "RCC_CFGR_PPRE1_BY_2": 4 << 8,
    "RCC_CFGR_PLL_TIMES_9": 7 << 18,
    "FLASH_ACR_TWO_WAITS": 2,
    "FLASH_KEY1": 0x45670123,
    "FLASH_KEY2": 0xCDEF89AB,
    "IWDG_KR_RELOAD": 0xAAAA,
    "IWDG_KR_UNLOCK": 0x5555,
    "IWDG_KR_START": 0xCCCC,
    "IWDG_PR_BY_32": 3,
    "IWDG_RLR_MAX": 0xFFF,
    "GPIO_PULLED_INPUT": 0b10_00,
    "GPIO_PUSH_PULL": 0b00_10,
    "GPIO_OPEN_DRAIN": 0b01_10,
    "GPIO_PERIPHERAL_PUSH_PULL": 0b10_01,
    "GPIO_PERIPHERAL_DRAIN": 0b11_10,
    "AFIO_EXTICR3_PORTB": 1,
    "SCB_AIRCR_RESET": 0x05FA << 16 | 1 << 2,
    "NVIC_EXTI9_5": 1 << 23,
    "NVIC_TIM2": 1 << 28,
    "NVIC_TIM3": 1 << 29,
    "NVIC_USART1": 1 << 37 - 32,
}
OURS = {"HK_STM32F103_H", "HK_MMIO", "HK_BIT"}


def known() -> dict[str, int]:
    names = dict(VALUES)
    for block, offsets in OFFSET.items():
        names |= {f"{block}_{name}": BASE[block] + offset for name, offset in offsets.items()}
    for register, bits in BITS.items():
        names |= {f"{register}_{name}": 1 << bit for name, bit in bits.items()}
    return names


def defined() -> dict[str, int]:
    """Every macro of the header with its value."""
    text = re.sub(r"/\*.*?\*/", "", HEADER.read_text(encoding="ascii"), flags=re.DOTALL)
    found = {}
    for name, value in re.findall(r"^#define (\w+) +(\S.*)$", text, re.MULTILINE):
        value = re.sub(r"HK_MMIO|UINT32_C", "", value).replace("HK_BIT", "1 << ")
        found[name] = int(eval(re.sub(r"(?<=[0-9A-F])U\b", "", value), {"__builtins__": {}}))
    return found


def test_every_register_and_bit_is_where_the_manuals_have_it() -> None:
    found, wanted = defined(), known()
    assert set(found) <= set(wanted) | OURS, "a macro that nobody has looked up"
    assert {name: hex(value) for name, value in found.items() if wanted[name] != value} == {}
    assert len(found) > 100


@pytest.mark.parametrize(("handler", "number"), [("hk_exti9_5", 23), ("hk_tim2", 28),
                                                 ("hk_tim3", 29), ("hk_usart1", 37)])  # fmt: skip
def test_the_handlers_stand_at_their_vectors(handler: str, number: int) -> None:
    text = START.read_text(encoding="ascii")
    table = text[text.index(".interrupt =") : text.index("};", text.index(".interrupt ="))]
    table = re.sub(r"/\*.*?\*/", "", table).replace("HK_FIVE_RESTARTS", ", ".join(["restart"] * 5))
    names = re.findall(r"\b(?:restart|hk_\w+)\b", table)
    assert (len(names), names.index(handler)) == (43, number)


def test_the_model_places_its_blocks_there() -> None:
    pytest.importorskip("unicorn")
    from hostkit.emulation.stm32 import flash, peripherals

    text = Path(peripherals.__file__).read_text(encoding="ascii")
    placed = {int(address, 16) for address in re.findall(r"\((0x\w{8}), ", text)}
    page = 0x400
    assert placed == {base // page * page for base in BASE.values()}
    assert flash.STORE_START == 0x08000000 + 62 * 1024


def test_the_board_layer_compiles_without_a_warning_of_clang(stm32_folder: Path) -> None:
    require_or_skip("clang")
    for source in [*sorted(stm32_folder.glob("hk_*_stm32f103.c")), stm32_folder / "hk_start.c"]:
        done = subprocess.run(
            ["clang", "--target=thumbv7m-none-eabi", "-mcpu=cortex-m3", "-std=gnu11",
             "-ffreestanding", "-DF_CPU=72000000UL", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow",
             "-Wconversion", "-Wdouble-promotion", "-Wstrict-prototypes", "-Wmissing-prototypes",
             "-Werror", "-fsyntax-only", str(source)],
            capture_output=True, text=True, timeout=60, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
