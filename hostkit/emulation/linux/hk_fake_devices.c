/* Devices that are not there, for a program that does not know: an I2C bus with the virtual sensor
 * on it, and a gpio line with its INT. Loaded before the C library (LD_PRELOAD), it answers the
 * calls for /dev/hk-i2c and /dev/hk-gpio, and lets time pass as fast as the program can. */
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/gpio.h>
#include <linux/i2c-dev.h>
#include <linux/i2c.h>
#include <poll.h>
#include <signal.h>
#include <stdarg.h>
#include <string.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

#include "hk_fake_board.h"

#define HK_I2C  "/dev/hk-i2c"
#define HK_GPIO "/dev/hk-gpio"

#define HK_NS_PER_S UINT64_C(1000000000)
#define HK_CALL_NS  UINT64_C(1000) /* what a call takes */

/* The function of the C library that one of ours stands before. */
#define HK_REAL(name) (__extension__(__typeof__(&name))hk_real(#name))

static struct {
    int i2c;
    int chip;
    int line;
} fd = {.i2c = -1, .chip = -1, .line = -1};

static void *hk_real(const char *name)
{
    return dlsym(RTLD_NEXT, name);
}

__attribute__((constructor)) static void begin(void)
{
    hk_fake_board_begin();
}

static int open_nothing(void)
{
    return HK_REAL(open)("/dev/null", O_RDWR | O_CLOEXEC);
}

int open(const char *path, int flags, ...)
{
    va_list more;
    mode_t mode;

    if (strcmp(path, HK_I2C) == 0) {
        fd.i2c = open_nothing();
        return fd.i2c;
    }
    if (strcmp(path, HK_GPIO) == 0) {
        fd.chip = open_nothing();
        return fd.chip;
    }
    va_start(more, flags);
    mode = (flags & O_CREAT) != 0 ? (mode_t)va_arg(more, unsigned) : 0U;
    va_end(more);
    return HK_REAL(open)(path, flags, mode);
}

int close(int file)
{
    if (file == fd.i2c) {
        fd.i2c = -1;
    } else if (file == fd.chip) {
        fd.chip = -1;
    }
    return HK_REAL(close)(file);
}

static void catch_up(void)
{
    struct timespec now;

    if (hk_fake_realtime()) {
        (void)HK_REAL(clock_gettime)(CLOCK_MONOTONIC, &now);
        hk_fake_catch_up((uint64_t)now.tv_sec * HK_NS_PER_S + (uint64_t)now.tv_nsec);
    } else {
        hk_fake_pass(HK_CALL_NS);
    }
}

int clock_gettime(clockid_t id, struct timespec *now)
{
    uint64_t ns;

    if (id != CLOCK_MONOTONIC) {
        return HK_REAL(clock_gettime)(id, now);
    }
    catch_up();
    ns = hk_fake_now_ns();
    now->tv_sec = (time_t)(ns / HK_NS_PER_S);
    now->tv_nsec = (long)(ns % HK_NS_PER_S);
    return 0;
}

static int transfer(const struct i2c_rdwr_ioctl_data *data)
{
    int error = 0;
    uint32_t i;

    catch_up();
    for (i = 0U; i < data->nmsgs && error == 0; i++) {
        const struct i2c_msg *message = &data->msgs[i];

        error = hk_fake_message((uint8_t)message->addr, (message->flags & I2C_M_RD) != 0,
                                message->buf, message->len);
    }
    hk_fake_stop();
    if (error != 0) {
        errno = error;
        return -1;
    }
    return (int)data->nmsgs;
}

int ioctl(int file, unsigned long request, ...)
{
    va_list more;
    void *argument;

    va_start(more, request);
    argument = va_arg(more, void *);
    va_end(more);
    if (file >= 0 && file == fd.i2c) {
        return request == I2C_RDWR ? transfer(argument) : 0;
    }
    if (file >= 0 && file == fd.chip && request == GPIO_V2_GET_LINE_IOCTL) {
        fd.line = open_nothing();
        ((struct gpio_v2_line_request *)argument)->fd = fd.line;
        return 0;
    }
    if (file >= 0 && file == fd.line && request == GPIO_V2_LINE_GET_VALUES_IOCTL) {
        catch_up();
        ((struct gpio_v2_line_values *)argument)->bits = hk_fake_pin() ? 1U : 0U;
        return 0;
    }
    return HK_REAL(ioctl)(file, request, argument);
}

