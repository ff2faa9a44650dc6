/* The link: a serial port, or standard input and output. */
#include <errno.h>
#include <fcntl.h>
#include <stddef.h>
#include <string.h>
#include <termios.h>
#include <unistd.h>

#include "hk_design.h"
#include "hk_linux.h"

#define HK_QUEUE_BYTES 1024U
#define HK_INPUT_BYTES 256U

static struct {
    int input;
    int output;
    bool broken;
    uint8_t queue[HK_QUEUE_BYTES];
    size_t queued;
    uint8_t taken[HK_INPUT_BYTES];
    size_t taken_bytes;
    size_t taken_place;
} port = {.input = -1, .output = -1};

/* Constant of a rate, or B0 if the terminals of Linux do not have it. */
static speed_t speed_of(long baud)
{
    static const struct {
        long baud;
        speed_t speed;
    } rates[] = {
        {9600, B9600},       {19200, B19200},     {38400, B38400},     {57600, B57600},
        {115200, B115200},   {230400, B230400},   {460800, B460800},   {500000, B500000},
        {921600, B921600},   {1000000, B1000000}, {2000000, B2000000},
    };
    size_t i;

    for (i = 0U; i < sizeof rates / sizeof rates[0]; i++) {
        if (rates[i].baud == baud) {
            return rates[i].speed;
        }
    }
    return B0;
}

static bool set_raw(int file)
{
    const speed_t speed = speed_of(HK_LINK_BAUD);
    struct termios settings;

    if (speed == B0 || tcgetattr(file, &settings) != 0) {
        return false;
    }
    settings.c_iflag = 0U;
    settings.c_oflag = 0U;
    settings.c_lflag = 0U;
    settings.c_cflag = CS8 | CREAD | CLOCAL;
    settings.c_cc[VMIN] = 1U;
    settings.c_cc[VTIME] = 0U;
    return cfsetispeed(&settings, speed) == 0 && cfsetospeed(&settings, speed) == 0
           && tcsetattr(file, TCSAFLUSH, &settings) == 0;
}

static bool unblock(int file)
{
    const int flags = fcntl(file, F_GETFL);

    return flags >= 0 && fcntl(file, F_SETFL, flags | O_NONBLOCK) == 0;
}

bool hk_linux_link_open(const char *serial)
{
    if (serial == NULL) {
        port.input = STDIN_FILENO;
        port.output = STDOUT_FILENO;
        return unblock(port.input) && unblock(port.output);
    }
    port.input = open(serial, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    port.output = port.input;
    return port.input >= 0 && set_raw(port.input);
}

int hk_linux_link_input(void)
{
    return port.input;
}

int hk_linux_link_output(void)
{
    return port.output;
}

bool hk_linux_link_waiting(void)
{
    return port.queued > 0U;
}

bool hk_linux_link_broken(void)
{
    return port.broken;
}

void hk_linux_link_send(void)
{
    ssize_t written;

    if (port.queued == 0U) {
        return;
    }
    written = write(port.output, port.queue, port.queued);
    if (written > 0) {
        port.queued -= (size_t)written;
        (void)memmove(port.queue, &port.queue[written], port.queued);
    } else if (written < 0 && errno != EAGAIN && errno != EINTR) {
        port.broken = true;
    }
}

void hk_linux_link_drain(void)
{
    const int flags = fcntl(port.output, F_GETFL);

    (void)fcntl(port.output, F_SETFL, flags & ~O_NONBLOCK);
    while (port.queued > 0U && !port.broken) {
        hk_linux_link_send();
    }
}

uint8_t hk_hal_transmit_room(void)
{
    const size_t room = HK_QUEUE_BYTES - port.queued;

    return room > UINT8_MAX ? UINT8_MAX : (uint8_t)room;
}

bool hk_hal_transmit(const uint8_t *bytes, uint8_t count)
{
    if (count > HK_QUEUE_BYTES - port.queued) {
        return false;
    }
    (void)memcpy(&port.queue[port.queued], bytes, count);
    port.queued += count;
    return true;
}

bool hk_hal_receive(uint8_t *byte)
{
    if (port.taken_place == port.taken_bytes) {
        const ssize_t count = port.input < 0 ? -1 : read(port.input, port.taken, HK_INPUT_BYTES);

        port.taken_place = 0U;
        port.taken_bytes = count > 0 ? (size_t)count : 0U;
        if (count == 0) {
            port.input = -1; /* nobody talks any more */
        }
    }
    if (port.taken_place == port.taken_bytes) {
        return false;
    }
    *byte = port.taken[port.taken_place++];
    return true;
}
