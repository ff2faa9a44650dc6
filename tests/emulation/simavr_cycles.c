/* Runs an image on simavr: a second opinion on what avr8js counts. It writes a line "cycles N" for
 * every stretch of code between the marks 1 and 0 in GPIOR0, and a line "byte N" for every byte of
 * the link.
 *
 * A test program of its own, for simavr is under GPL-3 or later: nothing that hostkit ships or writes
 * is linked with it.
 *
 *   simavr_cycles FIRMWARE.ELF LIMIT, the cycles after which it gives up */
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#define GPIOR0 0x3EU
#define CLOCK_HZ 16000000U

static avr_cycle_count_t begun;

static void mark(struct avr_t *avr, avr_io_addr_t address, uint8_t value, void *unused)
{
    (void)unused;
    if (value != 0U) {
        begun = avr->cycle;
    } else {
        printf("cycles %llu\n", (unsigned long long)(avr->cycle - begun));
    }
    avr->data[address] = value;
}

static void sent(struct avr_irq_t *irq, uint32_t value, void *unused)
{
    (void)irq;
    (void)unused;
    printf("byte %u\n", (unsigned)(value & 0xFFU));
}

/* Hand on the bytes, and do not wait while the firmware polls. */
static void wire_link(avr_t *avr)
{
    const uint32_t none = 0U;

    avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), (void *)&none);
    avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT), sent,
                            NULL);
}

static avr_t *load(const char *path)
{
    static elf_firmware_t firmware;
    avr_t *avr = avr_make_mcu_by_name("atmega328p");

    if (avr == NULL || elf_read_firmware(path, &firmware) != 0) {
        return NULL;
    }
    avr_init(avr);
    firmware.frequency = CLOCK_HZ;
    avr_load_firmware(avr, &firmware);
    avr_register_io_write(avr, GPIOR0, mark, NULL);
    wire_link(avr);
    return avr;
}

int main(int count, char **arguments)
{
    avr_t *avr = count == 3 ? load(arguments[1]) : NULL;
    bool running = avr != NULL;

    while (running && avr->cycle < strtoull(arguments[2], NULL, 10)) {
        const int state = avr_run(avr);

        if (state == cpu_Crashed) {
            return EXIT_FAILURE;
        }
        running = state != cpu_Done;
    }
    return avr != NULL && !running ? EXIT_SUCCESS : EXIT_FAILURE;
}