static ssize_t nothing_yet(void)
{
    errno = EAGAIN;
    return -1;
}

ssize_t read(int file, void *bytes, size_t room)
{
    struct gpio_v2_line_event event = {.id = GPIO_V2_LINE_EVENT_RISING_EDGE};
    uint64_t rose_ns;
    size_t count;

    if (file >= 0 && file == fd.line) {
        if (!hk_fake_edge(&rose_ns)) {
            return nothing_yet();
        }
        event.timestamp_ns = rose_ns;
        (void)memcpy(bytes, &event, sizeof event);
        return (ssize_t)sizeof event;
    }
    if (file == STDIN_FILENO && !hk_fake_realtime()) {
        count = hk_fake_received(bytes, room);
        return count > 0U ? (ssize_t)count : nothing_yet();
    }
    return HK_REAL(read)(file, bytes, room);
}

/* While time is not the wall clock's, a reader that is slow loses nothing. */
ssize_t write(int file, const void *bytes, size_t count)
{
    struct pollfd room = {.fd = file, .events = POLLOUT};
    ssize_t written = HK_REAL(write)(file, bytes, count);

    while (written < 0 && errno == EAGAIN && !hk_fake_realtime()) {
        (void)poll(&room, 1U, -1);
        written = HK_REAL(write)(file, bytes, count);
    }
    return written;
}

/* Mark what is ready of the faked files; the line, and in a run standard input. */
static int mark_ready(struct pollfd *files, nfds_t count)
{
    int ready = 0;
    nfds_t i;

    for (i = 0U; i < count; i++) {
        const bool line = files[i].fd >= 0 && files[i].fd == fd.line && hk_fake_edge_waits();
        const bool input = files[i].fd == STDIN_FILENO && !hk_fake_realtime() && hk_fake_receives();

        if (line || input) {
            files[i].revents |= POLLIN;
            ready++;
        }
    }
    return ready;
}

static uint64_t until_next_ns(const struct timespec *timeout)
{
    const uint64_t longest_ns = (uint64_t)timeout->tv_sec * HK_NS_PER_S
                                + (uint64_t)timeout->tv_nsec;
    const uint64_t now_ns = hk_fake_now_ns();
    const uint64_t next_ns = hk_fake_next_ns();

    if (next_ns <= now_ns) {
        return 0U;
    }
    return next_ns - now_ns < longest_ns ? next_ns - now_ns : longest_ns;
}

/* Wait for the true files as long as nothing happens on the faked ones. */
static int wait_really(struct pollfd *files, nfds_t count, uint64_t ns, const sigset_t *mask)
{
    const struct timespec timeout = {.tv_sec = (time_t)(ns / HK_NS_PER_S),
                                     .tv_nsec = (long)(ns % HK_NS_PER_S)};
    int ready = HK_REAL(ppoll)(files, count, &timeout, mask);

    catch_up();
    if (ready >= 0) {
        ready += mark_ready(files, count);
    }
    return ready;
}

int ppoll(struct pollfd *files, nfds_t count, const struct timespec *timeout, const sigset_t *mask)
{
    const uint64_t ns = until_next_ns(timeout);
    nfds_t i;

    if (hk_fake_realtime()) {
        return wait_really(files, count, ns, mask);
    }
    for (i = 0U; i < count; i++) {
        files[i].revents = 0;
    }
    if (hk_fake_ended()) {
        (void)raise(SIGTERM);
        errno = EINTR;
        return -1;
    }
    if (mark_ready(files, count) == 0) {
        hk_fake_pass(ns == 0U ? HK_CALL_NS : ns);
    }
    return mark_ready(files, count);
}
